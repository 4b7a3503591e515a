// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

// WKT 2 needs about 10.
constexpr std::size_t kMaxWktDepth = 32;

/// Takes a text apart, character by character.
class WktParser {
 public:
  WktNode parse(std::string_view text) {
    for (const char c : text) {
      if (c == '\0' || is_done_) break;
      take(c);
    }
    while (!open_.empty()) close();
    return std::move(first_);
  }

 private:
  void take(char c) {
    if (c == '"') {
      is_quoted_ = !is_quoted_;
    } else if (is_quoted_) {
      word_ += c;
    } else if (c == '[' || c == '(') {
      open();
    } else if (c == ',' || c == ']' || c == ')') {
      end_value();
      if (c != ',') close();
    } else {
      word_ += c == '\n' || c == '\r' ? ' ' : c;
    }
  }

  void open() {
    if (open_.size() == kMaxWktDepth) {
      ++too_deep_;
    } else {
      open_.push_back({lower_case(BlankTokens(word_).rest()), {}, {}});
    }
    word_.clear();
  }

  void end_value() {
    const std::string_view value = BlankTokens(word_).rest();
    if (!open_.empty() && too_deep_ == 0 && !value.empty()) open_.back().values.emplace_back(value);
    word_.clear();
  }

  void close() {
    if (too_deep_ > 0) {
      --too_deep_;
      return;
    }
    if (open_.empty()) return;
    WktNode node = std::move(open_.back());
    open_.pop_back();
    if (!open_.empty()) {
      open_.back().nodes.push_back(std::move(node));
      return;
    }
    first_ = std::move(node);
    is_done_ = true;
  }

  std::vector<WktNode> open_;
  std::size_t too_deep_ = 0;
  std::string word_;
  bool is_quoted_ = false;
  bool is_done_ = false;
  WktNode first_;
};

}  // namespace

bool WktNode::is_one_of(std::initializer_list<std::string_view> keywords) const {
  return std::ranges::find(keywords, keyword) != keywords.end();
}

const WktNode* WktNode::find(std::initializer_list<std::string_view> keywords) const {
  const auto found =
      std::ranges::find_if(nodes, [&](const WktNode& node) { return node.is_one_of(keywords); });
  return found == nodes.end() ? nullptr : &*found;
}

WktNode parse_wkt(std::string_view text) { return WktParser().parse(text); }

}  // namespace adasplats
