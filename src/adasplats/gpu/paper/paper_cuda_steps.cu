// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "adasplats/gpu/base/model_steps.h"
#include "adasplats/gpu/neighbors/gpu_backend.cuh"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/gpu/paper/paper_generation.h"
#include "adasplats/gpu/paper/paper_resample.h"
#include "adasplats/gpu/paper/paper_shapes.h"
#include "adasplats/splats/paper/paper_steps_on.h"

namespace adasplats::gpu {
namespace {

/// GPU backend of the steps of the paper's methods.
class PaperOnGpu : public GpuBackend {
 public:
  using Generation = DeviceGeneration;
  using GpuBackend::GpuBackend;

  DeviceBuffer<SemanticGroup> copied(const std::vector<SemanticGroup>& groups) const {
    return {std::span(groups), stream()};
  }
  DeviceBase base(const DeviceCloud& cloud, const BaseNeighborhoodOptions& options) const {
    const DevicePointIndex index(cloud.positions.data(), cloud.size(), stream());
    return base_neighborhoods(cloud.positions.data(), index, options, stream());
  }
  DeviceGeneration generate(const DeviceCloud& cloud, const DeviceBuffer<SemanticGroup>& groups,
                            const PaperOptions& options, StepSink step) const {
    return generate_splats(*this, cloud, groups, options, step);
  }
  DeviceResampled resample(const DeviceCloud& cloud, const DeviceGeneration& first,
                           const PaperOptions& options) const {
    return gpu::resample(cloud, first, options, stream());
  }
};

}  // namespace

std::unique_ptr<PaperSteps> make_cuda_paper_steps(int device) {
  const DeviceGuard guard(device);
  return std::make_unique<PaperStepsOn<PaperOnGpu>>(device);
}

}  // namespace adasplats::gpu
