// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/calibrate/recorded_hall_test.h"
#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/small_matrix.h"

namespace adasplats {
namespace {

using PointSet = CalibrationSteps::PointSet;

/// The points of a hall, all of them used, and non-zero corrections.
struct Drive {
  HallRecording recording = record_hall({0.3, 0.1, 0.03, 0.05}, 5);
  ChosenPoints few, all;
  std::vector<Vec3d> axes;
  ScanCorrections corrections;

  Drive() {
    for (std::uint32_t i = 0; i < recording.cloud.size(); ++i) {
      for (ChosenPoints* points : {&few, &all}) {
        points->indices.push_back(i);
        points->scans.push_back(recording.cloud.scan_indices[i]);
      }
    }
    all.left_out_every = 8;
    all.left_out_end = static_cast<std::uint32_t>(all.indices.size());
    for (std::size_t scan = 0; scan < recording.cloud.scan_poses.size(); ++scan) {
      Random random(9, 0, scan);
      const auto number = [&] { return 0.01 * random.uniform(-1, 1); };
      const RigidTransform& pose = recording.cloud.scan_poses[scan].world_from_sensor;
      axes.push_back(pose.rotation * Vec3d{0, 0, 1});
      corrections.corrected_from_given.push_back(
          {rotation_from_yaw_pitch_roll(number(), number(), number()),
           {number(), number(), number()}});
      corrections.pivots.push_back(corrections.corrected_from_given.back() * pose.translation);
    }
    for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
      corrections.offsets.range_m.push_back(0.001 * static_cast<double>(laser));
      corrections.offsets.elevation_rad.push_back(-0.0001 * static_cast<double>(laser));
      corrections.offsets.azimuth_rad.push_back(0.0002 * static_cast<double>(laser));
    }
  }

  std::size_t scans() const { return axes.size(); }
  std::size_t unknowns() const { return 6 * scans() + kLaserUnknowns * kHallLasers; }
  Vec3d corrected(std::uint32_t i) const {
    const std::uint32_t scan = recording.cloud.scan_indices[i];
    return corrections.corrected_from_given[scan] *
           corrections.offsets.corrected(vec_cast<double>(recording.cloud.sensor_positions[i]),
                                         vec_cast<double>(recording.cloud.positions[i]), axes[scan],
                                         recording.cloud.lasers[i]);
  }
};

/// The normal equations as a dense matrix, with derivatives by finite differences.
class DenseSystem {
 public:
  DenseSystem(const Drive& drive, const RowOptions& options)
      : drive_(drive),
        options_(options),
        matrix_(drive.unknowns() * drive.unknowns()),
        right_(drive.unknowns()) {}

  void add(const ScanPlane& plane, std::span<const std::uint32_t> members) {
    struct Row {
      std::vector<double> by_unknown;
      std::array<double, 3> by_plane;
      double residual_m, weight;
    };
    std::vector<Row> rows;
    double total = 0;
    const std::size_t stride = (members.size() + options_.max_points - 1) / options_.max_points;
    for (std::size_t k = 0; k < members.size(); k += stride) {
      if (drive_.all.is_left_out(members[k])) continue;
      const Vec3d d = drive_.corrected(members[k]) - plane.center;
      const double residual_m = dot(plane.normal, d);
      rows.push_back({derivatives(plane, members[k]),
                      {1, dot(plane.axes[0], d), dot(plane.axes[1], d)},
                      residual_m,
                      robust_weight(residual_m, options_.width_m)});
      total += rows.back().weight;
    }
    const std::size_t n = right_.size();
    std::array<double, 9> own{};
    std::vector<std::array<double, 3>> beside(n + 1);
    for (Row& row : rows) {
      row.weight *= std::min(1.0, options_.max_weight / total);
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b)
          own[a * 3 + b] += row.weight * row.by_plane[a] * row.by_plane[b];
        for (std::size_t i = 0; i < n; ++i)
          beside[i][a] += row.weight * row.by_plane[a] * row.by_unknown[i];
        beside[n][a] += row.weight * row.by_plane[a] * row.residual_m;
      }
      for (std::size_t i = 0; i < n; ++i) {
        right_[i] -= row.weight * row.by_unknown[i] * row.residual_m;
        for (std::size_t j = 0; j < n; ++j)
          matrix_[i * n + j] += row.weight * row.by_unknown[i] * row.by_unknown[j];
      }
    }
    eliminate(own, beside);
  }

  std::vector<double> times(const std::vector<double>& x) const {
    std::vector<double> y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < x.size(); ++j) y[i] += matrix_[i * x.size() + j] * x[j];
    return y;
  }
  double at(std::size_t i, std::size_t j) const { return matrix_[i * right_.size() + j]; }
  const std::vector<double>& right() const { return right_; }

 private:
  void eliminate(std::array<double, 9> own, const std::vector<std::array<double, 3>>& beside) {
    const std::size_t n = right_.size();
    factor<3>(own);
    for (std::size_t i = 0; i < n; ++i) {
      const std::array<double, 3> solved_row = solved<3>(own, beside[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        right_[i] += solved_row[k] * beside[n][k];
        for (std::size_t j = 0; j < n; ++j) matrix_[i * n + j] -= solved_row[k] * beside[j][k];
      }
    }
  }

  double distance_m(const ScanPlane& plane, std::uint32_t i, std::size_t unknown,
                    double step) const {
    const PointCloud& cloud = drive_.recording.cloud;
    const std::uint32_t scan = cloud.scan_indices[i];
    LaserOffsets offsets = drive_.corrections.offsets;
    const std::size_t of_lasers = 6 * drive_.scans();
    if (unknown >= of_lasers) {
      const std::array values = {&offsets.range_m, &offsets.elevation_rad, &offsets.azimuth_rad};
      const std::size_t of_laser = unknown - of_lasers;
      (*values[of_laser % kLaserUnknowns])[of_laser / kLaserUnknowns] += step;
    }
    Vec3d p =
        drive_.corrections.corrected_from_given[scan] *
        offsets.corrected(vec_cast<double>(cloud.sensor_positions[i]),
                          vec_cast<double>(cloud.positions[i]), drive_.axes[scan], cloud.lasers[i]);
    if (unknown < of_lasers && unknown / 6 == scan) {
      Vec3d axis;
      axis[static_cast<int>(unknown % 3)] = step;
      p = unknown % 6 < 3 ? p + cross(axis, p - drive_.corrections.pivots[scan]) : p + axis;
    }
    return dot(plane.normal, p - plane.center);
  }

  std::vector<double> derivatives(const ScanPlane& plane, std::uint32_t i) const {
    const std::uint32_t scan = drive_.recording.cloud.scan_indices[i];
    std::vector<double> result(right_.size());
    const auto set = [&](std::size_t unknown) {
      constexpr double kStep = 1e-3;  // all residuals are linear in it
      result[unknown] =
          (distance_m(plane, i, unknown, kStep) - distance_m(plane, i, unknown, -kStep)) /
          (2 * kStep);
    };
    for (std::size_t a = 0; a < 6; ++a) set(6 * scan + a);
    for (std::size_t b = 0; b < kLaserUnknowns; ++b)
      set(6 * drive_.scans() + kLaserUnknowns * drive_.recording.cloud.lasers[i] + b);
    return result;
  }

  const Drive& drive_;
  const RowOptions& options_;
  std::vector<double> matrix_, right_;
};

std::vector<double> joined(const PlaneStep& step) {
  std::vector<double> all = step.poses;
  all.insert(all.end(), step.lasers.begin(), step.lasers.end());
  return all;
}

// Oracle: the dense normal equations, with derivatives by finite differences.
TEST(PlaneSums, MatchTheDenseNormalEquations) {
  const Drive drive;
  const Executor executor(2);
  const auto steps = make_cpu_calibration_steps(executor);
  steps->load(drive.recording.cloud, drive.few, drive.all, drive.axes, kHallLasers);
  steps->correct(PointSet::all, drive.corrections);
  const std::vector<ScanPlane> planes = steps->find_planes(PointSet::all, {});
  RowOptions options;
  options.max_points = 50;
  options.max_weight = 20;
  options.width_m = 0.1;
  options.azimuths = true;
  steps->choose_rows(options);
  PlaneBlocks blocks = steps->sum_rows(drive.corrections, options);

  std::vector<Vec3d> corrected;
  for (std::uint32_t i = 0; i < drive.recording.cloud.size(); ++i)
    corrected.push_back(drive.corrected(i));
  const ScanPlanes found = find_scan_planes(corrected, drive.all.scans, {}, executor);
  ASSERT_EQ(found.planes.size(), planes.size());
  ASSERT_GT(planes.size(), 50U);
  DenseSystem dense(drive, options);
  for (const ScanPlane& plane : found.planes) dense.add(plane, found.points_of(plane));

  double largest = 0;
  for (std::size_t i = 0; i < drive.unknowns(); ++i) largest = std::max(largest, dense.at(i, i));
  for (std::size_t scan = 0; scan < drive.scans(); ++scan) {
    for (std::size_t a = 0; a < 6; ++a) {
      EXPECT_NEAR(blocks.poses[scan].right[a], dense.right()[6 * scan + a], 1e-8 * largest);
      for (std::size_t b = 0; b < 6; ++b)
        EXPECT_NEAR(blocks.poses[scan].reduced[a * 6 + b], dense.at(6 * scan + a, 6 * scan + b),
                    1e-8 * largest);
    }
  }
  PlaneStep x;
  for (std::size_t i = 0; i < drive.unknowns(); ++i) {
    Random random(10, 0, i);
    (i < 6 * drive.scans() ? x.poses : x.lasers).push_back(random.normal());
  }
  // `coupled` leaves only the diagonal blocks to the system.
  PlaneStep y = steps->coupled(x);
  for (std::size_t scan = 0; scan < drive.scans(); ++scan)
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        y.poses[6 * scan + a] += blocks.poses[scan].full[a * 6 + b] * x.poses[6 * scan + b];
  for (std::size_t laser = 0; laser < kHallLasers; ++laser)
    for (std::size_t a = 0; a < kLaserUnknowns; ++a)
      for (std::size_t b = 0; b < kLaserUnknowns; ++b)
        y.lasers[kLaserUnknowns * laser + a] += blocks.lasers[laser].full[a * kLaserUnknowns + b] *
                                                x.lasers[kLaserUnknowns * laser + b];
  const std::vector<double> found_y = joined(y), expected = dense.times(joined(x));
  for (std::size_t i = 0; i < drive.unknowns(); ++i)
    EXPECT_NEAR(found_y[i], expected[i], 1e-7 * largest) << i;

  // Conjugate gradients solve it, with priors that fix the absolute position.
  PlaneSystem system(std::move(blocks));
  for (std::size_t scan = 0; scan < drive.scans(); ++scan)
    for (std::size_t a = 0; a < 6; ++a) system.add_pose_prior(scan, a, 1, 0);
  for (std::size_t laser = 0; laser < kHallLasers; ++laser)
    for (std::size_t a = 0; a < kLaserUnknowns; ++a) system.add_laser_prior(laser, a, 1, 0, 0);
  const std::vector<double> solution = joined(
      system.solve(1e-10, 1000, [&](const PlaneStep& step) { return steps->coupled(step); }));
  std::vector<double> back = dense.times(solution);
  for (std::size_t i = 0; i < drive.unknowns(); ++i)
    EXPECT_NEAR(back[i] + solution[i], dense.right()[i], 1e-6 * largest) << i;
}

}  // namespace
}  // namespace adasplats
