// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// How well beams can be predicted without any model: each held-out beam takes the range of the
// measured beams whose ends are seen in (nearly) its direction from its scan's place, from scans
// nearby. What differs between such neighbours (leaves, edges, noise, poses, lasers) a model that
// is to give one answer a direction cannot know.
//   beam_floor TRAINING HELD_OUT [METRES]      SemanticKITTI sequence folders; 1.2 m without METRES
// Prints the accuracy of the nearest such beam and of the median of five, each the nearest in a
// fifth of the beams.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/neighbors/point_index.h"

namespace {

using namespace adasplats;

constexpr double kMinRange_m = 2.5, kMaxRange_m = 50;
constexpr std::uint16_t kFirstMoving = 252;  // SemanticKITTI
constexpr std::size_t kParts = 5;

struct NoProgress final : ProgressSink {};

struct Errors {
  std::vector<double> values_m;

  void print(const char* name) {
    std::vector<double> sizes_m;
    double early = 0, late = 0, within = 0, squares = 0;
    for (const double error_m : values_m) {
      sizes_m.push_back(std::fabs(error_m));
      early += error_m < -0.5 ? 1 : 0;
      late += error_m > 0.5 ? 1 : 0;
      within += std::fabs(error_m) <= 0.1 ? 1 : 0;
      squares += error_m * error_m;
    }
    const auto middle = sizes_m.begin() + static_cast<std::ptrdiff_t>(sizes_m.size() / 2);
    std::nth_element(sizes_m.begin(), middle, sizes_m.end());
    const double n = static_cast<double>(values_m.size());
    std::printf(
        "%-16s %9.0f beams  early %.2f %%  late %.2f %%  median %.2f cm  <10 cm %.1f %%  "
        "RMSE %.2f m\n",
        name, n, 100 * early / n, 100 * late / n, 100 * *middle, 100 * within / n,
        std::sqrt(squares / n));
  }
};

/// Beams' ends as seen from one place.
struct Seen {
  std::vector<Vec3f> directions;
  std::vector<float> ranges_m;
};

Seen seen_from(Vec3f place, const PointCloud& cloud, double reach_m) {
  Seen seen;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (static_cast<double>(length(cloud.sensor_positions[i] - place)) > reach_m) continue;
    const Vec3f along = cloud.positions[i] - place;
    const float range_m = length(along);
    if (range_m < 1) continue;
    seen.directions.push_back(along / range_m);
    seen.ranges_m.push_back(range_m);
  }
  return seen;
}

/// Ranges of the nearest beams in direction, one a query.
std::vector<float> nearest_ranges(const Seen& seen, const std::vector<Vec3f>& queries,
                                  const Executor& executor) {
  const PointIndex index(seen.directions, executor);
  std::vector<float> ranges_m;
  for (const Neighbor& neighbor : index.nearest(queries, executor))
    ranges_m.push_back(seen.ranges_m[neighbor.index]);
  return ranges_m;
}

void add_scan(const KittiSequence& sequence, std::size_t scan_index, const PointCloud& cloud,
              double reach_m, const Executor& executor, Errors& nearest, Errors& median) {
  RigidTransform pose = sequence.trajectory[scan_index].world_from_sensor;
  pose.translation = pose.translation - cloud.origin;
  const Vec3f place = vec_cast<float>(pose * Vec3d{0, 0, sequence.beams.from_hdl64 ? 0.165 : 0});
  const Seen seen = seen_from(place, cloud, reach_m);
  const KittiScan scan = read_kitti_scan(sequence, scan_index);
  std::vector<Vec3f> directions;
  std::vector<float> ranges_m;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3d point = vec_cast<double>(scan.positions[i]);
    if (!(length(point) >= kMinRange_m && length(point) <= kMaxRange_m)) continue;
    if (!scan.classes.empty() && scan.classes[i] >= kFirstMoving) continue;
    const Vec3f along = vec_cast<float>(pose * point) - place;
    ranges_m.push_back(length(along));
    directions.push_back(along / ranges_m.back());
  }
  if (seen.directions.size() < kParts) return;
  std::array<std::vector<float>, kParts> predicted_m;
  for (std::size_t part = 0; part < kParts; ++part) {
    Seen fifth;
    for (std::size_t i = part; i < seen.directions.size(); i += kParts) {
      fifth.directions.push_back(seen.directions[i]);
      fifth.ranges_m.push_back(seen.ranges_m[i]);
    }
    predicted_m[part] = nearest_ranges(fifth, directions, executor);
  }
  const std::vector<float> all_m = nearest_ranges(seen, directions, executor);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    nearest.values_m.push_back(static_cast<double>(all_m[i] - ranges_m[i]));
    std::array<float, kParts> five{};
    for (std::size_t part = 0; part < kParts; ++part) five[part] = predicted_m[part][i];
    std::sort(five.begin(), five.end());
    median.values_m.push_back(static_cast<double>(five[kParts / 2] - ranges_m[i]));
  }
}

void run(const std::filesystem::path& training, const std::filesystem::path& held_out,
         double reach_m) {
  const Executor executor;
  NoProgress progress;
  const PointCloud cloud = load_cloud(std::span(&training, 1), {}, executor, progress).first;
  KittiSequence sequence = open_kitti_sequence(held_out);
  sequence.beams = recognize_beams(sequence, executor);
  Errors nearest, median;
  for (std::size_t scan = 0; scan < sequence.scans.size(); ++scan)
    add_scan(sequence, scan, cloud, reach_m, executor, nearest, median);
  if (nearest.values_m.empty()) throw Error(ErrorKind::data, "no scans near the held-out ones");
  nearest.print("nearest beam");
  median.print("median of five");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: beam_floor TRAINING HELD_OUT [METRES]\n");
    return 2;
  }
  try {
    run(argv[1], argv[2], argc > 3 ? std::atof(argv[3]) : 1.2);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "beam_floor: %s\n", error.what());
    return 1;
  }
  return 0;
}
