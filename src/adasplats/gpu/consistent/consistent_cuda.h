// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/splats/consistent/consistent_steps.h"

namespace adasplats::gpu {

/// The steps of the ray-consistent method in the memory of one GPU: the cloud goes there in load(),
/// the splats come back in take_splats(). The steps also show their state (consistent_state.h).
/// All results are those of the CPU, bit by bit.
/// Errors: unavailable (no such GPU, not enough memory), usage (neighbourhoods of more than 512
/// cells), with what helps; after one, the steps can only be destroyed.
std::unique_ptr<ConsistentSteps> make_cuda_consistent_steps(int device);

/// ModelEngine::measure_reflectances() on one GPU. Errors: unavailable (no such GPU, not enough
/// memory), with what helps.
Reflectances measure_reflectances(int device, const std::vector<Disk>& disks,
                                  const std::vector<float>& fallback, const PointCloud& cloud);

}  // namespace adasplats::gpu
