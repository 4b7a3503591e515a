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

/// Progress of work on the parts of a longer step. Passes on each warning once, whatever the
/// numbers in it, and reports at the end how often it was repeated. Does not pass on the steps of
/// the parts.
class RepeatedWarnings final : public ProgressSink {
 public:
  /// `parts`: the plural of their name, "tiles".
  RepeatedWarnings(ProgressSink& sink, std::string parts) : sink_(sink), parts_(std::move(parts)) {}

  void warn(std::string_view message) override {
    std::string kind;
    std::ranges::copy_if(message, std::back_inserter(kind),
                         [](char c) { return (c < '0' || c > '9') && c != '.' && c != ','; });
    const auto [first, is_new] = repeated_.try_emplace(std::move(kind), message, 0);
    if (is_new)
      sink_.warn(message);
    else
      ++first->second.second;
  }

  void end() {
    for (const auto& [kind, first] : repeated_)
      if (first.second > 0)
        sink_.warn(std::to_string(first.second) + " more " + parts_ +
                   " gave a warning like this: " + first.first);
    repeated_.clear();
  }

 private:
  ProgressSink& sink_;
  std::string parts_;
  std::map<std::string, std::pair<std::string, std::size_t>> repeated_;
};

}  // namespace adasplats
