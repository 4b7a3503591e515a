// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pickle/pickle_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxOpcodes = 1'000'000;

/// Globals in pickles of data frames by any version of pandas and NumPy so far.
constexpr std::array<std::string_view, 21> kKnownGlobals = {
    "pandas.DataFrame",
    "pandas.core.frame.DataFrame",
    "pandas.core.internals.BlockManager",
    "pandas.core.internals.managers.BlockManager",
    "pandas._libs.internals._unpickle_block",
    "pandas.core.indexes.base._new_Index",
    "pandas.core.indexes.base.Index",
    "pandas.core.indexes.numeric.Int64Index",
    "pandas.core.indexes.range.RangeIndex",
    "pandas.indexes.base._new_Index",
    "pandas.indexes.base.Index",
    "numpy.ndarray",
    "numpy.dtype",
    "numpy.frombuffer",
    "numpy.core.multiarray._reconstruct",
    "numpy._core.multiarray._reconstruct",
    "numpy.core.numeric._frombuffer",
    "numpy._core.numeric._frombuffer",
    "builtins.slice",
    "__builtin__.slice",
    "pandas.core.indexes.api.Index"};

}  // namespace

/// Interprets the opcodes as Python does, except for calls.
class PickleMachine {
 public:
  explicit PickleMachine(PickledValues& made) : made_(made), bytes_(made.bytes_) {}

  void run() {
    for (std::size_t count = 0; !is_done_; ++count) {
      if (count == kMaxOpcodes)
        throw fault("more than a million opcodes: not a data frame of numbers");
      begin_ = at_;
      const char code = take(1)[0];
      if (!push_constant(code) && !use_stack(code) && !use_memo(code)) {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "opcode 0x%02x, which no data frame uses",
                      static_cast<unsigned>(static_cast<unsigned char>(code)));
        throw fault(text.data());
      }
    }
  }

 private:
  Error fault(const std::string& what) const { return data_error({made_.file_, begin_, {}}, what); }

  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size() - at_) throw fault("the pickle ends early");
    const std::string_view part = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ += part.size();
    return part;
  }
  /// A little-endian number of 1 to 8 bytes.
  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    const std::string_view part = take(size);
    for (std::size_t k = 0; k < size; ++k)
      value |= std::uint64_t{static_cast<unsigned char>(part[k])} << (8 * k);
    return value;
  }
  std::string_view line() {
    const std::size_t size = bytes_.find('\n', at_);
    if (size == std::string_view::npos) throw fault("the pickle ends early");
    const std::string_view part = take(size - at_);
    take(1);
    return part;
  }

  PickleRef push(PickleValue value) {
    made_.values_.push_back(std::move(value));
    stack_.push_back(static_cast<PickleRef>(made_.values_.size() - 1));
    return stack_.back();
  }
  void push_integer(std::int64_t value) { push({.kind = PickleKind::integer, .integer = value}); }
  void push_part(PickleKind kind, std::string_view text) { push({.kind = kind, .text = text}); }
  void push_items(PickleKind kind, std::vector<PickleRef> items) {
    push({.kind = kind, .items = std::move(items)});
  }
  void push_global(std::string name) {
    if (std::ranges::find(kKnownGlobals, name) == kKnownGlobals.end())
      throw fault("contains " + shown(name) +
                  ", which no data frame of numbers uses; nothing was executed");
    push({.kind = PickleKind::global, .name = std::move(name)});
  }

  PickleRef pop() {
    // Values below a mark are out of reach.
    if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) throw fault("nothing on the stack");
    const PickleRef top = stack_.back();
    stack_.pop_back();
    return top;
  }
  std::vector<PickleRef> pop_several(std::size_t count) {
    std::vector<PickleRef> items(count);
    for (std::size_t k = count; k-- > 0;) items[k] = pop();
    return items;
  }
  std::vector<PickleRef> pop_to_mark() {
    if (marks_.empty()) throw fault("no mark on the stack");
    const auto begin = stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back());
    std::vector<PickleRef> items(begin, stack_.end());
    stack_.erase(begin, stack_.end());
    marks_.pop_back();
    return items;
  }
  PickleValue& top_of(PickleKind kind, const char* what) {
    const PickleRef top = pop();
    stack_.push_back(top);
    if (made_.values_[top].kind != kind) throw fault(std::string("expected ") + what);
    return made_.values_[top];
  }
  std::string pop_text() {
    const PickleValue& value = made_.values_[pop()];
    if (value.kind != PickleKind::text) throw fault("expected a name");
    return std::string(value.text);
  }

  bool push_constant(char code) {
    switch (code) {
      case 'N': push({}); return true;
      case '\x88':
      case '\x89': push_boolean(code == '\x88'); return true;
      case 'K': push_integer(static_cast<std::int64_t>(number(1))); return true;
      case 'M': push_integer(static_cast<std::int64_t>(number(2))); return true;
      case 'J': push_integer(static_cast<std::int32_t>(number(4))); return true;
      case '\x8a': push_long(); return true;
      case 'G': push_real(); return true;
      case 'X': push_part(PickleKind::text, take(number(4))); return true;
      case '\x8c': push_part(PickleKind::text, take(number(1))); return true;
      case '\x8d': push_part(PickleKind::text, take(number(8))); return true;
      case 'C': push_part(PickleKind::bytes, take(number(1))); return true;
      case 'B': push_part(PickleKind::bytes, take(number(4))); return true;
      case '\x8e':
      case '\x96': push_part(PickleKind::bytes, take(number(8))); return true;
      case ')':
      case ']': push_items(PickleKind::sequence, {}); return true;
      case '}': push_items(PickleKind::dictionary, {}); return true;
      case 'c': {
        const std::string module(line());
        push_global(module + "." + std::string(line()));
        return true;
      }
      default: return false;
    }
  }

  void push_boolean(bool value) { push({.kind = PickleKind::boolean, .integer = value ? 1 : 0}); }
  /// A number in two's complement, with as few bytes as possible.
  void push_long() {
    const std::uint64_t size = number(1);
    if (size > 8) throw fault("an integer of more than 64 bits");
    const std::uint64_t value = number(static_cast<std::size_t>(size));
    const auto unused = static_cast<int>(64 - 8 * size);
    push_integer(size == 0 ? 0 : static_cast<std::int64_t>(value << unused) >> unused);
  }
  /// The only big-endian numbers.
  void push_real() {
    std::uint64_t bits = 0;
    for (const char byte : take(8)) bits = bits << 8 | static_cast<unsigned char>(byte);
    push({.kind = PickleKind::real, .real = std::bit_cast<double>(bits)});
  }

  bool use_stack(char code) {
    switch (code) {
      case '\x80': require_protocol(number(1)); return true;
      case '\x95': take(8); return true;  // length of the next frame, for readers of streams
      case '(': marks_.push_back(stack_.size()); return true;
      case '0': pop(); return true;
      case '1': pop_to_mark(); return true;
      case 't': push_items(PickleKind::sequence, pop_to_mark()); return true;
      case '\x85': push_items(PickleKind::sequence, pop_several(1)); return true;
      case '\x86': push_items(PickleKind::sequence, pop_several(2)); return true;
      case '\x87': push_items(PickleKind::sequence, pop_several(3)); return true;
      case 'a': add(PickleKind::sequence, pop_several(1)); return true;
      case 'e': add(PickleKind::sequence, pop_to_mark()); return true;
      case 's': add(PickleKind::dictionary, pop_several(2)); return true;
      case 'u': add(PickleKind::dictionary, pop_to_mark()); return true;
      case '\x93': {
        const std::string name = pop_text();
        push_global(pop_text() + "." + name);
        return true;
      }
      case 'R':
      case '\x81': make_object(); return true;
      case 'b': {
        const PickleRef state = pop();
        PickleValue& object = top_of(PickleKind::object, "an object for a state");
        object.items.resize(2);
        object.items.push_back(state);
        return true;
      }
      case '.':
        made_.root_ = pop();
        is_done_ = true;
        return true;
      default: return false;
    }
  }

  void require_protocol(std::uint64_t protocol) const {
    if (protocol < 2 || protocol > 5)
      throw fault("protocol " + std::to_string(protocol) + ", expected 2 to 5");
  }
  void add(PickleKind kind, const std::vector<PickleRef>& items) {
    if (kind == PickleKind::dictionary && items.size() % 2 != 0) throw fault("a key without value");
    PickleValue& to = top_of(kind, kind == PickleKind::sequence ? "a list" : "a dictionary");
    to.items.insert(to.items.end(), items.begin(), items.end());
  }
  void make_object() {
    std::vector<PickleRef> parts = pop_several(2);
    if (made_.values_[parts[0]].kind != PickleKind::global ||
        made_.values_[parts[1]].kind != PickleKind::sequence)
      throw fault("expected a name and its arguments");
    push_items(PickleKind::object, std::move(parts));
  }

  bool use_memo(char code) {
    switch (code) {
      case 'h': recall(number(1)); return true;
      case 'j': recall(number(4)); return true;
      case 'q': remember(number(1)); return true;
      case 'r': remember(number(4)); return true;
      case '\x94': remember(memo_.size()); return true;
      default: return false;
    }
  }
  void remember(std::uint64_t place) {
    const PickleRef top = pop();
    stack_.push_back(top);
    memo_[place] = top;
  }
  void recall(std::uint64_t place) {
    const auto found = memo_.find(place);
    if (found == memo_.end()) throw fault("nothing in the memo at " + std::to_string(place));
    stack_.push_back(found->second);
  }

  PickledValues& made_;
  std::string_view bytes_;
  std::size_t at_ = 0, begin_ = 0;  ///< of the opcode
  std::vector<PickleRef> stack_;
  std::vector<std::size_t> marks_;
  std::unordered_map<std::uint64_t, PickleRef> memo_;
  bool is_done_ = false;
};

PickledValues::PickledValues(std::filesystem::path file, std::string bytes)
    : file_(std::move(file)), bytes_(std::move(bytes)) {
  PickleMachine(*this).run();
}

const PickleValue* PickledValues::find(const PickleValue& dictionary, std::string_view key) const {
  if (dictionary.kind != PickleKind::dictionary) return nullptr;
  const std::size_t end = std::min<std::size_t>(dictionary.items.size(), 2000);
  for (std::size_t k = 0; k + 1 < end; k += 2) {
    const PickleValue& name = values_[dictionary.items[k]];
    if (name.kind == PickleKind::text && name.text == key) return &values_[dictionary.items[k + 1]];
  }
  return nullptr;
}

}  // namespace adasplats
