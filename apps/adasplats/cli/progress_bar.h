// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/progress.h"

namespace adasplats::app {

/// Shows steps as a bar on stderr if both stderr and stdout are terminals, prints every warning
/// once, and stops the work on Ctrl-C (by throwing Interrupted).
class ProgressBar final : public ProgressSink {
 public:
  ProgressBar();
  ~ProgressBar() override;

  void begin_step(std::string_view name, std::uint64_t total) override;
  void advance(std::uint64_t done) override;
  void end_step() override;
  void warn(std::string_view message) override;

  /// Messages of warn() so far.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  /// Seconds instead of a bar if the size of a step is unknown.
  void draw(std::uint64_t done);
  void clear();

  bool visible_;
  std::string name_;
  std::uint64_t total_ = 0;
  std::chrono::steady_clock::time_point begun_, last_drawn_;
  std::vector<std::string> warnings_;
};

}  // namespace adasplats::app
