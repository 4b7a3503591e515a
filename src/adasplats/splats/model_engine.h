// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "adasplats/core/executor.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/paper/paper_steps.h"

namespace adasplats {

/// Makes the steps of build_model for one device: the CPU's threads here, a GPU in gpu/.
class ModelEngine {
 public:
  virtual ~ModelEngine() = default;
  virtual std::string_view name() const = 0;
  virtual std::unique_ptr<PaperSteps> paper_steps() const = 0;
  virtual std::unique_ptr<ConsistentSteps> consistent_steps() const = 0;
};

/// The executor must outlive the engine.
std::unique_ptr<ModelEngine> make_cpu_model_engine(const Executor& executor);

}  // namespace adasplats
