// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// The cost of objects of other scans: hits of moving splats added to HDL-64 scans in worlds with
// few and with many frames and equal numbers of splats per frame, alternating in one run.
//   bench_world [--splats-per-frame N] [--threads N] [--json FILE]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/simulate/world/world.h"
#include "common.h"

namespace adasplats {
namespace {

constexpr std::size_t kFewFrames = 16;
constexpr std::size_t kManyFrames = 1000;
constexpr int kRounds = 150;
constexpr float kSplatRadius_m = 0.14F;  // paper section "SimKITTI32"

/// Ten cars around the sensor, as boxes of random splats.
SplatModel traffic(std::size_t splats, std::uint64_t frame) {
  constexpr std::size_t kCars = 10;
  SplatModel model;
  for (std::size_t i = 0; i < splats; ++i) {
    const std::size_t car = i % kCars;
    Random position(1, frame, car);
    const double range_m = position.uniform(5, 45),
                 azimuth_rad = position.uniform(0, 2 * std::numbers::pi);
    Random random(2, frame, i);
    const Vec3d on_car = {random.uniform(-2.2, 2.2), random.uniform(-0.9, 0.9),
                          random.uniform(-1.7, -0.2)};
    const Vec3d center =
        Vec3d{range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad), 0} + on_car;
    const Vec3f c = vec_cast<float>(center);
    model.disks.push_back({c, kSplatRadius_m, normalized(-c)});
  }
  return model;
}

TimedPose pose_of(std::size_t frame) {
  const auto x = static_cast<double>(frame);
  return {0.1 * x, {rotation_from_yaw_pitch_roll(0.01 * x, 0, 0), {x, 0, 0}}};
}

World world_of(std::size_t frames, std::size_t splats_per_frame) {
  World world(0, {});
  for (std::size_t frame = 0; frame < frames; ++frame) {
    WorldObject moving;
    moving.geometry = world.add_geometry(traffic(splats_per_frame, frame));
    moving.trajectory = {pose_of(frame)};
    moving.only_scan = frame;
    world.add_object(std::move(moving));
  }
  return world;
}

struct Figure {
  std::size_t frames;
  World world;
  std::vector<double> seconds = {};  ///< per scan
  std::size_t hits = 0;

  double median_s() const { return upper_median_of(std::vector(seconds)); }
};

/// Alternates between the worlds; the rounds are spread over all frames.
void measure(std::vector<Figure>& figures, const Executor& executor) {
  const LidarModel sensor = hdl_64_paper();
  const std::vector<Firing> firings = firings_of(sensor);
  std::vector<Hit> hits(firings.size());
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (Figure& figure : figures) {
      constexpr std::size_t kStride = 61;
      const std::size_t frame = round * kStride % figure.frames;
      const ScanMotion motion = {pose_of(frame), {}};
      std::ranges::fill(hits, Hit{});
      const Stopwatch watch;
      figure.world.add_hits(frame, sensor, firings, motion, 0.1, 1, hits, executor);
      figure.seconds.push_back(watch.seconds());
      figure.hits += static_cast<std::size_t>(std::ranges::count_if(hits, &Hit::valid));
    }
  }
}

void run(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  const auto splats_per_frame = arguments.number<std::size_t>("--splats-per-frame", 5000);
  std::vector<Figure> figures;
  for (const std::size_t frames : {kFewFrames, kManyFrames})
    figures.push_back({frames, world_of(frames, splats_per_frame)});
  measure(figures, executor);
  const double ratio = figures[1].median_s() / figures[0].median_s();
  std::printf("%zu splats per frame, %d threads\n", splats_per_frame, executor.threads());
  nlohmann::json rows = nlohmann::json::array();
  for (const Figure& figure : figures) {
    const std::size_t hits_per_scan = figure.hits / figure.seconds.size();
    std::printf("%5zu frames  %7.3f ms per scan   %zu hits\n", figure.frames,
                1e3 * figure.median_s(), hits_per_scan);
    rows.push_back({{"frames", figure.frames},
                    {"seconds_per_scan", figure.median_s()},
                    {"hits_per_scan", hits_per_scan}});
  }
  std::printf("time ratio of many to few frames: %.3f\n", ratio);
  if (!arguments.has("--json")) return;
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(executor.threads()))},
                                         {"splats_per_frame", splats_per_frame},
                                         {"threads", executor.threads()},
                                         {"few_frames_s", figures[0].median_s()},
                                         {"many_frames_s", figures[1].median_s()},
                                         {"ratio", ratio},
                                         {"figures", rows}};
  write_file(arguments.text("--json"), result.dump(2) + "\n");
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_world", [&] {
    adasplats::run(
        {argc, argv, "bench_world [--splats-per-frame N] [--threads N] [--json FILE]", 0, 0});
  });
}
