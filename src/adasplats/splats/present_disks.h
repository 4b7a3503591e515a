// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Those of some disks that have a radius, ready to cast rays at.
class PresentDisks {
 public:
  PresentDisks(std::span<const Disk> disks, const Executor& executor);

  bool empty() const { return disks_.empty(); }
  const Tracer& tracer() const { return *tracer_; }
  /// Which of all disks a hit's primitive is.
  std::uint32_t id(std::uint32_t primitive) const { return ids_[primitive]; }

 private:
  std::vector<Disk> disks_;
  std::vector<std::uint32_t> ids_;
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace adasplats
