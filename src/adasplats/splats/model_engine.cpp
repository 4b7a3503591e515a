// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model_engine.h"

#include "adasplats/splats/model/cpu_backend.h"
#include "adasplats/splats/reflectance/reflectances_on.h"

namespace adasplats {
namespace {

class CpuModelEngine final : public ModelEngine {
 public:
  explicit CpuModelEngine(const Executor& executor) : executor_(executor) {}

  std::string_view name() const override { return "cpu"; }
  std::unique_ptr<PaperSteps> paper_steps() const override {
    return make_cpu_paper_steps(executor_);
  }
  std::unique_ptr<ConsistentSteps> consistent_steps() const override {
    return make_cpu_consistent_steps(executor_);
  }
  Reflectances measure_reflectances(const std::vector<Disk>& disks,
                                    const std::vector<float>& fallback,
                                    const PointCloud& cloud) const override {
    const RaysOnCpu backend(executor_);
    if (!cloud.has_beams() || cloud.intensities.empty()) return {fallback, {}};
    const MeasuredRays rays(cloud, kMinReflectanceRange_m, executor_);
    const RaysWithIntensities<RaysOnCpu> measured = {&rays, &cloud.intensities};
    return ReflectancesOn<RaysOnCpu>(backend, disks, fallback).run({&measured, 1});
  }

 private:
  const Executor& executor_;
};

}  // namespace

std::unique_ptr<ModelEngine> make_cpu_model_engine(const Executor& executor) {
  return std::make_unique<CpuModelEngine>(executor);
}

}  // namespace adasplats
