// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "adasplats/core/setting.h"
#include "cli/interrupt.h"
#include "cli/terminal.h"

namespace adasplats::app {
namespace {

constexpr int kBarWidth = 30;
constexpr auto kMinInterval = std::chrono::milliseconds(100);

}  // namespace

ProgressBar::ProgressBar() : visible_(isatty(STDERR_FILENO) == 1 && isatty(STDOUT_FILENO) == 1) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::begin_step(std::string_view name, std::uint64_t total) {
  throw_if_interrupted();
  name_ = name;
  total_ = total;
  begun_ = std::chrono::steady_clock::now();
  draw(0);
}

void ProgressBar::advance(std::uint64_t done) {
  throw_if_interrupted();
  if (visible_ && std::chrono::steady_clock::now() - last_drawn_ >= kMinInterval) draw(done);
}

void ProgressBar::end_step() {
  clear();
  throw_if_interrupted();
}

void ProgressBar::warn(std::string_view message) {
  // Work that is repeated on another device repeats its warnings.
  if (std::find(warnings_.begin(), warnings_.end(), message) != warnings_.end()) return;
  clear();
  warnings_.emplace_back(message);
  print_message("warning: " + with_settings_as_options(warnings_.back()));
}

void ProgressBar::draw(std::uint64_t done) {
  if (!visible_) return;
  last_drawn_ = std::chrono::steady_clock::now();
  if (total_ == 0) {
    const std::chrono::duration<double> seconds = last_drawn_ - begun_;
    std::fprintf(stderr, "\r\033[K%s ... %.0f s", name_.c_str(), std::floor(seconds.count()));
  } else {
    const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    const int filled = static_cast<int>(share * kBarWidth);
    const std::string bar(static_cast<std::size_t>(filled), '#');
    std::fprintf(stderr, "\r\033[K%s [%-*s] %3d %%", name_.c_str(), kBarWidth, bar.c_str(),
                 static_cast<int>(share * 100));
  }
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (visible_) std::fputs("\r\033[K", stderr);
}

}  // namespace adasplats::app
