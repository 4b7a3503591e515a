// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/progress_meter.h"

#include <algorithm>

#include "adasplats/core/executor.h"

namespace adasplats {

void ProgressMeter::begin_step(std::string_view name, std::uint64_t total) {
  const std::lock_guard lock(mutex_);
  done_ = 0;
  elements_ = 0;
  step_thread_ = std::this_thread::get_id();
  sink_.begin_step(name, total);
}

void ProgressMeter::advance(std::uint64_t done) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  sink_.advance(done);
}

void ProgressMeter::end_step() {
  const std::lock_guard lock(mutex_);
  step_thread_ = std::thread::id();
  sink_.end_step();
}

bool ProgressMeter::begin_pass(std::uint64_t elements) {
  if (elements == 0 || elements_ != 0 || !is_step_thread()) return false;
  done_elements_ = 0;
  elements_ = elements;
  return true;
}

void ProgressMeter::end_pass() {
  elements_ = 0;
  done_ += kPassUnits;
}

void ProgressMeter::report() {
  // Another thread may be reporting: skip this figure.
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  const std::uint64_t elements = elements_;
  const std::uint64_t done = std::min<std::uint64_t>(done_elements_, elements);
  // In double: a product of elements and units may exceed 64 bits.
  const double share =
      elements == 0 ? 0 : static_cast<double>(done) / static_cast<double>(elements);
  sink_.advance(done_ + static_cast<std::uint64_t>(share * static_cast<double>(kPassUnits)));
}

ProgressPass::ProgressPass(const Executor& executor, std::uint64_t elements)
    : meter_(executor.meter()) {
  if (meter_ != nullptr && !meter_->begin_pass(elements)) meter_ = nullptr;
}

ProgressPass::~ProgressPass() {
  if (meter_ != nullptr) meter_->end_pass();
}

}  // namespace adasplats
