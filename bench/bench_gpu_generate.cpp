// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Time of every step of build_model() on a GPU, from host memory to the model in host memory.
// Prints the median of several runs as one line of JSON.
//   bench_gpu_generate POINTS|INPUT [METHOD] [resample|no-resample] [RUNS] [cpu]
// POINTS makes a procedural street with about that many points. "cpu" repeats the build once on the
// CPU and reports how many splats differ.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/session/device_choice.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/synth/street.h"
#include "common.h"

namespace {

using namespace adasplats;

PointCloud street_cloud(std::size_t points, const Executor& executor, ProgressSink& progress) {
  StreetOptions options;
  options.length_m = street_length_for(points);
  StreetScanOptions scan;
  scan.points = points;
  scan.driving_spacing_m = 0;
  return scan_street(
             make_street(options), scan, [](std::size_t, const Scan&) {}, executor, progress)
      .mapping;
}

PointCloud input_cloud(const std::string& input, const Executor& executor, ProgressSink& progress) {
  if (!std::filesystem::exists(input)) {
    const auto points = static_cast<std::size_t>(std::strtoull(input.c_str(), nullptr, 10));
    return street_cloud(points, executor, progress);
  }
  const std::vector<std::filesystem::path> inputs = {input};
  return load_cloud(inputs, {}, executor, progress).first;
}

struct Run {
  double seconds;
  SplatModel model;
  BuildReport report;
};

Run timed_build(const PointCloud& cloud, const BuildOptions& options, const Executor& executor,
                const ModelEngine* engine) {
  ProgressSink quiet;
  PointCloud copy = cloud;
  const Stopwatch watch;
  auto [model, report] =
      build_model(std::move(copy), &semantickitti_labels(), options, executor, quiet, engine);
  return {watch.seconds(), std::move(model), std::move(report)};
}

void print_run(const char* device, const Run& run) {
  std::fprintf(stderr, "%s: %.3f s, %zu points, %zu noise, %zu new, %zu used, %zu splats\n", device,
               run.seconds, run.report.points_in, run.report.points_noise,
               run.report.points_resampled, run.report.points_used, run.report.primitives);
  for (const StepTime& step : run.report.steps)
    std::fprintf(stderr, "  %-18s %8.4f s\n", step.name.c_str(), step.seconds);
}

/// Number of splats of a model without an equal one in the other model.
std::size_t different(const SplatModel& model, const SplatModel& other) {
  const auto less = [](const Disk& a, const Disk& b) {
    return std::memcmp(&a, &b, sizeof(Disk)) < 0;
  };
  std::vector<Disk> own = model.disks, others = other.disks, missing;
  std::sort(own.begin(), own.end(), less);
  std::sort(others.begin(), others.end(), less);
  std::set_difference(own.begin(), own.end(), others.begin(), others.end(),
                      std::back_inserter(missing), less);
  return missing.size();
}

void run(const bench::Arguments& arguments) {
  const Executor executor;
  ProgressSink quiet;
  const PointCloud cloud = input_cloud(arguments.input(0), executor, quiet);
  BuildOptions options;
  MethodChoice choice;
  choice.method = value_of(arguments.input(1, "semantic"), kSplatMethods);
  choice.paper.resample = arguments.input(2) != "no-resample";
  options.recipe = choice.recipe();
  const auto engine = make_cuda_model_engine(0);
  std::vector<Run> runs;
  for (int i = 0; i < std::max(1, arguments.input_number(3, 3)); ++i) {
    runs.push_back(timed_build(cloud, options, executor, engine.get()));
    print_run("cuda", runs.back());
  }
  std::sort(runs.begin(), runs.end(),
            [](const Run& a, const Run& b) { return a.seconds < b.seconds; });
  const Run& median = runs[runs.size() / 2];
  const DeviceChoice device = choose_device({.kind = DeviceKind::cuda});
  const nlohmann::ordered_json result = {
      {"provenance", to_json(provenance_of(executor.threads(), device))},
      {"device", device.gpus[0].name},
      {"points", cloud.size()},
      {"method", arguments.input(1, "semantic")},
      {"resample", choice.paper.resample},
      {"splats", median.report.primitives},
      {"seconds", median.seconds},
      {"fastest_s", runs.front().seconds},
      {"slowest_s", runs.back().seconds}};
  std::printf("%s\n", result.dump().c_str());
  if (arguments.input(4) == "cpu") {
    const Run cpu = timed_build(cloud, options, executor, nullptr);
    print_run("cpu", cpu);
    std::printf("%zu of %zu splats differ from those of the CPU\n",
                different(median.model, cpu.model), median.model.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_gpu_generate", [&] {
    run({argc, argv,
         "bench_gpu_generate POINTS|INPUT [basic|descriptors|semantic|consistent] "
         "[resample|no-resample] [RUNS] [cpu]",
         1, 5});
  });
}
