// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Time of every step of build_model on a cloud.
//   bench_generate INPUT METHOD(basic|descriptors|semantic) [resample|no-resample] [THREADS]

#include <cstdio>
#include <cstring>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/core/memory.h"
#include "adasplats/splats/build_model.h"

namespace {

using namespace adasplats;

int run(int argc, char** argv) {
  BuildOptions options;
  MethodChoice choice;
  choice.method = value_of(argv[2], kSplatMethods);
  choice.paper.resample = argc <= 3 || std::strcmp(argv[3], "no-resample") != 0;
  options.recipe = choice.recipe();
  options.remove = DynamicRemoval::moving;
  const Executor executor(argc > 4 ? std::atoi(argv[4]) : 0);
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {argv[1]};
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
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr,
                 "usage: bench_generate INPUT basic|descriptors|semantic [resample|no-resample] "
                 "[THREADS]\n");
    return 64;
  }
  try {
    return run(argc, argv);
  } catch (const adasplats::Error& error) {
    std::fprintf(stderr, "bench_generate: error: %s\n", error.what());
    return adasplats::exit_code(error.kind());
  }
}
