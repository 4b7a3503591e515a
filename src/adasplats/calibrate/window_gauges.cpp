// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/window_gauges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "adasplats/calibrate/chain_system.h"
#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/calibrate/trajectory_fit.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

/// A rotation is measured by the displacement it causes at this distance, as in best_smoothing().
constexpr double kArmOfSettling_m = 10;
constexpr int kSettlingIterations = 5;  // of the weights and of the slightly non-linear motions
constexpr double kWidthOfOverlaps = 3;  // in medians: difference with a quarter of the weight
constexpr double kMinApart_m = 1e-4;    // float precision of the points limits the agreement

using MotionBlock = ChainSystem::Block;
using MotionColumn = ChainSystem::Column;
constexpr std::size_t kMotionUnknowns = ChainSystem::kUnknowns;

/// Adds the weighted product of the transposed of `a` with `b`.
void add_product(MotionBlock& sum, double weight, const MotionBlock& a, const MotionBlock& b) {
  for (std::size_t r = 0; r < kMotionUnknowns; ++r)
    for (std::size_t c = 0; c < kMotionUnknowns; ++c)
      for (std::size_t k = 0; k < kMotionUnknowns; ++k) sum[r][c] += weight * a[k][r] * b[k][c];
}

void add_product(MotionColumn& sum, double weight, const MotionBlock& a, const MotionColumn& b) {
  for (std::size_t r = 0; r < kMotionUnknowns; ++r)
    for (std::size_t k = 0; k < kMotionUnknowns; ++k) sum[r] += weight * a[k][r] * b[k];
}

/// Derivative of a pose correction by the motion of its window about `middle`; rotations and shifts
/// are multiplied by these weights.
MotionBlock by_motion(const PoseCorrection& pose, Vec3d middle, double rotation, double shift) {
  const Vec3d arm = pose.position + pose.shift_m - middle;
  MotionBlock block{};
  for (std::size_t k = 0; k < 3; ++k) {
    block[k][k] = rotation;
    block[3 + k][3 + k] = shift;
  }
  block[3][1] = shift * arm.z;
  block[3][2] = -shift * arm.y;
  block[4][0] = -shift * arm.z;
  block[4][2] = shift * arm.x;
  block[5][0] = shift * arm.y;
  block[5][1] = -shift * arm.x;
  return block;
}

MotionColumn motion_column(Vec3d rotation, Vec3d shift) {
  return {rotation.x, rotation.y, rotation.z, shift.x, shift.y, shift.z};
}

/// Scans that a window shares with the one before it.
struct Overlap {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end > begin ? end - begin : 0; }
};

Overlap overlap_of(const WindowPoses& before, const WindowPoses& window) {
  if (before.poses.empty() || window.poses.empty()) return {};
  return {window.begin, std::min(before.end(), window.end())};
}

/// Weight of a window in its overlap with the previous one, rising from 0 to 1.
double faded_in(const Overlap& overlap, std::size_t scan) {
  if (overlap.size() == 0 || scan >= overlap.end) return 1;
  const double share =
      (static_cast<double>(scan - overlap.begin) + 0.5) / static_cast<double>(overlap.size());
  const double sine = std::sin(0.5 * std::numbers::pi * share);
  return sine * sine;
}

double square_of(Vec3d v) { return dot(v, v); }

/// All windows of a drive as one system.
class Settling {
 public:
  Settling(std::span<WindowPoses> windows, const GivenPoseTrust& trust)
      : windows_(windows), trust_(trust), middles_(windows.size()) {}

  void run() {
    for (int iteration = 0; iteration < kSettlingIterations; ++iteration) {
      ChainSystem system(windows_.size());
      for (std::size_t k = 0; k < windows_.size(); ++k) {
        middles_[k] = middle_of(windows_[k]);
        add_given(system, k);
        if (k > 0) add_overlap(system, k);
      }
      move(system.solve());
    }
  }

 private:
  static Vec3d middle_of(const WindowPoses& window) {
    Vec3d sum;
    for (const PoseCorrection& pose : window.poses) sum = sum + (pose.position + pose.shift_m);
    return window.poses.empty() ? sum : sum / static_cast<double>(window.poses.size());
  }

  void add_given(ChainSystem& system, std::size_t k) const {
    MotionBlock matrix{};
    MotionColumn right{};
    const double rotation = 1 / trust_.rotation_sigma_rad, shift = 1 / trust_.translation_sigma_m;
    for (const PoseCorrection& pose : windows_[k].poses) {
      const MotionBlock block = by_motion(pose, middles_[k], rotation, shift);
      add_product(matrix, 1, block, block);
      add_product(right, -1, block,
                  motion_column(rotation * pose.rotation_rad, shift * pose.shift_m));
    }
    if (windows_[k].poses.empty())
      for (std::size_t r = 0; r < kMotionUnknowns; ++r) matrix[r][r] = 1;  // nothing to move
    system.add(k, k, matrix);
    system.add(k, right);
  }

  double disagreement_m(std::size_t k, std::size_t scan) const {
    const PoseCorrection& a = pose_of(k - 1, scan);
    const PoseCorrection& b = pose_of(k, scan);
    return std::sqrt(kArmOfSettling_m * kArmOfSettling_m *
                         square_of(b.rotation_rad - a.rotation_rad) +
                     square_of(b.shift_m - a.shift_m));
  }

  /// The overlap counts as one measurement with the variance of its disagreement: the disagreement
  /// is smooth along the drive, so more scans do not make it more precise. The middle has the
  /// largest weight because poses at the ends of a window are the least certain.
  void add_overlap(ChainSystem& system, std::size_t k) const {
    const Overlap overlap = overlap_of(windows_[k - 1], windows_[k]);
    if (overlap.size() == 0) return;
    std::vector<double> weights;
    const double variance = weigh(k, overlap, weights);
    MotionBlock matrix{}, before{}, coupling{};
    MotionColumn right{}, right_before{};
    for (std::size_t scan = overlap.begin; scan < overlap.end; ++scan) {
      const PoseCorrection& a = pose_of(k - 1, scan);
      const PoseCorrection& b = pose_of(k, scan);
      const double weight = weights[scan - overlap.begin] / variance;
      const MotionBlock by_a = by_motion(a, middles_[k - 1], kArmOfSettling_m, 1);
      const MotionBlock by_b = by_motion(b, middles_[k], kArmOfSettling_m, 1);
      const MotionColumn difference = motion_column(
          kArmOfSettling_m * (b.rotation_rad - a.rotation_rad), b.shift_m - a.shift_m);
      add_product(matrix, weight, by_b, by_b);
      add_product(before, weight, by_a, by_a);
      add_product(coupling, -weight, by_b, by_a);
      add_product(right, -weight, by_b, difference);
      add_product(right_before, weight, by_a, difference);
    }
    system.add(k, k, matrix);
    system.add(k - 1, k - 1, before);
    system.add(k, k - 1, coupling);
    system.add(k, right);
    system.add(k - 1, right_before);
  }

  /// Fills the weights of the overlap's scans (sum 1) and returns the variance of one component of
  /// their disagreement, m^2.
  double weigh(std::size_t k, const Overlap& overlap, std::vector<double>& weights) const {
    std::vector<double> apart_m;
    for (std::size_t scan = overlap.begin; scan < overlap.end; ++scan)
      apart_m.push_back(disagreement_m(k, scan));
    std::vector<double> sorted = apart_m;
    std::ranges::sort(sorted);
    const double median_m = std::max(kMinApart_m, sorted[sorted.size() / 2]);
    double total = 0, sum = 0;
    for (std::size_t scan = overlap.begin; scan < overlap.end; ++scan) {
      const double in = faded_in(overlap, scan);
      const double apart = apart_m[scan - overlap.begin];
      const double weight = in * (1 - in) * robust_weight(apart, kWidthOfOverlaps * median_m);
      weights.push_back(weight);
      total += weight;
      sum += weight * apart * apart;
    }
    for (double& weight : weights) weight /= total;
    return std::max(kMinApart_m * kMinApart_m, sum / total / kMotionUnknowns);
  }

  const PoseCorrection& pose_of(std::size_t k, std::size_t scan) const {
    return windows_[k].poses[scan - windows_[k].begin];
  }

  void move(const std::vector<double>& x) {
    for (std::size_t k = 0; k < windows_.size(); ++k) {
      const double* step = x.data() + k * kMotionUnknowns;
      const RigidTransform motion =
          moved_about(middles_[k], {step[0], step[1], step[2]}, {step[3], step[4], step[5]});
      for (PoseCorrection& pose : windows_[k].poses) pose = moved(pose, motion);
    }
  }

  std::span<WindowPoses> windows_;
  const GivenPoseTrust& trust_;
  std::vector<Vec3d> middles_;
};

double median_apart(std::vector<double> values) {
  return values.empty() ? 0 : upper_median_of(values);
}

/// Interpolates corrections for scans without one.
void fill_gaps(std::vector<PoseCorrection>& poses, const std::vector<bool>& known) {
  std::optional<std::size_t> before;
  for (std::size_t scan = 0; scan < poses.size(); ++scan) {
    if (known[scan]) {
      before = scan;
      continue;
    }
    std::size_t behind = scan;
    while (behind < poses.size() && !known[behind]) ++behind;
    const PoseCorrection& b = behind < poses.size() ? poses[behind] : poses[*before];
    const PoseCorrection& a = before ? poses[*before] : b;
    const double apart_s = b.time_s - a.time_s;
    const double share = apart_s > 0 ? (poses[scan].time_s - a.time_s) / apart_s : 0;
    poses[scan].rotation_rad = a.rotation_rad + share * (b.rotation_rad - a.rotation_rad);
    poses[scan].shift_m = a.shift_m + share * (b.shift_m - a.shift_m);
  }
}

}  // namespace

PoseDisagreement disagreement_of(std::span<const PoseCorrection> a,
                                 std::span<const PoseCorrection> b) {
  PoseDisagreement result;
  std::vector<double> shifts_m, turns_rad;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    shifts_m.push_back(length(b[k].shift_m - a[k].shift_m));
    turns_rad.push_back(length(b[k].rotation_rad - a[k].rotation_rad));
    result.largest_shift_m = std::max(result.largest_shift_m, shifts_m.back());
    result.largest_rotation_rad = std::max(result.largest_rotation_rad, turns_rad.back());
  }
  result.scans = shifts_m.size();
  result.median_shift_m = median_apart(std::move(shifts_m));
  result.median_rotation_rad = median_apart(std::move(turns_rad));
  return result;
}

std::vector<PoseDisagreement> settle_windows(std::span<WindowPoses> windows,
                                             const GivenPoseTrust& trust) {
  Settling(windows, trust).run();
  std::vector<PoseDisagreement> result(windows.size());
  for (std::size_t k = 1; k < windows.size(); ++k) {
    const Overlap overlap = overlap_of(windows[k - 1], windows[k]);
    if (overlap.size() == 0) continue;
    const std::span before = windows[k - 1].poses, window = windows[k].poses;
    result[k] = disagreement_of(before.subspan(overlap.begin - windows[k - 1].begin),
                                window.first(overlap.size()));
  }
  return result;
}

std::vector<PoseCorrection> blended(std::span<const WindowPoses> windows, const Trajectory& given) {
  std::vector<PoseCorrection> poses;
  for (const TimedPose& pose : given)
    poses.push_back({pose.time_s, pose.world_from_sensor.translation, {}, {}});
  std::vector<bool> known(given.size());
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const Overlap before = k > 0 ? overlap_of(windows[k - 1], windows[k]) : Overlap{};
    const Overlap behind =
        k + 1 < windows.size() ? overlap_of(windows[k], windows[k + 1]) : Overlap{};
    for (std::size_t scan = windows[k].begin; scan < windows[k].end(); ++scan) {
      const double out = behind.size() > 0 && scan >= behind.begin ? faded_in(behind, scan) : 0;
      const double weight = faded_in(before, scan) - out;
      const PoseCorrection& own = windows[k].poses[scan - windows[k].begin];
      poses[scan].rotation_rad = poses[scan].rotation_rad + weight * own.rotation_rad;
      poses[scan].shift_m = poses[scan].shift_m + weight * own.shift_m;
      known[scan] = true;
    }
  }
  if (std::ranges::find(known, true) == known.end()) return {};
  fill_gaps(poses, known);
  return poses;
}

void align_to_given(std::vector<PoseCorrection>& poses) {
  const RigidTransform back = onto_given(poses);
  for (PoseCorrection& pose : poses) pose = moved(pose, back);
}

}  // namespace adasplats
