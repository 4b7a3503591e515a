// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pickle/data_frame.h"

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/io/pickle/pickled_array.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxUnpacked = std::size_t{1} << 30;
constexpr std::size_t kMaxParts = 4096;
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 26;
constexpr std::string_view kGzipStart = "\x1f\x8b";

/// Builds a table from a pickle.
class DataFrameReader {
 public:
  DataFrameReader(const PickledValues& pickle, bool with_texts)
      : pickle_(pickle), with_texts_(with_texts) {}

  FrameTable read() {
    const PickleValue& frame = pickle_.root();
    if (!made_by(pickle_, frame).ends_with("DataFrame")) throw fault("holds no data frame");
    if (const PickleValue* const columns = argument_of(pickle_, frame, 0)) {
      read_dictionary(*columns);
      return {std::move(table_), std::move(texts_)};
    }
    const PickleValue* const state = state_of(pickle_, frame);
    const PickleValue* manager = nullptr;
    if (state != nullptr) manager = pickle_.find(*state, "_mgr");
    if (state != nullptr && manager == nullptr) manager = pickle_.find(*state, "_data");
    if (manager == nullptr || !made_by(pickle_, *manager).ends_with("BlockManager"))
      throw fault("a data frame without its blocks");
    if (const PickleValue* const blocks = argument_of(pickle_, *manager, 0))
      read_blocks(*blocks, argument_of(pickle_, *manager, 1));
    else
      read_old_blocks(state_of(pickle_, *manager));
    return {std::move(table_), std::move(texts_)};
  }

 private:
  Error fault(const std::string& what) const {
    return {ErrorKind::data, pickle_.file().string() + ": " + what};
  }

  /// A pickle may refer to values many times, which would be more work than its size suggests.
  void require_few(std::size_t count, const std::string& what) const {
    if (count > kMaxParts)
      throw fault(std::to_string(count) + " " + what + ", expected at most " +
                  std::to_string(kMaxParts));
  }

  void add(std::string_view name, const PickledArray& array, std::size_t line) {
    if (!has_rows_) table_.rows = array.length;
    has_rows_ = true;
    if (array.length != table_.rows)
      throw fault("columns of " + std::to_string(table_.rows) + " and of " +
                  std::to_string(array.length) + " rows");
    if (array.is_objects && !with_texts_) return;
    if (table_.find(name) != nullptr || texts_.contains(name))
      throw fault("two columns " + shown(name));
    if (array.is_objects) {
      texts_.emplace(name, texts_of(array, line));
      return;
    }
    used_bytes_ += array.bytes_of_line();
    if (used_bytes_ > pickle_.size_bytes()) throw fault("columns share their values");
    table_.columns.push_back(array.column(name, line));
  }

  std::vector<std::string> texts_of(const PickledArray& array, std::size_t line) {
    std::vector<std::string> texts;
    if (array.objects == nullptr) throw fault("a column of objects without objects");
    for (std::size_t i = 0; i < array.length; ++i) {
      const PickleValue& value = pickle_[(*array.objects)[array.index_of(line, i)]];
      texts.emplace_back(value.kind == PickleKind::text ? value.text : std::string_view());
      text_bytes_ += sizeof(std::string) + texts.back().size();
      if (text_bytes_ > kMaxTextBytes) throw fault("more than 64 MiB of texts");
    }
    return texts;
  }

  /// DataFrame({name: array, ...}).
  void read_dictionary(const PickleValue& columns) {
    if (columns.kind != PickleKind::dictionary) throw fault("expected a dictionary of columns");
    require_few(columns.items.size() / 2, "columns");
    for (std::size_t k = 0; k + 1 < columns.items.size(); k += 2) {
      const PickleValue& name = pickle_[columns.items[k]];
      const PickleValue& values = pickle_[columns.items[k + 1]];
      if (name.kind != PickleKind::text) throw fault("a column whose name is not a text");
      PickledArray array;
      if (values.kind == PickleKind::sequence) {
        array.is_objects = true;
        array.objects = &values.items;
        array.length = values.items.size();
      } else {
        array = pickled_array(pickle_, values);
      }
      if (array.lines != 1) throw fault("a column of two dimensions");
      add(name.text, array, 0);
    }
  }

  /// The names of the columns, from an index made by _new_Index(class, {"data": array, ...}).
  std::vector<std::string_view> names_of(const PickleValue* axes) const {
    if (axes == nullptr || axes->kind != PickleKind::sequence || axes->items.size() != 2)
      throw fault("a data frame without names of columns");
    const PickleValue* const content = argument_of(pickle_, pickle_[axes->items[0]], 1);
    const PickleValue* const data = content == nullptr ? nullptr : pickle_.find(*content, "data");
    if (data == nullptr) throw fault("a data frame whose columns have no names");
    const PickledArray array = pickled_array(pickle_, *data);
    std::vector<std::string_view> names;
    if (array.objects == nullptr || array.lines != 1)
      throw fault("names of columns that are not texts");
    require_few(array.length, "columns");
    for (const PickleRef ref : *array.objects) {
      if (pickle_[ref].kind != PickleKind::text) throw fault("a column whose name is not a text");
      names.push_back(pickle_[ref].text);
    }
    return names;
  }

  /// The columns of a block's lines: a slice, or an array of numbers.
  std::vector<std::int64_t> places_of(const PickleValue& placement, std::size_t lines) const {
    std::vector<std::int64_t> places;
    if (made_by(pickle_, placement).ends_with(".slice")) {
      const PickleValue* const start = argument_of(pickle_, placement, 0);
      const PickleValue* const step = argument_of(pickle_, placement, 2);
      if (start == nullptr || step == nullptr || start->kind != PickleKind::integer)
        throw fault("a block without columns");
      const std::int64_t apart = step->kind == PickleKind::integer ? step->integer : 1;
      constexpr std::int64_t kMaxColumn = 1 << 20;  // so that sums do not wrap
      if (start->integer < 0 || start->integer > kMaxColumn || apart < -kMaxColumn ||
          apart > kMaxColumn || lines > static_cast<std::size_t>(kMaxColumn))
        throw fault("a block with impossible columns");
      for (std::size_t k = 0; k < lines; ++k)
        places.push_back(start->integer + apart * static_cast<std::int64_t>(k));
      return places;
    }
    const PickledArray array = pickled_array(pickle_, placement);
    if (array.is_objects || array.lines != 1 || array.length != lines ||
        array.type != ColumnType::i64)
      throw fault("a block of " + std::to_string(lines) + " columns has an invalid placement");
    return std::get<std::vector<std::int64_t>>(array.column("", 0).values);
  }

  void read_block(const PickleValue& values, const PickleValue& placement,
                  const std::vector<std::string_view>& names) {
    const PickledArray array = pickled_array(pickle_, values);
    if (array.lines > names.size())
      throw fault("a block of " + std::to_string(array.lines) + " columns, of a frame of " +
                  std::to_string(names.size()));
    const std::vector<std::int64_t> places = places_of(placement, array.lines);
    for (std::size_t line = 0; line < array.lines; ++line) {
      if (places[line] < 0 || places[line] >= static_cast<std::int64_t>(names.size()))
        throw fault("a block is of column " + std::to_string(places[line]) + ", of " +
                    std::to_string(names.size()));
      add(names[static_cast<std::size_t>(places[line])], array, line);
    }
  }

  /// Since pandas 1.3: BlockManager((_unpickle_block(values, placement, 2), ...), axes).
  void read_blocks(const PickleValue& blocks, const PickleValue* axes) {
    const std::vector<std::string_view> names = names_of(axes);
    require_few(blocks.items.size(), "blocks");
    for (const PickleRef ref : blocks.items) {
      const PickleValue* const values = argument_of(pickle_, pickle_[ref], 0);
      const PickleValue* const placement = argument_of(pickle_, pickle_[ref], 1);
      if (values == nullptr || placement == nullptr) throw fault("a block without values");
      read_block(*values, *placement, names);
    }
  }

  /// Before: a state whose fourth value is {"0.14.1": {"axes": ..., "blocks": [{"values": ...,
  /// "mgr_locs": ...}, ...]}}.
  void read_old_blocks(const PickleValue* state) {
    const PickleValue* content = nullptr;
    if (state != nullptr && state->kind == PickleKind::sequence && state->items.size() >= 4)
      content = pickle_.find(pickle_[state->items[3]], "0.14.1");
    const PickleValue* const blocks =
        content == nullptr ? nullptr : pickle_.find(*content, "blocks");
    if (blocks == nullptr) throw fault("a data frame without its blocks");
    const std::vector<std::string_view> names = names_of(pickle_.find(*content, "axes"));
    require_few(blocks->items.size(), "blocks");
    for (const PickleRef ref : blocks->items) {
      const PickleValue* const values = pickle_.find(pickle_[ref], "values");
      const PickleValue* const placement = pickle_.find(pickle_[ref], "mgr_locs");
      if (values == nullptr || placement == nullptr) throw fault("a block without values");
      read_block(*values, *placement, names);
    }
  }

  const PickledValues& pickle_;
  bool with_texts_;
  Table table_;
  std::map<std::string, std::vector<std::string>, std::less<>> texts_;
  bool has_rows_ = false;
  std::size_t used_bytes_ = 0, text_bytes_ = 0;
};

/// The bytes of a pickle, gzipped or not.
std::string read_pickle_bytes(const std::filesystem::path& path) {
  std::string bytes = read_file(path);
  if (bytes.starts_with(kGzipStart)) bytes = gunzipped(path, bytes, kMaxUnpacked);
  return bytes;
}

}  // namespace

Table data_frame_of(const std::filesystem::path& path, std::string pickle) {
  const PickledValues values(path, std::move(pickle));
  return DataFrameReader(values, false).read().numbers;
}

Table read_data_frame(const std::filesystem::path& path) {
  return data_frame_of(path, read_pickle_bytes(path));
}

FrameTable frame_table_of(const std::filesystem::path& path, std::string pickle) {
  const PickledValues values(path, std::move(pickle));
  return DataFrameReader(values, true).read();
}

FrameTable read_frame_table(const std::filesystem::path& path) {
  return frame_table_of(path, read_pickle_bytes(path));
}

}  // namespace adasplats
