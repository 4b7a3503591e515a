// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// What objects of other scans cost: hits of moving splats added to HDL-64 scans in worlds of few
// and of many frames, with the same number of splats a frame, in turn in one run.
//   bench_world [--splats-per-frame N] [--threads N] [--json FILE]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

namespace {

constexpr std::size_t kFewFrames = 16;
constexpr std::size_t kManyFrames = 1000;
constexpr int kRounds = 150;
constexpr float kSplatRadius_m = 0.14F;  // paper section "SimKITTI32"

struct Options {
  std::size_t splats_per_frame = 5000;
  int threads = 0;
  std::string json;
};

/// Ten cars around the sensor, as boxes of random splats.
SplatModel traffic(std::size_t splats, std::uint64_t frame) {
  constexpr std::size_t kCars = 10;
  SplatModel model;
  for (std::size_t i = 0; i < splats; ++i) {
    const std::size_t car = i % kCars;
    Random place(1, frame, car);
    const double range_m = place.uniform(5, 45),
                 azimuth_rad = place.uniform(0, 2 * std::numbers::pi);
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
  const auto place = static_cast<double>(frame);
  return {0.1 * place, {rotation_from_yaw_pitch_roll(0.01 * place, 0, 0), {place, 0, 0}}};
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
  std::vector<double> seconds = {};  ///< a scan
  std::size_t hits = 0;

  double median_s() const {
    std::vector<double> sorted = seconds;
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
  }
};

/// The scans of a round are spread over all frames; each world takes its turn.
void measure(std::vector<Figure>& figures, const Executor& executor) {
  using Clock = std::chrono::steady_clock;
  const LidarModel sensor = hdl_64_paper();
  const std::vector<Firing> firings = firings_of(sensor);
  std::vector<Hit> hits(firings.size());
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (Figure& figure : figures) {
      constexpr std::size_t kStride = 61;
      const std::size_t frame = round * kStride % figure.frames;
      const ScanMotion motion = {pose_of(frame), {}};
      std::ranges::fill(hits, Hit{});
      const Clock::time_point start = Clock::now();
      figure.world.add_hits(frame, sensor, firings, motion, 0.1, 1, hits, executor);
      figure.seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
      figure.hits += static_cast<std::size_t>(std::ranges::count_if(hits, &Hit::valid));
    }
  }
}

void run(const Options& options) {
  const Executor executor(options.threads);
  std::vector<Figure> figures;
  for (const std::size_t frames : {kFewFrames, kManyFrames})
    figures.push_back({frames, world_of(frames, options.splats_per_frame)});
  measure(figures, executor);
  const double ratio = figures[1].median_s() / figures[0].median_s();
  std::printf("%zu splats a frame, %d threads\n", options.splats_per_frame, executor.threads());
  nlohmann::json rows = nlohmann::json::array();
  for (const Figure& figure : figures) {
    const std::size_t hits_per_scan = figure.hits / figure.seconds.size();
    std::printf("%5zu frames  %7.3f ms a scan   %zu hits\n", figure.frames, 1e3 * figure.median_s(),
                hits_per_scan);
    rows.push_back({{"frames", figure.frames},
                    {"seconds_per_scan", figure.median_s()},
                    {"hits_per_scan", hits_per_scan}});
  }
  std::printf("many frames cost %.3f of few\n", ratio);
  if (options.json.empty()) return;
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(executor.threads()))},
                                         {"splats_per_frame", options.splats_per_frame},
                                         {"threads", executor.threads()},
                                         {"few_frames_s", figures[0].median_s()},
                                         {"many_frames_s", figures[1].median_s()},
                                         {"ratio", ratio},
                                         {"figures", rows}};
  write_file(options.json, result.dump(2) + "\n");
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (i + 1 >= argc) throw std::runtime_error(word + " is unknown or needs a value");
    const std::string value = argv[++i];
    if (word == "--json") {
      options.json = value;
    } else if (word == "--splats-per-frame") {
      options.splats_per_frame = std::stoul(value);
    } else if (word == "--threads") {
      options.threads = std::stoi(value);
    } else {
      throw std::runtime_error("unknown option " + word);
    }
  }
  return options;
}

}  // namespace

}  // namespace adasplats

int main(int argc, char** argv) {
  try {
    adasplats::run(adasplats::parse(argc, argv));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_world: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
