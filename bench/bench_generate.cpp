// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Time of every step of build_model() on a cloud.
//   bench_generate INPUT basic|descriptors|semantic [resample|no-resample] [THREADS]

#include <cstdio>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/memory.h"
#include "adasplats/splats/build_model.h"
#include "common.h"

namespace {

using namespace adasplats;

void run(const bench::Arguments& arguments) {
  BuildOptions options;
  MethodChoice choice;
  choice.method = value_of(arguments.input(1), kSplatMethods);
  choice.paper.resample = arguments.input(2) != "no-resample";
  options.recipe = choice.recipe();
  options.remove = DynamicRemoval::moving;
  const Executor executor(arguments.input_number(3, 0));
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {arguments.input(0)};
  PointCloud cloud = load_cloud(inputs, {}, executor, quiet).first;
  const auto [model, report] =
      build_model(std::move(cloud), &semantickitti_labels(), options, executor, quiet);
  double total = 0;
  for (const StepTime& step : report.steps) {
    std::printf("%-16s %8.2f s\n", step.name.c_str(), step.seconds);
    total += step.seconds;
  }
  std::printf("%-16s %8.2f s on %d threads\n", "total", total, executor.threads());
  std::printf(
      "%zu points, %zu noise, %zu new, %zu used, %zu splats; R %.4f m, E %.5f m; peak %.2f GB\n",
      report.points_in, report.points_noise, report.points_resampled, report.points_used,
      report.primitives, report.radius_m, report.error_m,
      static_cast<double>(peak_memory_bytes()) * 1e-9);
}

}  // namespace

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_generate", [&] {
    run({argc, argv,
         "bench_generate INPUT basic|descriptors|semantic [resample|no-resample] [THREADS]", 2, 4});
  });
}
