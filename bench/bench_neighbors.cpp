// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// k nearest neighbours of every point of a cloud: PointIndex beside nanoflann, in one run on the
// same points (in Hilbert order for both, which favours nanoflann several times over).
//   bench_neighbors INPUT [K] [THREADS] [REPEATS] [RESULT.json]

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <nanoflann.hpp>
#include <nlohmann/json.hpp>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/neighbors/point_index.h"

namespace {

using namespace adasplats;
using Clock = std::chrono::steady_clock;

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

/// Build and search time, and the sum of K-th distances as proof that both found the same.
struct Measured {
  double build_s, search_s, kth_sum_m;
};

Measured run_ours(const std::vector<Vec3f>& points, std::uint32_t k, const Executor& executor) {
  auto start = Clock::now();
  const PointIndex index = PointIndex::from_sorted(points, executor);
  const double build_s = seconds_since(start);
  start = Clock::now();
  std::vector<float> kth(points.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{k}; },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        for (std::uint32_t i = 0; i < neighbors.size; ++i)
          kth[rank] = std::max(kth[rank], neighbors.squared_distances[i]);
      });
  const double search_s = seconds_since(start);
  double sum = 0;
  for (const float d : kth) sum += std::sqrt(static_cast<double>(d));
  return {build_s, search_s, sum};
}

Measured run_nanoflann(const std::vector<Vec3f>& points, std::uint32_t k,
                       const Executor& executor) {
  auto start = Clock::now();
  const FlannCloud cloud{points};
  FlannTree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree.buildIndex();
  const double build_s = seconds_since(start);
  start = Clock::now();
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
  const double search_s = seconds_since(start);
  double sum = 0;
  for (const float d : kth) sum += std::sqrt(static_cast<double>(d));
  return {build_s, search_s, sum};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

int run(int argc, char** argv) {
  const Executor executor(argc > 3 ? std::atoi(argv[3]) : 0);
  const std::uint32_t k = argc > 2 ? static_cast<std::uint32_t>(std::atoi(argv[2])) : 40;
  const int repeats = argc > 4 ? std::atoi(argv[4]) : 3;
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {argv[1]};
  const PointCloud cloud = load_cloud(inputs, {}, executor, quiet).first;
  auto start = Clock::now();
  std::vector<Vec3f> points;
  for (const std::uint32_t i : hilbert_order(cloud.positions, executor))
    points.push_back(cloud.positions[i]);
  std::printf("%zu points, K = %u, %d threads; Hilbert order %.2f s\n", points.size(), k,
              executor.threads(), seconds_since(start));
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
  std::printf("median of %d: ours %.2f s, nanoflann %.2f s, ratio %.2f\n", repeats, median(ours_s),
              median(flann_s), median(ratios));
  if (argc > 5) {
    const nlohmann::ordered_json result = {
        {"provenance", to_json(provenance_of(executor.threads()))},
        {"points", points.size()},
        {"neighbors", k},
        {"ours_s", median(ours_s)},
        {"nanoflann_s", median(flann_s)},
        {"ratio", median(ratios)}};
    write_file(argv[5], result.dump(2) + "\n");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_neighbors INPUT [K] [THREADS] [REPEATS] [RESULT.json]\n");
    return 64;
  }
  try {
    return run(argc, argv);
  } catch (const adasplats::Error& error) {
    std::fprintf(stderr, "bench_neighbors: error: %s\n", error.what());
    return adasplats::exit_code(error.kind());
  }
}
