// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {

/// What the rays that meet each disk first near their ends say of its place. Sums are whole
/// numbers: the same on any number of threads.
std::vector<ShiftSums> sum_shifts(std::span<const Disk> disks, const MeasuredRays& rays,
                                  const SettleOptions& options, const Executor& executor);

/// Moves every disk along its normal to where the rays that meet it first say the surface is. The
/// first of several disks a few centimetres apart is met too early on average: this takes that
/// bias out. Sums are whole numbers: the same on any number of threads.
void settle_disks(std::span<Disk> disks, const MeasuredRays& rays, const SettleOptions& options,
                  const Executor& executor);

}  // namespace adasplats
