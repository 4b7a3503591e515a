// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/paper/paper_steps.h"

namespace adasplats::gpu {

// Private to gpu/: the steps of ModelEngine on one GPU. load() copies the cloud to it,
// take_splats() copies the splats back. All results are bit-identical to the CPU. Errors, with a
// remedy: unavailable (no such GPU, not enough memory), usage (neighbourhoods of more than 512
// points or cells). After an error, the steps can only be destroyed.

/// The steps of the paper's methods.
std::unique_ptr<PaperSteps> make_cuda_paper_steps(int device);

/// The steps of the ray-consistent method. They also expose their state (consistent_state.h).
std::unique_ptr<ConsistentSteps> make_cuda_consistent_steps(int device);

/// ModelEngine::measure_reflectances().
Reflectances measure_reflectances(int device, const std::vector<Disk>& disks,
                                  const std::vector<float>& fallback, const PointCloud& cloud);

}  // namespace adasplats::gpu
