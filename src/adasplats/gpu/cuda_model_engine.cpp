// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/gpu/base/model_steps.h"

namespace adasplats {
namespace {

class CudaModelEngine final : public ModelEngine {
 public:
  explicit CudaModelEngine(int device) : device_(device) {
    const gpu::DeviceGuard guard = gpu::enter_gpu(device, "build models");  // or throws now
  }

  std::string_view name() const override { return "cuda"; }
  std::unique_ptr<PaperSteps> paper_steps() const override {
    return gpu::make_cuda_paper_steps(device_);
  }
  std::unique_ptr<ConsistentSteps> consistent_steps() const override {
    return gpu::make_cuda_consistent_steps(device_);
  }
  Reflectances measure_reflectances(const std::vector<Disk>& disks,
                                    const std::vector<float>& fallback,
                                    const PointCloud& cloud) const override {
    return gpu::measure_reflectances(device_, disks, fallback, cloud);
  }

 private:
  int device_;
};

}  // namespace

std::unique_ptr<ModelEngine> make_cuda_model_engine(int device) {
  return std::make_unique<CudaModelEngine>(device);
}

}  // namespace adasplats
#endif
