// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What the viewer's server has to do: the tree of a model (of a PLY, or of a plane of so many
// splats) and of its centers as points, and scan packets. One thread stands beside as many as the
// machine has.
//   bench_view [MODEL.ply | SPLATS] [RESULT.json]

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/levels/level_tree.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/view/scan_packet.h"

namespace adasplats {
namespace {

constexpr int kRepeats = 3;  // the median is printed
constexpr std::size_t kPacketPoints = 100'000;
constexpr int kPackets = 200;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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
    const auto start = std::chrono::steady_clock::now();
    const LevelTree tree(input, {}, executor);
    seconds.push_back(seconds_since(start));
    nodes = tree.nodes().size();
    elements = 0;
    for (std::size_t n = 0; n < nodes; ++n) elements += tree.elements(n).size();
  }
  std::ranges::sort(seconds);
  const std::size_t size = input.disks.size() + input.positions.size();
  std::printf("%-7s %d threads  %8.3f s  %6zu nodes  %6.1f MB, %.2f elements an input's\n", name,
              executor.threads(), seconds[kRepeats / 2], nodes,
              static_cast<double>(elements * sizeof(LevelElement)) * 1e-6,
              static_cast<double>(elements) / static_cast<double>(size));
  return {{"input", name},
          {"size", size},
          {"threads", executor.threads()},
          {"seconds", seconds[kRepeats / 2]},
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
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < kPackets; ++k)
    bytes += scan_packet(scan, {.rings = 64, .columns = 1800})->size();
  const double seconds = seconds_since(start);
  std::printf("packets of %zu points: %.0f a second, %.1f GB/s, one thread\n", kPacketPoints,
              kPackets / seconds, 1e-9 * static_cast<double>(bytes) / seconds);
  return {{"points", kPacketPoints}, {"per_s", kPackets / seconds}};
}

void run(const std::string& what, const std::string& json) {
  std::size_t splats = 0;
  const auto [rest, problem] = std::from_chars(what.data(), what.data() + what.size(), splats);
  const bool is_count = problem == std::errc() && rest == what.data() + what.size();
  const SplatModel model = is_count ? plane_of(splats) : load_model(what);
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
  try {
    adasplats::run(argc > 1 ? argv[1] : "2000000", argc > 2 ? argv[2] : "");
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_view: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
