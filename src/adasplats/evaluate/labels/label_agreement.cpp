// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/labels/label_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats {
namespace {

/// Points around a scan: world axes, with the position of the scan as origin.
struct LabelledPoints {
  std::vector<Vec3f> positions;
  std::vector<std::uint16_t> classes;
};

bool moves(const LabelScheme& labels, std::uint16_t id) {
  const SemanticClass* const found = labels.find(id);
  return found != nullptr && found->mobility == Mobility::moving;
}

void append_scan(const KittiSequence& sequence, std::size_t index, Vec3d origin, bool with_moving,
                 const LabelScheme& labels, LabelledPoints& points) {
  const KittiScan scan = read_kitti_scan(sequence, index);
  RigidTransform pose = sequence.trajectory[index].world_from_sensor;
  pose.translation = pose.translation - origin;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (!is_finite(scan.positions[i])) continue;
    if (!with_moving && moves(labels, scan.classes[i])) continue;
    points.positions.push_back(vec_cast<float>(pose * vec_cast<double>(scan.positions[i])));
    points.classes.push_back(scan.classes[i]);
  }
}

std::size_t nearest_time(const Trajectory& trajectory, double time_s) {
  const auto distance = [&](const TimedPose& pose) { return std::fabs(pose.time_s - time_s); };
  return static_cast<std::size_t>(std::ranges::min_element(trajectory, {}, distance) -
                                  trajectory.begin());
}

void count(LabelAgreement& agreement, bool same, double distance_m) {
  ++agreement.points;
  agreement.agree += same ? 1 : 0;
  agreement.distance_m += distance_m;  // a sum until finish()
}

void finish(LabelAgreement& agreement) {
  agreement.distance_m = agreement.points > 0
                             ? agreement.distance_m / static_cast<double>(agreement.points)
                             : std::numeric_limits<double>::quiet_NaN();
}

void count_scan(const LabelledPoints& simulated, const LabelledPoints& original,
                std::span<const Neighbor> nearest, LabelAgreementResult& result) {
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].index == Neighbor::kNone) continue;
    const std::uint16_t has = simulated.classes[i];
    const std::uint16_t expected = original.classes[nearest[i].index];
    const double distance_m = std::sqrt(static_cast<double>(nearest[i].squared_distance));
    count(result.all, has == expected, distance_m);
    if (has != 0 && expected != 0) count(result.labelled, has == expected, distance_m);
    count(result.by_class[has], has == expected, distance_m);
    if (has != expected) ++result.confusions[{has, expected}];
  }
}

void check(const KittiSequence& sequence) {
  if (sequence.scans.empty())
    throw Error(ErrorKind::data, sequence.folder.string() + ": has no scans");
  if (sequence.labels.empty())
    throw Error(ErrorKind::data, sequence.folder.string() + ": has no labels");
}

}  // namespace

double LabelAgreement::share() const {
  if (points == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(agree) / static_cast<double>(points);
}

LabelAgreementResult compare_labels(const KittiSequence& simulated, const KittiSequence& original,
                                    const LabelScheme& labels, const LabelAgreementOptions& options,
                                    const Executor& executor, ProgressSink& progress) {
  check(simulated);
  check(original);
  if (options.every == 0) throw Error(ErrorKind::usage, "`every` must be at least 1");
  LabelAgreementResult result;
  progress.begin_step("compare labels", simulated.scans.size());
  for (std::size_t i = 0; i < simulated.scans.size(); i += options.every) {
    const TimedPose& pose = simulated.trajectory[i];
    const Vec3d origin = pose.world_from_sensor.translation;
    const std::size_t middle = nearest_time(original.trajectory, pose.time_s);
    LabelledPoints points, around;
    append_scan(simulated, i, origin, true, labels, points);
    const std::size_t first = middle > options.window ? middle - options.window : 0;
    const std::size_t last = std::min(middle + options.window, original.scans.size() - 1);
    for (std::size_t k = first; k <= last; ++k)
      append_scan(original, k, origin, k == middle, labels, around);
    const PointIndex index(around.positions, executor);
    count_scan(points, around, index.nearest(points.positions, executor), result);
    progress.advance(i + 1);
  }
  progress.end_step();
  finish(result.all);
  finish(result.labelled);
  for (auto& [id, agreement] : result.by_class) finish(agreement);
  return result;
}

}  // namespace adasplats
