// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Distances between two clouds, both directions (C2C, completeness, Chamfer, F-scores): ours beside
// nanoflann, in one run on the same points. nanoflann gets them in Hilbert order and is not charged
// for the sorting, which favours it several times over; ours gets them as they come.
//   bench_c2c [--points N] [--input FILE|SEQUENCE] [--jitter M] [--threads N] [--repeats N]
//             [--json FILE]
// Without an input two noisy samples of a made-up street; with one, the input and a jittered copy.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nanoflann.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/neighbors/hilbert.h"

namespace {

using namespace adasplats;
using Clock = std::chrono::steady_clock;

struct Arguments {
  std::size_t points = 10'000'000;
  std::string input;
  double jitter_m = 0.02;
  int threads = 0;
  int repeats = 3;
  std::string json;
};

struct FlannCloud {
  const std::vector<Vec3f>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using FlannTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, FlannCloud>, FlannCloud,
                                        3, std::uint32_t>;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A street of 200 m: ground, two facades, and crowns of trees that fill space; points are denser
/// where a scanner passes near, and 1 cm off their surface.
PointCloud street(std::size_t count, std::uint64_t stream, const Executor& executor) {
  PointCloud cloud;
  cloud.positions.resize(count);
  executor.for_chunks(count, 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Random random(11, stream, i);
      const double kind = random.uniform();
      const double along_m = random.uniform(0, 200);
      const double noise_m = 0.01 * random.normal();
      const double u = random.uniform(-1, 1);
      Vec3d p;
      if (kind < 0.5) {
        p = {along_m, 10 * u * std::fabs(u), noise_m};
      } else if (kind < 0.85) {
        p = {along_m, (u < 0 ? -10 : 10) + noise_m, 12 * u * u};
      } else {
        const double tree_m = 10 * std::floor(along_m / 10);
        p = {tree_m + random.normal(), (u < 0 ? -7 : 7) + random.normal(), 5 + random.normal()};
      }
      cloud.positions[i] = vec_cast<float>(p);
    }
  });
  return cloud;
}

PointCloud jittered(PointCloud cloud, double sigma_m, const Executor& executor) {
  executor.for_chunks(cloud.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Random random(11, 2, i);
      const Vec3d offset = {random.normal(), random.normal(), random.normal()};
      cloud.positions[i] = cloud.positions[i] + vec_cast<float>(sigma_m * offset);
    }
  });
  return cloud;
}

std::vector<Vec3f> in_hilbert_order(const std::vector<Vec3f>& points, const Executor& executor) {
  std::vector<Vec3f> sorted;
  sorted.reserve(points.size());
  for (const std::uint32_t i : hilbert_order(points, executor)) sorted.push_back(points[i]);
  return sorted;
}

/// Mean distance of `from` to the nearest of `to`, tree and all.
double flann_mean_m(const std::vector<Vec3f>& from, const std::vector<Vec3f>& to,
                    const Executor& executor) {
  const FlannCloud cloud{to};
  FlannTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree.buildIndex();
  const double sum_m =
      executor.sum_chunks(from.size(), 1 << 14, 0.0, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const float query[3] = {from[i].x, from[i].y, from[i].z};
          std::uint32_t index = 0;
          float distance2 = 0;
          tree.knnSearch(query, 1, &index, &distance2);
          sum += std::sqrt(static_cast<double>(distance2));
        }
        return sum;
      });
  return sum_m / static_cast<double>(from.size());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void compare(const PointCloud& simulated, const PointCloud& original, const Arguments& arguments,
             const Executor& executor) {
  const int repeats = arguments.repeats;
  std::printf("%zu against %zu points, %d threads\n", simulated.size(), original.size(),
              executor.threads());
  const std::vector<Vec3f> from = in_hilbert_order(simulated.positions, executor);
  const std::vector<Vec3f> to = in_hilbert_order(original.positions, executor);
  std::vector<double> ours_s, flann_s, ratios;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    auto start = Clock::now();
    const CloudDistance d = cloud_distance(simulated, original, executor);
    ours_s.push_back(seconds_since(start));
    start = Clock::now();
    const double flann_c2c_m = flann_mean_m(from, to, executor);
    const double flann_completeness_m = flann_mean_m(to, from, executor);
    flann_s.push_back(seconds_since(start));
    ratios.push_back(flann_s.back() / ours_s.back());
    std::printf("ours %.2f s, nanoflann %.2f s; C2C %.17g %.9g m, completeness %.17g %.9g m\n",
                ours_s.back(), flann_s.back(), d.c2c_m, flann_c2c_m, d.completeness_m,
                flann_completeness_m);
  }
  std::printf("median of %d: ours %.2f s, nanoflann %.2f s, ratio %.2f\n", repeats, median(ours_s),
              median(flann_s), median(ratios));
  if (arguments.json.empty()) return;
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(executor.threads()))},
                                         {"simulated_points", simulated.size()},
                                         {"original_points", original.size()},
                                         {"ours_s", median(ours_s)},
                                         {"nanoflann_s", median(flann_s)},
                                         {"ratio", median(ratios)}};
  write_file(arguments.json, result.dump(2) + "\n");
}

std::optional<Arguments> parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 >= argc) return std::nullopt;
    const std::string value = argv[i + 1];
    if (name == "--points") {
      arguments.points = std::stoull(value);
    } else if (name == "--input") {
      arguments.input = value;
    } else if (name == "--jitter") {
      arguments.jitter_m = std::stod(value);
    } else if (name == "--threads") {
      arguments.threads = std::stoi(value);
    } else if (name == "--repeats") {
      arguments.repeats = std::max(1, std::stoi(value));
    } else if (name == "--json") {
      arguments.json = value;
    } else {
      return std::nullopt;
    }
  }
  return arguments;
}

void run(const Arguments& arguments) {
  const Executor executor(arguments.threads);
  if (arguments.input.empty()) {
    compare(street(arguments.points, 0, executor), street(arguments.points, 1, executor), arguments,
            executor);
    return;
  }
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {arguments.input};
  const PointCloud cloud = load_cloud(inputs, {}, executor, quiet).first;
  compare(jittered(cloud, arguments.jitter_m, executor), cloud, arguments, executor);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::optional<Arguments> arguments = parse(argc, argv);
    if (arguments) {
      run(*arguments);
      return 0;
    }
  } catch (const adasplats::Error& error) {
    std::fprintf(stderr, "bench_c2c: error: %s\n", error.what());
    return adasplats::exit_code(error.kind());
  } catch (const std::logic_error&) {  // of std::stod and the like
  }
  std::fprintf(stderr,
               "usage: bench_c2c [--points N] [--input FILE|SEQUENCE] [--jitter M] [--threads N] "
               "[--repeats N] [--json FILE]\n");
  return 64;
}
