// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/paper/paper_steps.h"

namespace adasplats::gpu {

// Private to gpu/: the steps of ModelEngine in the memory of one GPU. The cloud is copied there in
// load(), the splats come back in take_splats(). Everything has the CPU's bits. Errors: unavailable
// (no such GPU, not enough memory), usage (neighbourhoods of more than 512 points or cells), with a
// remedy; after one, the steps can only be destroyed.

/// The steps of the paper's methods.
std::unique_ptr<PaperSteps> make_cuda_paper_steps(int device);

/// The steps of the ray-consistent method. They also show their state (consistent_state.h).
std::unique_ptr<ConsistentSteps> make_cuda_consistent_steps(int device);

/// ModelEngine::measure_reflectances().
Reflectances measure_reflectances(int device, const std::vector<Disk>& disks,
                                  const std::vector<float>& fallback, const PointCloud& cloud);

}  // namespace adasplats::gpu
