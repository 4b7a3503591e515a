// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/disk_evidence.h"
#include "adasplats/splats/rays/disk_shift.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {

/// Moves every disk along its normal to where the rays that meet it first say the surface is. The
/// first of several disks a few centimetres apart is met too early on average: this takes that
/// bias out. Sums are whole numbers: the same on any number of threads.
void settle_disks(std::span<Disk> disks, const MeasuredRays& rays, const SettleOptions& options,
                  const Executor& executor);

}  // namespace adasplats
