// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model_engine.h"

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

 private:
  const Executor& executor_;
};

}  // namespace

std::unique_ptr<ModelEngine> make_cpu_model_engine(const Executor& executor) {
  return std::make_unique<CpuModelEngine>(executor);
}

}  // namespace adasplats
