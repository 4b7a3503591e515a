// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/core/progress.h"

namespace adasplats {

/// Hears the work on pieces within a longer step: says each warning once, whatever the numbers in
/// it, and then of how many more pieces the like was to say. Steps of the pieces are not passed on.
class RepeatedWarnings final : public ProgressSink {
 public:
  /// `pieces`: what they are, "pieces of the drive".
  RepeatedWarnings(ProgressSink& sink, std::string pieces)
      : sink_(sink), pieces_(std::move(pieces)) {}

  void warn(std::string_view message) override {
    std::string kind;
    std::ranges::copy_if(message, std::back_inserter(kind),
                         [](char c) { return (c < '0' || c > '9') && c != '.' && c != ','; });
    const auto [known, is_new] = repeated_.try_emplace(std::move(kind), message, 0);
    if (is_new)
      sink_.warn(message);
    else
      ++known->second.second;
  }

  void end() {
    for (const auto& [kind, first] : repeated_)
      if (first.second > 0)
        sink_.warn("of " + std::to_string(first.second) + " more " + pieces_ +
                   " the like was to say: " + first.first);
    repeated_.clear();
  }

 private:
  ProgressSink& sink_;
  std::string pieces_;
  std::map<std::string, std::pair<std::string, std::size_t>> repeated_;
};

}  // namespace adasplats
