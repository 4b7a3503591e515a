// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// The k nearest neighbours of every point of a cloud: PointIndex and nanoflann, in one run on the
// same points (in Hilbert order for both, which makes nanoflann several times faster).
//   bench_neighbors INPUT [K] [THREADS] [REPEATS] [RESULT.json]

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/neighbors/point_index.h"
#include "common.h"
#include "flann_tree.h"

namespace {

using namespace adasplats;

/// Build and search times, and the sum of the K-th distances, which must agree.
struct Measured {
  double build_s, search_s, kth_sum_m;
};

Measured run_ours(const std::vector<Vec3f>& points, std::uint32_t k, const Executor& executor) {
  const Stopwatch build;
  const PointIndex index = PointIndex::from_sorted(points, executor);
  const double build_s = build.seconds();
  const Stopwatch search;
  std::vector<float> kth(points.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{k}; },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        for (std::uint32_t i = 0; i < neighbors.size; ++i)
          kth[rank] = std::max(kth[rank], neighbors.squared_distances[i]);
      });
  const double search_s = search.seconds();
  double sum = 0;
  for (const float d : kth) sum += std::sqrt(static_cast<double>(d));
  return {build_s, search_s, sum};
}

Measured run_nanoflann(const std::vector<Vec3f>& points, std::uint32_t k,
                       const Executor& executor) {
  const Stopwatch build;
  const bench::FlannCloud cloud{points};
  bench::FlannTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree.buildIndex();
  const double build_s = build.seconds();
  const Stopwatch search;
  std::vector<float> kth(points.size());
  executor.for_chunks(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> indices(k);
    std::vector<float> distances(k);
    for (std::size_t i = begin; i < end; ++i) {
      const float query[3] = {points[i].x, points[i].y, points[i].z};
      const std::size_t found = tree.knnSearch(query, k, indices.data(), distances.data());
      kth[i] = distances[found - 1];
    }
  });
  const double search_s = search.seconds();
  double sum = 0;
  for (const float d : kth) sum += std::sqrt(static_cast<double>(d));
  return {build_s, search_s, sum};
}

void run(const bench::Arguments& arguments) {
  const auto k = arguments.input_number<std::uint32_t>(1, 40);
  const Executor executor(arguments.input_number(2, 0));
  const int repeats = arguments.input_number(3, 3);
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {arguments.input(0)};
  const PointCloud cloud = load_cloud(inputs, {}, executor, quiet).first;
  const Stopwatch sorting;
  std::vector<Vec3f> points;
  for (const std::uint32_t i : hilbert_order(cloud.positions, executor))
    points.push_back(cloud.positions[i]);
  std::printf("%zu points, K = %u, %d threads; Hilbert order %.2f s\n", points.size(), k,
              executor.threads(), sorting.seconds());
  std::vector<double> ours_s, flann_s, ratios;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const Measured ours = run_ours(points, k, executor);
    const Measured flann = run_nanoflann(points, k, executor);
    std::printf(
        "ours: build %.2f s, search %.2f s; nanoflann: build %.2f s, search %.2f s; "
        "sums of K-th distances %.6g %.6g m\n",
        ours.build_s, ours.search_s, flann.build_s, flann.search_s, ours.kth_sum_m,
        flann.kth_sum_m);
    ours_s.push_back(ours.build_s + ours.search_s);
    flann_s.push_back(flann.build_s + flann.search_s);
    ratios.push_back(flann_s.back() / ours_s.back());
  }
  std::printf("median of %d: ours %.2f s, nanoflann %.2f s, ratio %.2f\n", repeats,
              upper_median_of(ours_s), upper_median_of(flann_s), upper_median_of(ratios));
  if (!arguments.input(4).empty()) {
    const nlohmann::ordered_json result = {
        {"provenance", to_json(provenance_of(executor.threads()))},
        {"points", points.size()},
        {"neighbors", k},
        {"ours_s", upper_median_of(ours_s)},
        {"nanoflann_s", upper_median_of(flann_s)},
        {"ratio", upper_median_of(ratios)}};
    write_file(arguments.input(4), result.dump(2) + "\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_neighbors", [&] {
    run({argc, argv, "bench_neighbors INPUT [K] [THREADS] [REPEATS] [RESULT.json]", 1, 5});
  });
}
