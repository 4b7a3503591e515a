// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only.

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/progress.h"

namespace adasplats {

/// Remembers all that it hears.
class RecordedProgress final : public ProgressSink {
 public:
  struct Step {
    std::string name;
    std::uint64_t total = 0;
    std::vector<std::uint64_t> done;
    bool is_ended = false;

    int increases() const {
      int count = 0;
      for (std::size_t i = 1; i < done.size(); ++i) count += done[i] > done[i - 1] ? 1 : 0;
      return count;
    }
    bool never_falls() const { return std::ranges::is_sorted(done); }
  };

  void begin_step(std::string_view name, std::uint64_t total) override {
    steps.push_back({std::string(name), total, {}, false});
  }
  void advance(std::uint64_t done) override { steps.back().done.push_back(done); }
  void end_step() override { steps.back().is_ended = true; }
  void warn(std::string_view message) override { warnings.emplace_back(message); }

  std::vector<Step> steps;
  std::vector<std::string> warnings;
};

}  // namespace adasplats
