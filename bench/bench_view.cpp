// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The main work of the viewer's server: building the tree of a model (a PLY file or a plane with
// the given number of splats) and of its centers as points, and encoding scan packets. With one
// thread and with all threads of the machine.
//   bench_view [MODEL.ply | SPLATS] [RESULT.json]

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/levels/level_tree.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/view/scan_packet.h"
#include "common.h"

namespace adasplats {
namespace {

constexpr int kRepeats = 3;  // for medians
constexpr std::size_t kPacketPoints = 100'000;
constexpr int kPackets = 200;

SplatModel plane_of(std::size_t splats) {
  SplatModel model;
  const double side_m = 0.05 * std::sqrt(static_cast<double>(splats));
  for (std::size_t i = 0; i < splats; ++i) {
    Random random(1, 0, i);
    const Vec3d center = {random.uniform(0, side_m), random.uniform(0, side_m), 0};
    model.disks.push_back({vec_cast<float>(center), 0.06F, {0, 0, 1}});
  }
  return model;
}

nlohmann::ordered_json measure_tree(const char* name, const LevelInput& input,
                                    const Executor& executor) {
  std::vector<double> seconds;
  std::size_t nodes = 0, elements = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const Stopwatch watch;
    const LevelTree tree(input, {}, executor);
    seconds.push_back(watch.seconds());
    nodes = tree.nodes().size();
    elements = 0;
    for (std::size_t n = 0; n < nodes; ++n) elements += tree.elements(n).size();
  }
  const double median_s = upper_median_of(seconds);
  const std::size_t size = input.disks.size() + input.positions.size();
  std::printf("%-7s %d threads  %8.3f s  %6zu nodes  %6.1f MB, %.2f elements per input element\n",
              name, executor.threads(), median_s, nodes,
              static_cast<double>(elements * sizeof(LevelElement)) * 1e-6,
              static_cast<double>(elements) / static_cast<double>(size));
  return {{"input", name},
          {"size", size},
          {"threads", executor.threads()},
          {"seconds", median_s},
          {"nodes", nodes},
          {"elements_over_size", static_cast<double>(elements) / static_cast<double>(size)}};
}

nlohmann::ordered_json measure_packets() {
  Scan scan;
  for (std::size_t i = 0; i < kPacketPoints; ++i) {
    scan.positions.push_back({static_cast<float>(i), 1, 2});
    scan.ranges_m.push_back(static_cast<float>(i));
    scan.classes.push_back(40);
    scan.intensities.push_back(0.5F);
    scan.rings.push_back(static_cast<std::uint16_t>(i % 64));
    scan.columns.push_back(static_cast<std::uint32_t>(i / 64));
  }
  scan.rays = kPacketPoints;
  std::size_t bytes = 0;
  const Stopwatch watch;
  for (int k = 0; k < kPackets; ++k)
    bytes += scan_packet(scan, {.rings = 64, .columns = 1800})->size();
  const double seconds = watch.seconds();
  std::printf("packets of %zu points: %.0f per second, %.1f GB/s, one thread\n", kPacketPoints,
              kPackets / seconds, 1e-9 * static_cast<double>(bytes) / seconds);
  return {{"points", kPacketPoints}, {"per_s", kPackets / seconds}};
}

void run(const std::string& input, const std::string& json) {
  std::size_t splats = 0;
  const auto [rest, problem] = std::from_chars(input.data(), input.data() + input.size(), splats);
  const bool is_count = problem == std::errc() && rest == input.data() + input.size();
  const SplatModel model = is_count ? plane_of(splats) : load_model(input);
  std::vector<Vec3f> centers;
  for (const Disk& disk : model.disks) centers.push_back(disk.center);
  nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(Executor().threads()))},
                                   {"trees", nlohmann::ordered_json::array()}};
  for (const int threads : {1, 0}) {
    const Executor executor(threads);
    result["trees"].push_back(measure_tree(
        "splats",
        {.disks = model.disks, .classes = model.classes, .intensities = model.intensities},
        executor));
    result["trees"].push_back(measure_tree(
        "points",
        {.positions = centers, .classes = model.classes, .intensities = model.intensities},
        executor));
  }
  result["packets"] = measure_packets();
  if (!json.empty()) write_file(json, result.dump(2) + "\n");
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  using namespace adasplats;
  return bench::exit_code_of("bench_view", [&] {
    const bench::Arguments arguments(argc, argv, "bench_view [MODEL.ply|SPLATS] [RESULT.json]", 0,
                                     2);
    run(arguments.input(0, "2000000"), arguments.input(1));
  });
}
