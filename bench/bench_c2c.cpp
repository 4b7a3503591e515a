// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Distances between two clouds in both directions (C2C, completeness, Chamfer, F-scores): ours and
// nanoflann, in one run on the same points. nanoflann receives them in Hilbert order, which makes
// it several times faster, and its time excludes the sorting; ours receives them unsorted.
//   bench_c2c [--points N] [--input FILE|SEQUENCE] [--jitter M] [--threads N] [--repeats N]
//             [--json FILE]
// Compares an input with a jittered copy; without an input, two noisy samples of a procedural
// street.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/neighbors/hilbert.h"
#include "common.h"
#include "flann_tree.h"

namespace {

using namespace adasplats;

/// A street of 200 m: ground, two facades and tree crowns; points are denser near the road and have
/// a noise of 1 cm.
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

/// Mean distance from `from` to the nearest points of `to`, including the build of the tree.
double flann_mean_m(const std::vector<Vec3f>& from, const std::vector<Vec3f>& to,
                    const Executor& executor) {
  const bench::FlannCloud cloud{to};
  bench::FlannTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
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

void compare(const PointCloud& simulated, const PointCloud& original,
             const bench::Arguments& arguments, const Executor& executor) {
  const int repeats = std::max(1, arguments.number("--repeats", 3));
  std::printf("%zu against %zu points, %d threads\n", simulated.size(), original.size(),
              executor.threads());
  const std::vector<Vec3f> from = in_hilbert_order(simulated.positions, executor);
  const std::vector<Vec3f> to = in_hilbert_order(original.positions, executor);
  std::vector<double> ours_s, flann_s, ratios;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const Stopwatch ours;
    const CloudDistance d = cloud_distance(simulated, original, executor);
    ours_s.push_back(ours.seconds());
    const Stopwatch flann;
    const double flann_c2c_m = flann_mean_m(from, to, executor);
    const double flann_completeness_m = flann_mean_m(to, from, executor);
    flann_s.push_back(flann.seconds());
    ratios.push_back(flann_s.back() / ours_s.back());
    std::printf("ours %.2f s, nanoflann %.2f s; C2C %.17g %.9g m, completeness %.17g %.9g m\n",
                ours_s.back(), flann_s.back(), d.c2c_m, flann_c2c_m, d.completeness_m,
                flann_completeness_m);
  }
  std::printf("median of %d: ours %.2f s, nanoflann %.2f s, ratio %.2f\n", repeats,
              upper_median_of(ours_s), upper_median_of(flann_s), upper_median_of(ratios));
  if (!arguments.has("--json")) return;
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(executor.threads()))},
                                         {"simulated_points", simulated.size()},
                                         {"original_points", original.size()},
                                         {"ours_s", upper_median_of(ours_s)},
                                         {"nanoflann_s", upper_median_of(flann_s)},
                                         {"ratio", upper_median_of(ratios)}};
  write_file(arguments.text("--json"), result.dump(2) + "\n");
}

void run(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  if (!arguments.has("--input")) {
    const auto points = arguments.number<std::size_t>("--points", 10'000'000);
    compare(street(points, 0, executor), street(points, 1, executor), arguments, executor);
    return;
  }
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {arguments.text("--input")};
  const PointCloud cloud = load_cloud(inputs, {}, executor, quiet).first;
  compare(jittered(cloud, arguments.number("--jitter", 0.02), executor), cloud, arguments,
          executor);
}

}  // namespace

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_c2c", [&] {
    run({argc, argv,
         "bench_c2c [--points N] [--input FILE|SEQUENCE] [--jitter M] [--threads N] "
         "[--repeats N] [--json FILE]",
         0, 0});
  });
}
