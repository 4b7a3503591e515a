// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Time of every step of the consistent method on the CPU or on a GPU, from host to host.
//   bench_gpu_consistent INPUT cpu|cuda [REPEATS [COPIES [MODEL.ply]]]
// COPIES: the cloud is put side by side so many times, for a larger one. The first run on a GPU
// pays for its start; the median of the others is printed as one line of JSON.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/model/splat_model.h"

namespace {

using namespace adasplats;

class StepTimer {
 public:
  void begin(std::string_view name) {
    const auto now = Clock::now();
    if (!name_.empty()) seconds_[name_].push_back(last_ = Seconds(now - start_).count());
    name_ = std::string(name);
    if (std::find(order_.begin(), order_.end(), name_) == order_.end()) order_.push_back(name_);
    start_ = now;
  }
  /// Ends the last step; what comes before the next one does not count.
  void end() {
    begin("");
    order_.pop_back();
  }
  double last() const { return last_; }

  void print_json() {
    std::printf("{");
    for (const std::string& name : order_) {
      std::vector<double>& all = seconds_[name];
      if (all.empty()) continue;
      if (all.size() > 1) all.erase(all.begin());
      std::sort(all.begin(), all.end());
      std::printf("%s\"%s\": %.4f", name == order_[0] ? "" : ", ", name.c_str(),
                  all[all.size() / 2]);
    }
    std::printf("}\n");
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  std::string name_;
  double last_ = 0;
  Clock::time_point start_;
  std::vector<std::string> order_;
  std::map<std::string, std::vector<double>> seconds_;
};

PointCloud side_by_side(const PointCloud& cloud, int copies) {
  PointCloud all = cloud;
  for (int k = 1; k < copies; ++k) {
    PointCloud other = cloud;
    const Vec3f shift = {0, 0, 400.0F * static_cast<float>(k)};
    for (Vec3f& p : other.positions) p = p + shift;
    for (Vec3f& p : other.sensor_positions) p = p + shift;
    append(all, std::move(other));
  }
  return all;
}

/// FNV-1a of the disks.
unsigned long long hash_of(const std::vector<Disk>& disks) {
  unsigned long long hash = 14695981039346656037ULL;
  const auto* bytes = reinterpret_cast<const unsigned char*>(disks.data());
  for (std::size_t i = 0; i < disks.size() * sizeof(Disk); ++i)
    hash = (hash ^ bytes[i]) * 1099511628211ULL;
  return hash;
}

int run(int argc, char** argv) {
  const bool on_gpu = std::strcmp(argv[2], "cuda") == 0;
  const int repeats = argc > 3 ? std::atoi(argv[3]) : 1;
  const Executor executor;
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {argv[1]};
  const PointCloud loaded = load_cloud(inputs, {}, executor, quiet).first;
  const PointCloud cloud = side_by_side(loaded, argc > 4 ? std::atoi(argv[4]) : 1);
  StepTimer total, steps_timer;
  SplatModel model;
  for (int k = 0; k < repeats; ++k) {
    PointCloud copy = cloud;
    total.begin("total");
    steps_timer.begin("start");
    const auto steps = on_gpu ? make_cuda_model_engine(0)->consistent_steps()
                              : make_cpu_consistent_steps(executor);
    steps_timer.begin("order");
    steps->load(std::move(copy), {});
    consistent_disks(*steps, !cloud.sensor_positions.empty(), {},
                     [&](std::string_view name, int) { steps_timer.begin(name); });
    steps_timer.begin("take");
    model.disks = steps->take_splats().disks;
    steps_timer.end();
    total.end();
    std::printf("run %d: %zu points, %zu splats, hash %016llx, %.3f s\n", k, cloud.size(),
                model.size(), hash_of(model.disks), total.last());
  }
  total.print_json();
  steps_timer.print_json();
  model.origin = cloud.origin;
  model.method = "consistent";
  if (argc > 5) save_model(argv[5], model);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr,
                 "usage: bench_gpu_consistent INPUT cpu|cuda [REPEATS [COPIES [MODEL.ply]]]\n");
    return 64;
  }
  try {
    return run(argc, argv);
  } catch (const adasplats::Error& error) {
    std::fprintf(stderr, "bench_gpu_consistent: error: %s\n", error.what());
    return adasplats::exit_code(error.kind());
  }
}
