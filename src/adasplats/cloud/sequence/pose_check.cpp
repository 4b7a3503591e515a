// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/pose_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/poses/pose_jump.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"

namespace adasplats {

namespace {

constexpr std::size_t kPairs = 4;
constexpr double kMinApart_m = 3, kMaxApart_m = 15;
constexpr double kSourceReach_m = 20;                            // of the points that are moved
constexpr double kTargetReach_m = kSourceReach_m + kMaxApart_m;  // where they can come to
constexpr double kColumn_m = 1, kUpright_m = 1;
// Beams of 2 degrees are 0.7 m apart at 20 m: finer cells would show the pattern of the beams.
constexpr double kVoxel_m = 0.5;
constexpr std::size_t kMaxPairPoints = 1000, kMinPairPoints = 200;  // of a pair

constexpr std::size_t kWithoutMotion = 1;

// LiDAR axes (x forward, y left, z up) to camera axes (x right, y down, z forward).
constexpr RigidTransform kCameraFromLidar = {{{{0, -1, 0}, {0, 0, -1}, {1, 0, 0}}}, {}};

constexpr std::array<std::string_view, PoseEvidence::kWays> kWayNames = {
    "with the poses as given", "without any motion (are the points in world coordinates already?)",
    "with the poses taken as the camera's (is the 'Tr:' of calib.txt missing or the identity?)",
    "with the poses taken as the LiDAR's (is the 'Tr:' of calib.txt one too many?)",
    "with the poses inverted (are they sensor_from_world?)"};

// Metres from millimetres, centimetres, decimetres and feet, and back.
constexpr double kFoot_m = 0.3048;
constexpr std::array kFactors = {0.001, 0.01, 0.1, kFoot_m, 1 / kFoot_m, 10.0, 100.0, 1000.0};

// On sequences 00, 01, 02, 03 and 05 of SemanticKITTI the true motion has shares of 0.95 and more
// and the best other way at most 0.66 of the given one's; where poses are wrong in one of these
// ways, the best other way is the true one and has at least 1.36 of the given one's.
constexpr double kMinShare = 0.8, kMinGain = 1.2;

/// A cube of cells around a point.
class Grid {
 public:
  Grid(Vec3d middle, double reach_m, double cell_m)
      : low_(middle - Vec3d{reach_m, reach_m, reach_m}),
        cell_m_(cell_m),
        size_(static_cast<std::size_t>(std::ceil(2 * reach_m / cell_m))) {}

  std::size_t size() const { return size_; }
  /// The number of the cell along one axis; nothing outside.
  std::optional<std::size_t> along(int axis, Vec3d p) const {
    const double cell = std::floor((p[axis] - low_[axis]) / cell_m_);
    if (!(cell >= 0 && cell < static_cast<double>(size_))) return std::nullopt;
    return static_cast<std::size_t>(cell);
  }

 private:
  Vec3d low_;
  double cell_m_;
  std::size_t size_;
};

/// The finite points of a scan that are near its middle.
struct NearPoints {
  Vec3d middle;  ///< componentwise median: not the frame's origin where that is far away
  std::vector<Vec3d> points;
};

NearPoints near_points(const KittiScan& scan, double reach_m) {
  NearPoints near;
  for (const Vec3f p : scan.positions)
    if (is_finite(p)) near.points.push_back(vec_cast<double>(p));
  if (near.points.empty()) return near;
  std::vector<double> values(near.points.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = near.points[i][axis];
    near.middle[axis] = upper_median_of(values);
  }
  std::erase_if(near.points, [&](Vec3d p) { return !(length(p - near.middle) < reach_m); });
  return near;
}

/// Points of columns that something fills upright; at most kMaxPairPoints, evenly taken.
std::vector<Vec3d> upright_points(const NearPoints& near) {
  const Grid columns(near.middle, kSourceReach_m, kColumn_m);
  struct Heights {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
  };
  std::vector<Heights> heights(columns.size() * columns.size());
  const auto heights_at = [&](Vec3d p) -> Heights& {
    return heights[columns.along(0, p).value_or(0) * columns.size() +
                   columns.along(1, p).value_or(0)];
  };
  for (const Vec3d p : near.points) {
    Heights& column = heights_at(p);
    column.low = std::min(column.low, p.z);
    column.high = std::max(column.high, p.z);
  }
  std::vector<Vec3d> upright;
  for (const Vec3d p : near.points)
    if (heights_at(p).high - heights_at(p).low >= kUpright_m) upright.push_back(p);
  if (upright.size() <= kMaxPairPoints) return upright;
  std::vector<Vec3d> taken;
  for (std::size_t k = 0; k < kMaxPairPoints; ++k)
    taken.push_back(upright[k * upright.size() / kMaxPairPoints]);
  return taken;
}

/// Which cells of space a scan has points in.
class Occupied {
 public:
  explicit Occupied(const NearPoints& near)
      : grid_(near.middle, kTargetReach_m + kVoxel_m, kVoxel_m),
        cells_(grid_.size() * grid_.size() * grid_.size()) {
    for (const Vec3d p : near.points)
      if (const auto cell = cell_of(p)) cells_[*cell] = true;
  }

  /// Whether a point has others within about half a cell.
  bool meets(Vec3d p) const {
    for (int corner = 0; corner < 8; ++corner) {
      const auto side = [corner](int axis) {
        return (corner >> axis & 1) != 0 ? 0.5 * kVoxel_m : -0.5 * kVoxel_m;
      };
      const auto cell = cell_of(p + Vec3d{side(0), side(1), side(2)});
      if (cell && cells_[*cell]) return true;
    }
    return false;
  }

 private:
  std::optional<std::size_t> cell_of(Vec3d p) const {
    const auto x = grid_.along(0, p), y = grid_.along(1, p), z = grid_.along(2, p);
    if (!x || !y || !z) return std::nullopt;
    return (*x * grid_.size() + *y) * grid_.size() + *z;
  }

  Grid grid_;
  std::vector<bool> cells_;
};

/// Where each way has the later scan's points in the earlier scan's frame.
std::array<RigidTransform, PoseEvidence::kWays> motions(const RigidTransform& earlier,
                                                        const RigidTransform& later) {
  const RigidTransform& c = kCameraFromLidar;
  const RigidTransform given = earlier.inverse() * later;
  return {given, RigidTransform{}, c.inverse() * given * c, c * given * c.inverse(),
          earlier * later.inverse()};
}

/// An earlier scan of a sequence and a later one.
using ScanNumbers = std::pair<std::size_t, std::size_t>;

/// Two scans: the upright points of the later one, and where the earlier one has points.
class ScanPair {
 public:
  /// Nothing where a scan cannot be read or the later one has too few upright points.
  static std::optional<ScanPair> read(const KittiSequence& sequence, ScanNumbers scans,
                                      const Executor& executor) {
    const std::array numbers = {scans.second, scans.first};
    constexpr std::array kReach_m = {kSourceReach_m, kTargetReach_m};
    std::array<std::optional<NearPoints>, 2> near;
    std::vector<Vec3d> moved;
    executor.for_chunks(near.size(), 1, [&](std::size_t k, std::size_t) {
      const auto scan = try_kitti_points(sequence, numbers[k]);
      if (scan) near[k] = near_points(*scan, kReach_m[k]);
      if (k == 0 && near[k]) moved = upright_points(*near[k]);
    });
    if (!near[0] || !near[1] || moved.size() < kMinPairPoints) return std::nullopt;
    return ScanPair(near[0]->middle, std::move(moved), *near[1]);
  }

  std::size_t points() const { return moved_.size(); }
  double middles_apart_m() const { return middles_apart_m_; }
  /// How many of the later scan's points meet the earlier scan after a motion.
  std::size_t met(const RigidTransform& motion) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(moved_, [&](Vec3d p) { return occupied_.meets(motion * p); }));
  }

 private:
  ScanPair(Vec3d middle, std::vector<Vec3d> moved, const NearPoints& target)
      : middles_apart_m_(length(middle - target.middle)),
        moved_(std::move(moved)),
        occupied_(target) {}

  double middles_apart_m_;
  std::vector<Vec3d> moved_;
  Occupied occupied_;
};

/// What one pair says of the poses.
PoseEvidence pose_evidence(const KittiSequence& sequence, ScanNumbers scans,
                           const Executor& executor) {
  PoseEvidence evidence;
  const auto pair = ScanPair::read(sequence, scans, executor);
  if (!pair) return evidence;
  const auto ways = motions(sequence.trajectory[scans.first].world_from_sensor,
                            sequence.trajectory[scans.second].world_from_sensor);
  // Traffic at one's own speed does not move either; points of a sensor that moves are always
  // around their frame's origin, those in world coordinates come along.
  const bool frame_stands = pair->middles_apart_m() >= 0.5 * length(ways[0].translation);
  evidence.pairs = 1;
  evidence.points = pair->points();
  for (std::size_t way = 0; way < ways.size(); ++way)
    if (way != kWithoutMotion || frame_stands) evidence.met[way] = pair->met(ways[way]);
  evidence.met_turned = pair->met({ways[0].rotation, {}});
  return evidence;
}

/// What one pair says of a factor.
ScaleEvidence scale_evidence(const KittiSequence& sequence, ScanNumbers scans, double factor,
                             const Executor& executor) {
  ScaleEvidence evidence;
  const auto pair = ScanPair::read(sequence, scans, executor);
  if (!pair) return evidence;
  const RigidTransform given = sequence.trajectory[scans.first].world_from_sensor.inverse() *
                               sequence.trajectory[scans.second].world_from_sensor;
  evidence.pairs = 1;
  evidence.points = pair->points();
  evidence.met = pair->met({given.rotation, factor * given.translation});
  evidence.met_given = pair->met(given);
  evidence.met_turned = pair->met({given.rotation, {}});
  return evidence;
}

/// Up to kPairs pairs of scans that are kMinApart_m to kMaxApart_m apart, were the translations
/// of the poses `factor` times what they are.
std::vector<ScanNumbers> pairs_of(const Trajectory& trajectory, double factor) {
  std::vector<ScanNumbers> pairs;
  const auto place = [&](std::size_t i) { return trajectory[i].world_from_sensor.translation; };
  for (std::size_t k = 0; k < kPairs; ++k) {
    const std::size_t earlier = k * trajectory.size() / kPairs;
    if (!pairs.empty() && pairs.back().first == earlier) continue;
    for (std::size_t later = earlier + 1; later < trajectory.size(); ++later) {
      const double apart_m = factor * length(place(later) - place(earlier));
      if (!(apart_m >= kMinApart_m)) continue;
      if (apart_m <= kMaxApart_m) pairs.emplace_back(earlier, later);
      break;
    }
  }
  return pairs;
}

std::string percent_text(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

std::string factor_text(double factor) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", factor);
  return text.data();
}

[[noreturn]] void throw_contradiction(const KittiSequence& sequence, std::size_t points,
                                      std::size_t pairs, std::size_t given, std::size_t other,
                                      const std::string& way) {
  const auto share = [&](std::size_t met) {
    return percent_text(static_cast<double>(met) / static_cast<double>(points));
  };
  throw Error(ErrorKind::data,
              sequence.folder.string() + ": the poses and the points contradict each other: of " +
                  std::to_string(points) + " points on upright things in " + std::to_string(pairs) +
                  " pairs of scans " + share(given) + " meet the other scan " +
                  std::string(kWayNames.front()) + ", " + share(other) + " " + way);
}

/// By how much the number in a scan's name exceeds that of the scan before; 1 without numbers.
std::vector<double> number_steps(const KittiSequence& sequence) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < sequence.scans.size(); ++k) {
    const auto before = number_in_name(sequence.scans[k - 1]);
    const auto number = number_in_name(sequence.scans[k]);
    const bool counts = before && number && *number > *before && *number - *before < 1'000'000;
    steps.push_back(counts ? static_cast<double>(*number - *before) : 1.0);
  }
  return steps;
}

/// The median time per number in the names of the scans.
double median_step_s(const Trajectory& poses, const std::vector<double>& number_steps) {
  std::vector<double> steps_s;
  for (std::size_t k = 1; k < poses.size(); ++k)
    steps_s.push_back((poses[k].time_s - poses[k - 1].time_s) / number_steps[k - 1]);
  return upper_median_of(steps_s);
}

/// Throws data where times and ways between the scans are those of no vehicle, unless they are in
/// other units than seconds and metres. A scan counts once for each number that its name is ahead.
void require_times_of_scans(const KittiSequence& sequence) {
  constexpr double kLongStep_s = 20, kShortStep_s = 0.002;  // milliseconds of 50 Hz are 20
  constexpr double kSlow_mps = 0.5, kFast_mps = 150, kMinDriven_m = 3;
  const Trajectory& poses = sequence.trajectory;
  if (poses.size() < 2) return;
  double driven_m = 0;
  for (std::size_t k = 1; k < poses.size(); ++k)
    driven_m +=
        length(poses[k].world_from_sensor.translation - poses[k - 1].world_from_sensor.translation);
  const double step_s = median_step_s(poses, number_steps(sequence));
  const double speed_mps = driven_m / (poses.back().time_s - poses.front().time_s);
  const bool is_long = step_s > kLongStep_s && speed_mps < kSlow_mps && driven_m > kMinDriven_m;
  const bool is_short = step_s < kShortStep_s && speed_mps > kFast_mps;
  if (!is_long && !is_short) return;
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(),
                ": the times of the scans are not seconds: by them scans are %.4g s apart, and the "
                "vehicle drives %.1f m at %.3g m/s",
                step_s, driven_m, speed_mps);
  throw Error(ErrorKind::data, sequence.folder.string() + text.data());
}

/// A way in which axes of poses are commonly confused.
struct WrongAxes {
  const char* how;  ///< for throw_contradiction()
  Mat3d right_from_given;
  bool turns_rotations;  ///< else only the translations are wrong
};

/// Mirrors and exchanged axes. Mirrored rotations are M R M, which are rotations again.
constexpr std::array kWrongAxes = {
    WrongAxes{"with the y of their translations negated (is their y axis to the right?)",
              {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}},
              false},
    WrongAxes{
        "with the x of their translations negated", {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, false},
    WrongAxes{"with x and y of their translations exchanged (are they north and east?)",
              {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}},
              false},
    WrongAxes{"with y and yaw negated (are they in a left-handed system?)",
              {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}},
              true}};

/// Throws data if the scans align clearly better with other axes of the poses than as given, and
/// as well as in any way of weigh_poses().
void require_axes(const KittiSequence& given, const PoseEvidence& as_given,
                  const Executor& executor) {
  for (const WrongAxes& axes : kWrongAxes) {
    KittiSequence other = given;
    const Mat3d& m = axes.right_from_given;
    for (TimedPose& pose : other.trajectory) {
      RigidTransform& at = pose.world_from_sensor;
      at.translation = m * at.translation;
      if (axes.turns_rotations) at.rotation = m * at.rotation * m;
    }
    const PoseEvidence evidence = weigh_poses(other, executor);
    if (evidence.confirms() && evidence.share(0) >= kMinGain * as_given.share(0) &&
        evidence.share(0) >= as_given.share(as_given.best_other()))
      throw_contradiction(given, as_given.points, as_given.pairs, as_given.met[0],
                          static_cast<std::size_t>(std::lround(
                              evidence.share(0) * static_cast<double>(as_given.points))),
                          axes.how);
  }
}

/// Looks for signs that the sensor moved although its poses stand still. Throws data if no two
/// distant scans align: a vehicle that passes a standing sensor hides the rest only in some of
/// them. Returns a text if the signs are weaker; empty if the sensor may have stood.
std::string standing_text(const KittiSequence& sequence, double reach_m, const Executor& executor) {
  constexpr double kMinOfNeighbours = 0.8, kMaxOfEnds = 0.75, kNone = 0.5;
  const std::size_t last = sequence.trajectory.size() - 1;
  const auto evidence_of = [&](ScanNumbers scans) {
    return pose_evidence(sequence, scans, executor);
  };
  const auto mean = [](std::span<const PoseEvidence> pairs) {
    PoseEvidence sum;
    for (const PoseEvidence& pair : pairs) {
      sum.points += pair.points;
      sum.met[0] += pair.met[0];
    }
    return sum.share(0);
  };
  const std::array near = {evidence_of({0, 1}), evidence_of({last - 1, last})};
  const std::array distant = {evidence_of({0, last}), evidence_of({last / 2, last}),
                              evidence_of({0, last / 2}), evidence_of({last / 4, 3 * last / 4})};
  const double neighbours = mean(near), ends = mean(std::span(distant).first(2));
  double best = 0;
  for (const PoseEvidence& pair : distant) best = std::max(best, pair.share(0));
  const bool has_moved = ends < kNone || (ends < kMaxOfEnds && neighbours > kMinOfNeighbours);
  if (ends == 0 || !has_moved) return {};  // 0: too few upright objects
  const bool is_sure = best < kNone && neighbours >= kMinGain * best;
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(),
                "the poses span only %.2f m, but the sensor%s moved: of points on upright objects "
                "%.0f %% align between neighbouring scans, at most %.0f %% between distant ones; "
                "check that these are the poses of the scans, in metres",
                reach_m, is_sure ? "" : " seems to have", 100 * neighbours, 100 * best);
  if (is_sure) throw Error(ErrorKind::data, sequence.folder.string() + ": " + text.data());
  return text.data();
}

/// In one line: why the unit of the poses was not checked.
std::string unchecked_text(const KittiSequence& sequence, const PoseEvidence& evidence,
                           const Executor& executor) {
  double reach_m = 0;
  for (const TimedPose& pose : sequence.trajectory)
    reach_m = std::max(reach_m, length(pose.world_from_sensor.translation -
                                       sequence.trajectory.front().world_from_sensor.translation));
  constexpr std::size_t kMinScans = 4;  // for neighbours and ends
  if (reach_m < kMinApart_m && sequence.trajectory.size() >= kMinScans) {
    std::string moved = standing_text(sequence, reach_m, executor);
    if (!moved.empty()) return moved;
  }
  if (sequence.trajectory.size() < 2 || reach_m == 0) return {};
  std::array<char, 300> text{};
  if (reach_m < kMinApart_m)
    std::snprintf(text.data(), text.size(),
                  "cannot check that the poses are in metres and of the sensor: they span only "
                  "%.2f m, and scans at least %.0f m apart are needed",
                  reach_m, kMinApart_m);
  else if (evidence.points == 0)
    std::snprintf(text.data(), text.size(),
                  "cannot check that the poses are in metres and of the sensor: no scans 3 to 15 m "
                  "apart contain upright objects");
  else
    std::snprintf(
        text.data(), text.size(),
        "cannot check that the poses are in metres and of the sensor: of %zu points on upright "
        "objects %.0f %% align with another scan by the poses, %.0f %% by their rotations alone",
        evidence.points, 100 * evidence.share(0),
        100 * static_cast<double>(evidence.met_turned) / static_cast<double>(evidence.points));
  return text.data();
}

}  // namespace

double PoseEvidence::share(std::size_t way) const {
  return points == 0 ? 0 : static_cast<double>(met.at(way)) / static_cast<double>(points);
}

std::size_t PoseEvidence::best_other() const {
  return static_cast<std::size_t>(std::max_element(met.begin() + 1, met.end()) - met.begin());
}

bool PoseEvidence::contradicts() const {
  const double other = share(best_other());
  return other >= kMinShare && other >= kMinGain * share(0);
}

bool PoseEvidence::confirms() const {
  // Other ways than the given one say nothing against it: one of them may be the same.
  return share(0) >= kMinShare &&
         static_cast<double>(met[0]) >= kMinGain * static_cast<double>(met_turned);
}

bool ScaleEvidence::contradicts() const {
  // Without the gain on no translation at all, traffic at one's own speed would speak for factors
  // below 1, and a tunnel for all.
  const auto other = static_cast<double>(std::max(met_given, met_turned));
  return points != 0 && static_cast<double>(met) >= kMinShare * static_cast<double>(points) &&
         static_cast<double>(met) >= kMinGain * other;
}

std::vector<ScanNumbers> scan_pairs(const Trajectory& trajectory) {
  return pairs_of(trajectory, 1);
}

PoseEvidence weigh_poses(const KittiSequence& sequence, const Executor& executor) {
  const std::vector<ScanNumbers> pairs = pairs_of(sequence.trajectory, 1);
  std::vector<PoseEvidence> of_pairs(pairs.size());
  executor.for_chunks(pairs.size(), 1, [&](std::size_t k, std::size_t) {
    of_pairs[k] = pose_evidence(sequence, pairs[k], executor);
  });
  PoseEvidence all;
  for (const PoseEvidence& part : of_pairs) {
    all.pairs += part.pairs;
    all.points += part.points;
    for (std::size_t way = 0; way < all.met.size(); ++way) all.met[way] += part.met[way];
    all.met_turned += part.met_turned;
  }
  return all;
}

std::vector<ScaleEvidence> weigh_scales(const KittiSequence& sequence, const Executor& executor) {
  std::vector<ScaleEvidence> scales;
  for (const double factor : kFactors) {
    const std::vector<ScanNumbers> pairs = pairs_of(sequence.trajectory, factor);
    std::vector<ScaleEvidence> of_pairs(pairs.size());
    executor.for_chunks(pairs.size(), 1, [&](std::size_t k, std::size_t) {
      of_pairs[k] = scale_evidence(sequence, pairs[k], factor, executor);
    });
    ScaleEvidence all;
    all.factor = factor;
    for (const ScaleEvidence& part : of_pairs) {
      all.pairs += part.pairs;
      all.points += part.points;
      all.met += part.met;
      all.met_given += part.met_given;
      all.met_turned += part.met_turned;
    }
    if (all.pairs != 0) scales.push_back(all);
  }
  return scales;
}

void require_no_jump(const KittiSequence& sequence) {
  const Trajectory& poses = sequence.trajectory;
  if (poses.size() < 2) return;
  // Placeholder times do not show dropped scans, but the numbers of the names do.
  std::vector<double> steps_s = number_steps(sequence);
  const double step_s = median_step_s(poses, steps_s);
  for (std::size_t k = 1; k < poses.size(); ++k)
    steps_s[k - 1] = std::max(poses[k].time_s - poses[k - 1].time_s, step_s * steps_s[k - 1]);
  const auto jump = find_pose_jump(poses, sequence.has_times, steps_s);
  if (!jump) return;
  throw Error(ErrorKind::data,
              sequence.folder.string() + ": between the scans " +
                  sequence.scans[jump->later - 1].filename().string() + " and " +
                  sequence.scans[jump->later].filename().string() + " the poses jump by " +
                  jump->text() +
                  "; check that each scan has its own pose (same order, none missing or of another "
                  "drive) and that the times are seconds");
}

std::string verify_poses(const KittiSequence& sequence, const Executor& executor) {
  require_times_of_scans(sequence);
  require_no_jump(sequence);
  const PoseEvidence evidence = weigh_poses(sequence, executor);
  if (evidence.points != 0 && !evidence.confirms()) require_axes(sequence, evidence, executor);
  if (evidence.contradicts()) {
    const std::size_t other = evidence.best_other();
    throw_contradiction(sequence, evidence.points, evidence.pairs, evidence.met[0],
                        evidence.met.at(other), std::string(kWayNames.at(other)));
  }
  if (evidence.confirms()) return {};
  for (const ScaleEvidence& scale : weigh_scales(sequence, executor)) {
    if (scale.contradicts())
      throw_contradiction(
          sequence, scale.points, scale.pairs, scale.met_given, scale.met,
          "with their translations times " + factor_text(scale.factor) + " (are they in metres?)");
  }
  return unchecked_text(sequence, evidence, executor);
}

}  // namespace adasplats
