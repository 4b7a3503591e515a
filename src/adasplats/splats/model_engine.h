// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/paper/paper_steps.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// Makes the steps of build_model for one device: the CPU's threads here, a GPU in gpu/.
class ModelEngine {
 public:
  virtual ~ModelEngine() = default;
  virtual std::string_view name() const = 0;
  virtual std::unique_ptr<PaperSteps> paper_steps() const = 0;
  virtual std::unique_ptr<ConsistentSteps> consistent_steps() const = 0;
  /// Measures the reflectances of disks with the rays of a cloud. See ReflectancesOn.
  virtual Reflectances measure_reflectances(const std::vector<Disk>& disks,
                                            const std::vector<float>& fallback,
                                            const PointCloud& cloud) const = 0;
};

/// The executor must outlive the engine.
std::unique_ptr<ModelEngine> make_cpu_model_engine(const Executor& executor);

}  // namespace adasplats
