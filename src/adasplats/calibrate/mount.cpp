// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/mount.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/calibrate/scan_planes.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"

namespace adasplats {
namespace {

/// Rotation times MountOptions::range_m, then shift; all in metres.
using Row = std::array<double, 6>;
using Square = std::array<double, 36>;

constexpr std::size_t kBlocks = 16;      // parts of the drive; their disagreement gives the errors
constexpr std::size_t kMountParts = 16;  // partial sums over the planes, added in a fixed order
constexpr double kSystematic_m = 0.01;   // disagreement between scans that no mount removes
constexpr double kWholeDrive = std::numeric_limits<double>::infinity();

double product_of(const Row& a, const Row& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

double form_of(const Row& a, const Square& m, const Row& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k) sum += a[i] * m[i * 6 + k] * b[k];
  return sum;
}

void add_outer(Square& sum, const Row& a, double factor) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k) sum[i * 6 + k] += factor * a[i] * a[k];
}

/// Normal equations of the mount, linearised at the current one.
struct MountSums {
  Square full{};                     ///< with fixed planes
  Square reduced{};                  ///< with the planes eliminated
  std::array<Row, kBlocks> right{};  ///< right-hand side, one for each part of the drive

  MountSums& operator+=(const MountSums& other) {
    for (std::size_t k = 0; k < 36; ++k) {
      full[k] += other.full[k];
      reduced[k] += other.reduced[k];
    }
    for (std::size_t block = 0; block < kBlocks; ++block)
      for (std::size_t k = 0; k < 6; ++k) right[block][k] += other.right[block][k];
    return *this;
  }
};

/// Distance of a point from its plane, and its derivatives by the mount and by the plane.
struct MountResidual {
  double residual_m = 0, weight = 0;
  std::size_t block = 0;
  Row by_mount{};
  std::array<double, 3> by_plane{};
};

/// Adds a plane; its offset and tilts are eliminated.
void add_plane(const std::vector<MountResidual>& residuals, MountSums& sums) {
  std::array<double, 9> own{};
  std::array<std::array<double, 3>, 7> coupling{};  // to the mount's unknowns and to the residual
  for (const MountResidual& r : residuals) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double weighted = r.weight * r.by_plane[a];
      for (std::size_t b = 0; b < 3; ++b) own[a * 3 + b] += weighted * r.by_plane[b];
      for (std::size_t k = 0; k < 6; ++k) coupling[k][a] += weighted * r.by_mount[k];
      coupling[6][a] += weighted * r.residual_m;
    }
  }
  for (std::size_t a = 0; a < 3; ++a) own[a * 4] += 1e-9;
  factor<3>(own);
  for (std::array<double, 3>& column : coupling) column = solved<3>(own, column);
  const auto of_plane = [&](const MountResidual& r, std::size_t k) {
    return r.by_plane[0] * coupling[k][0] + r.by_plane[1] * coupling[k][1] +
           r.by_plane[2] * coupling[k][2];
  };
  for (const MountResidual& r : residuals) {
    Row left = r.by_mount;
    for (std::size_t k = 0; k < 6; ++k) left[k] -= of_plane(r, k);
    const double left_m = r.residual_m - of_plane(r, 6);
    add_outer(sums.full, r.by_mount, r.weight);
    add_outer(sums.reduced, left, r.weight);
    for (std::size_t k = 0; k < 6; ++k) sums.right[r.block][k] -= r.weight * left[k] * left_m;
  }
}

struct MountRound {
  double reach_m = kWholeDrive;  ///< length of a window
  double cell_m = 3.2, flatness_m = 0, width_m = 0;
  double damping = 0;  ///< share of the full weight that damps a step
};

class MountSearch {
 public:
  MountSearch(const MountPoints& points, std::span<const TimedPose> poses,
              const MountOptions& options, const Executor& executor)
      : points_(points), poses_(poses), options_(options), executor_(executor) {
    if (poses.empty()) return;
    const Vec3d origin = poses.front().world_from_sensor.translation;
    for (const TimedPose& pose : poses) {
      local_.push_back(pose.world_from_sensor);
      local_.back().translation = pose.world_from_sensor.translation - origin;
    }
  }

  void start(const MountEstimate& estimate) {
    mount_ = estimate.mount;
    for (const MountDirection& direction : estimate.not_observed)
      left_out_.push_back({direction.turning.x, direction.turning.y, direction.turning.z,
                           direction.shifting.x, direction.shifting.y, direction.shifting.z});
  }

  /// Searches the planes again and makes two steps.
  void make_round(const MountRound& round) {
    place_points();
    const ScanPlanes planes = planes_of(round);
    plane_count_ = planes.planes.size();
    for (int step = 0; step < 2; ++step) {
      if (step > 0) place_points();
      sums_ = sums_of(planes, round.width_m);
      make_step(round.damping);
    }
  }

  /// Excludes the directions that the planes of the last round do not observe. Returns whether
  /// there are new ones.
  bool exclude_unobserved() {
    const SmallEigen<6> eigen = small_eigen<6>(information(0));
    const Square scatter = scatter_of_right();
    std::vector<Row> unobserved;
    for (std::size_t k = 0; k < 6; ++k) {
      const Row& direction = eigen.vectors[k];
      if (!is_kept(direction)) continue;
      const double weight = std::max(eigen.values[k], 0.0);
      const double share = weight / std::max(form_of(direction, sums_.full, direction), 1e-12);
      const double sd_m = std::sqrt(form_of(direction, scatter, direction)) / weight;
      if (share >= options_.min_share && sd_m <= options_.max_sd_m) continue;
      unobserved.push_back(direction);
    }
    left_out_.insert(left_out_.end(), unobserved.begin(), unobserved.end());
    set_unknowns(unknowns());
    return !unobserved.empty();
  }

  MountEstimate estimate() const {
    MountEstimate result;
    result.mount = mount_;
    result.planes = plane_count_;
    const SmallEigen<6> eigen = small_eigen<6>(information(0));
    const Square scatter = scatter_of_right();
    Square inverse{};
    for (std::size_t k = 0; k < 6; ++k)
      if (eigen.values[k] > 0 && is_kept(eigen.vectors[k]))
        add_outer(inverse, eigen.vectors[k], 1 / eigen.values[k]);
    const auto sd_along = [&](const Row& direction) {
      Row solved{};
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t k = 0; k < 6; ++k) solved[i] += inverse[i * 6 + k] * direction[k];
      return std::sqrt(form_of(solved, scatter, solved));
    };
    for (std::size_t k = 0; k < 6; ++k) {
      Row axis{};
      axis[k] = 1;
      if (k < 3)
        result.rotation_sd_rad[static_cast<int>(k)] = sd_along(axis) / options_.range_m;
      else
        result.shift_sd_m[static_cast<int>(k - 3)] = sd_along(axis);
    }
    for (const Row& direction : eigen.vectors)
      if (is_kept(direction))
        result.deviations = std::max(
            result.deviations, std::fabs(product_of(direction, unknowns())) / sd_along(direction));
    result.not_observed = named_directions();
    return result;
  }

 private:
  Row unknowns() const {
    const Vec3d turn = options_.range_m * mount_.rotation_rad;
    const Vec3d shift = mount_.shift_m;
    return {turn.x, turn.y, turn.z, shift.x, shift.y, shift.z};
  }

  /// Sets the mount; excluded directions stay zero.
  void set_unknowns(const Row& values) {
    const Row x = kept(values);
    mount_.rotation_rad = (1 / options_.range_m) * Vec3d{x[0], x[1], x[2]};
    mount_.shift_m = {x[3], x[4], x[5]};
  }

  Row kept(Row row) const {
    for (const Row& out : left_out_) {
      const double along = product_of(out, row);
      for (std::size_t k = 0; k < 6; ++k) row[k] -= along * out[k];
    }
    return row;
  }

  /// The projection from both sides.
  Square kept(const Square& square) const {
    Square rows{};
    for (std::size_t i = 0; i < 6; ++i) {
      Row row{};
      std::copy_n(square.begin() + static_cast<std::ptrdiff_t>(i * 6), 6, row.begin());
      row = kept(row);
      for (std::size_t k = 0; k < 6; ++k) rows[k * 6 + i] = row[k];
    }
    Square both{};
    for (std::size_t i = 0; i < 6; ++i) {
      Row row{};
      std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(i * 6), 6, row.begin());
      row = kept(row);
      std::ranges::copy(row, both.begin() + static_cast<std::ptrdiff_t>(i * 6));
    }
    return both;
  }

  bool is_kept(const Row& direction) const {
    return std::ranges::none_of(
        left_out_, [&](const Row& out) { return std::fabs(product_of(out, direction)) > 0.5; });
  }

  /// Sum of the squared right-hand sides of the parts of the drive. Their disagreement includes the
  /// pose errors, which all points of a scan share. (Sandwich estimator of clustered residuals:
  /// Liang and Zeger, "Longitudinal data analysis using generalized linear models", Biometrika
  /// 1986.)
  Square scatter_of_right() const {
    Square scatter{};
    for (const Row& right : sums_.right) add_outer(scatter, right, 1);
    const double spare = static_cast<double>(kBlocks) - 6;
    for (double& value : scatter) value *= static_cast<double>(kBlocks) / spare;
    return scatter;
  }

  void place_points() {
    const RigidTransform given_from_mounted = mount_.given_from_mounted();
    std::vector<RigidTransform> mounted;
    for (const RigidTransform& pose : local_) mounted.push_back(pose * given_from_mounted);
    placed_.resize(points_.in_sensor.size());
    executor_.for_chunks(placed_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        placed_[k] = mounted[points_.scans[k]] * points_.in_sensor[k];
    });
  }

  /// Maximum displacement between the points of two scans per radian of mount error, m.
  double reach_between(std::size_t a, std::size_t b) const {
    return length(local_[a].translation - local_[b].translation) +
           (options_.range_m + options_.arm_of_error_m) *
               angle_between(local_[a].rotation, local_[b].rotation);
  }

  /// First point of every window, then the number of points. A window has at least two scans.
  std::vector<std::size_t> windows_of(double reach_m) const {
    std::vector<std::size_t> begins = {0};
    std::size_t first = points_.scans.empty() ? 0 : points_.scans.front();
    std::size_t scan = first, scans = 1;
    for (std::size_t k = 0; k < points_.scans.size(); ++k) {
      if (points_.scans[k] == scan) continue;
      scan = points_.scans[k];
      ++scans;
      if (scans <= 2 || reach_between(first, scan) <= reach_m) continue;
      begins.push_back(k);
      first = scan;
      scans = 1;
    }
    begins.push_back(points_.scans.size());
    return begins;
  }

  ScanPlanes planes_of(const MountRound& round) const {
    ScanPlaneOptions options;
    options.largest_cell_m = round.cell_m;
    options.flatness_m = round.flatness_m;
    if (round.reach_m == kWholeDrive)
      return find_scan_planes(placed_, points_.scans, options, executor_);
    const std::vector<std::size_t> begins = windows_of(round.reach_m);
    std::vector<ScanPlanes> parts(begins.size() - 1);
    executor_.for_chunks(parts.size(), 1, [&](std::size_t window, std::size_t) {
      const std::size_t begin = begins[window], count = begins[window + 1] - begin;
      parts[window] =
          find_scan_planes(std::span(placed_).subspan(begin, count),
                           std::span(points_.scans).subspan(begin, count), options, executor_);
    });
    ScanPlanes all;
    for (std::size_t window = 0; window < parts.size(); ++window) {
      const auto shift = static_cast<std::uint32_t>(all.points.size());
      for (const std::uint32_t k : parts[window].points)
        all.points.push_back(static_cast<std::uint32_t>(begins[window] + k));
      for (ScanPlane plane : parts[window].planes) {
        plane.begin += shift;
        plane.end += shift;
        all.planes.push_back(plane);
      }
    }
    return all;
  }

  MountResidual residual_of(std::size_t k, const ScanPlane& plane) const {
    MountResidual row;
    const std::size_t scan = points_.scans[k];
    row.block = scan * kBlocks / local_.size();
    const Vec3d from_center = placed_[k] - plane.center;
    row.residual_m = dot(plane.normal, from_center);
    row.by_plane = {1, dot(plane.axes[0], from_center), dot(plane.axes[1], from_center)};
    const RigidTransform given_from_local = local_[scan].inverse();
    const Vec3d normal = given_from_local.rotation * plane.normal;
    const Vec3d turning = (1 / options_.range_m) * cross(given_from_local * placed_[k], normal);
    row.by_mount = {turning.x, turning.y, turning.z, normal.x, normal.y, normal.z};
    return row;
  }

  MountSums sums_of(const ScanPlanes& planes, double width_m) const {
    const std::size_t count = planes.planes.size();
    const std::size_t grain = std::max<std::size_t>(1, (count + kMountParts - 1) / kMountParts);
    return executor_.sum_chunks(count, grain, MountSums{}, [&](std::size_t begin, std::size_t end) {
      MountSums sums;
      std::vector<MountResidual> residuals;
      for (std::size_t plane = begin; plane < end; ++plane) {
        residuals_of(planes, planes.planes[plane], width_m, residuals);
        add_plane(residuals, sums);
      }
      return sums;
    });
  }

  void residuals_of(const ScanPlanes& planes, const ScanPlane& plane, double width_m,
                    std::vector<MountResidual>& residuals) const {
    residuals.clear();
    const auto members = planes.points_of(plane);
    const std::size_t stride = (members.size() + options_.max_points - 1) / options_.max_points;
    double total = 0;
    for (std::size_t k = 0; k < members.size(); k += stride) {
      residuals.push_back(residual_of(members[k], plane));
      residuals.back().weight = robust_weight(residuals.back().residual_m, width_m);
      total += residuals.back().weight;
    }
    const double scale = total > options_.max_weight ? options_.max_weight / total : 1;
    for (MountResidual& residual : residuals) residual.weight *= scale;
  }

  /// Information matrix of the mount; excluded directions are fixed by a large weight.
  Square information(double damping) const {
    Square matrix = sums_.reduced;
    double trace = 1e-9;
    for (std::size_t k = 0; k < 6; ++k) trace += sums_.full[k * 7];
    for (std::size_t k = 0; k < 36; ++k) matrix[k] += damping * sums_.full[k];
    matrix = kept(matrix);
    for (const Row& out : left_out_) add_outer(matrix, out, trace);
    for (std::size_t k = 0; k < 6; ++k) matrix[k * 7] += 1e-9 * trace;
    return matrix;
  }

  /// Gauss-Newton step, applied from the left: given_from_mounted becomes
  /// step * given_from_mounted.
  void make_step(double damping) {
    Square matrix = information(damping);
    Row right{};
    for (const Row& of_block : sums_.right)
      for (std::size_t k = 0; k < 6; ++k) right[k] += of_block[k];
    factor<6>(matrix);
    const Row x = kept(solved<6>(matrix, kept(right)));
    const Mat3d turn = rotation_by((1 / options_.range_m) * Vec3d{x[0], x[1], x[2]});
    mount_.rotation_rad = rotation_vector(turn * rotation_by(mount_.rotation_rad));
    mount_.shift_m = turn * mount_.shift_m + Vec3d{x[3], x[4], x[5]};
    set_unknowns(unknowns());
  }

  /// Excluded directions, as close to the axes as their span allows.
  std::vector<MountDirection> named_directions() const {
    constexpr std::array<const char*, 6> kNames = {"roll (about x)",    "pitch (about y)",
                                                   "yaw (about z)",     "lever arm along x",
                                                   "lever arm along y", "lever arm along z"};
    Square span{};
    for (const Row& out : left_out_) add_outer(span, out, 1);
    std::vector<MountDirection> result;
    for (std::size_t n = 0; n < left_out_.size(); ++n) {
      std::size_t largest = 0;
      for (std::size_t k = 1; k < 6; ++k)
        if (span[k * 7] > span[largest * 7]) largest = k;
      const double size = std::sqrt(std::max(span[largest * 7], 1e-12));
      Row u{};
      for (std::size_t k = 0; k < 6; ++k) u[k] = span[largest * 6 + k] / size;
      result.push_back({kNames[largest], {u[0], u[1], u[2]}, {u[3], u[4], u[5]}});
      add_outer(span, u, -1);
    }
    return result;
  }

  const MountPoints& points_;
  std::span<const TimedPose> poses_;
  const MountOptions& options_;
  const Executor& executor_;
  std::vector<RigidTransform> local_;  ///< given poses relative to the position of the first
  MountCorrection mount_;
  std::vector<Row> left_out_;  ///< orthonormal
  std::vector<Vec3d> placed_;  ///< points with the current mount
  MountSums sums_;             ///< before the last step
  std::size_t plane_count_ = 0;
};

}  // namespace

MountEstimate search_mount(const MountPoints& points, std::span<const TimedPose> poses,
                           const MountOptions& options, const Executor& executor) {
  MountSearch search(points, poses, options, executor);
  MountRound round;
  round.flatness_m = options.first_flatness_m;
  round.width_m = options.first_width_m;
  // Scans see the same surfaces over a few tens of metres; longer windows add nothing.
  constexpr double kWideEnough_m = 150;
  double error_rad = options.first_error_rad;
  for (; options.capture_m / error_rad < kWideEnough_m; error_rad *= 0.5) {
    round.reach_m = options.capture_m / error_rad;
    round.damping = std::pow(kSystematic_m / (error_rad * options.range_m), 2);
    search.make_round(round);
  }
  round.reach_m = kWholeDrive;
  search.make_round(round);
  search.make_round(round);
  while (search.exclude_unobserved()) search.make_round(round);
  return search.estimate();
}

MountEstimate refine_mount(const MountPoints& points, std::span<const TimedPose> poses,
                           const MountEstimate& start, const MountOptions& options,
                           const Executor& executor) {
  MountSearch search(points, poses, options, executor);
  search.start(start);
  MountRound round;
  round.cell_m = ScanPlaneOptions{}.largest_cell_m;
  const int last = options.refining_rounds - 1;
  for (int k = 0; k <= last; ++k) {
    const auto between = [&](double a, double b) {
      return last > 0 ? a * std::pow(b / a, static_cast<double>(k) / last) : b;
    };
    round.flatness_m = between(options.first_flatness_m, options.last_flatness_m);
    round.width_m = between(options.first_width_m, options.last_width_m);
    search.make_round(round);
  }
  while (search.exclude_unobserved()) search.make_round(round);
  return search.estimate();
}

}  // namespace adasplats
