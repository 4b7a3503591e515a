// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/compare/comparison_data.h"

#include <algorithm>
#include <array>
#include <map>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/core/maths/symmetric_eigen.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/compare/steps.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr Vec3d kShiftMapping_m = {1, 1, -1};    // paper, PC3D-Paris
constexpr Vec3d kShiftVehicle_m = {1, 1, -0.5};  // paper, SemanticKITTI
constexpr double kTrajectoryCell_m = 1.0;
constexpr std::size_t kLinePoses = 20;
constexpr double kSensorHeight_m = 1.8;
constexpr double kScanPeriod_s = 0.1;

std::string title_of(const fs::path& data) {
  const fs::path normal = fs::absolute(data).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).filename().string();
}

/// A sequence folder as the models' input.
void set_sequence(ComparisonData& found, const fs::path& sequence) {
  found.inputs = {sequence};
  found.trajectory = sequence;
  found.offset_m = kShiftVehicle_m;
  if (fs::is_directory(sequence / "labels")) found.labels = "semantickitti";
}

bool is_street(const fs::path& data) {
  return fs::is_regular_file(data / "mapping.ply") && fs::is_regular_file(data / "mesh.ply");
}

ComparisonData street_data(const fs::path& data) {
  ComparisonData found;
  found.inputs = {data / "mapping.ply"};
  found.labels = "semantickitti";
  found.trajectory = data / "mapping_trajectory.csv";
  found.offset_m = kShiftMapping_m;
  found.truth = data / "mesh.ply";
  if (is_kitti_sequence(data / "sequences" / "00")) found.held_out = data / "sequences" / "00";
  return found;
}

/// The first number in a text, or an empty text.
std::string first_number(const std::string& text) {
  constexpr const char* kDigits = "0123456789";
  const std::size_t first = std::min(text.find_first_of(kDigits), text.size());
  return text.substr(first, text.find_first_not_of(kDigits, first) - first);
}

/// The PLY file below `data` with a name that begins with "soufflot" and contains `number` first.
fs::path soufflot_file(const fs::path& data, const std::string& number) {
  std::vector<fs::path> matches;
  for (const fs::path& file : files_below(data)) {
    const std::string name = lower_case(file.filename().string());
    if (lower_case(file.extension().string()) != ".ply") continue;
    if (name.rfind("soufflot", 0) != 0 || first_number(name) != number) continue;
    matches.push_back(file);
  }
  if (matches.empty()) {
    throw Error(ErrorKind::data, data.string() + ": contains no PLY file of Soufflot-" + number +
                                     ", expected the layout of Paris-CARLA-3D");
  }
  return matches.front();
}

ComparisonData pc3d_data(const fs::path& data) {
  ComparisonData found;
  found.inputs = {soufflot_file(data, "1"), soufflot_file(data, "2")};
  found.labels = "paris-carla-3d";
  found.offset_m = kShiftMapping_m;
  return found;
}

ComparisonData kitti_data(const fs::path& data) {
  ComparisonData found;
  for (const fs::path& sequence :
       {data / "sequences" / "00", data / "dataset" / "sequences" / "00", data / "00", data}) {
    if (!is_kitti_sequence(sequence)) continue;
    set_sequence(found, sequence);
    found.scans.count = 150;
    return found;
  }
  throw Error(
      ErrorKind::data,
      data.string() + ": contains no sequence 00 (sequences/00 with velodyne, labels, poses)");
}

double quantile(std::vector<float>& values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(k)]);
}

/// Horizontal main direction of points, unit; x if all points coincide.
Vec3d main_direction(const std::vector<Vec3f>& points) {
  Vec3d mean;
  for (const Vec3f& p : points) mean = mean + vec_cast<double>(p);
  mean = mean / static_cast<double>(points.size());
  SymmetricMat3d covariance{};
  for (const Vec3f& p : points) {
    const Vec3d d = vec_cast<double>(p) - mean;
    covariance.xx += d.x * d.x;
    covariance.xy += d.x * d.y;
    covariance.yy += d.y * d.y;
  }
  Vec3d axis = symmetric_eigen(covariance).vectors[0];
  axis.z = 0;
  const double size = length(axis);
  if (!(size > 0)) return {1, 0, 0};
  axis = axis / size;
  return axis.x < 0 ? -1.0 * axis : axis;
}

Trajectory poses_at(const std::vector<Vec3d>& positions) {
  Trajectory trajectory;
  for (const Vec3d& position : positions) {
    TimedPose pose;
    pose.time_s = kScanPeriod_s * static_cast<double>(trajectory.size());
    pose.world_from_sensor.translation = position;
    trajectory.push_back(pose);
  }
  return trajectory;
}

/// The path of the sensor, or of the first one of a rig.
std::vector<Vec3d> path_of_sensor_positions(const PointCloud& cloud) {
  struct Cell {
    Vec3d sum;
    double count = 0;
  };
  std::map<std::array<std::int64_t, 3>, Cell> cells;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_beam(cloud.origin_kind(i))) continue;
    if (!cloud.sensors.empty() && cloud.scan_indices[i] >= cloud.sensors.front().scans) continue;
    const Vec3d d = vec_cast<double>(cloud.sensor_positions[i]);
    std::array<std::int64_t, 3> key{};
    for (int axis = 0; axis < 3; ++axis) {
      key[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor(d[axis] / kTrajectoryCell_m));
    }
    Cell& cell = cells[key];
    cell.sum = cell.sum + d;
    cell.count += 1;
  }
  std::vector<Vec3d> positions;
  std::vector<Vec3f> local;
  for (const auto& [key, cell] : cells) {
    positions.push_back(cell.sum / cell.count);
    local.push_back(vec_cast<float>(positions.back()));
  }
  const Vec3d axis = main_direction(local);
  std::sort(positions.begin(), positions.end(),
            [&](const Vec3d& a, const Vec3d& b) { return dot(a, axis) < dot(b, axis); });
  for (Vec3d& position : positions) position = position + cloud.origin;
  return positions;
}

std::vector<Vec3d> path_through_points(const PointCloud& cloud) {
  const Vec3d axis = main_direction(cloud.positions);
  const Vec3d side = {-axis.y, axis.x, 0};
  std::vector<float> along, across, heights;
  for (const Vec3f& p : cloud.positions) {
    const Vec3d d = vec_cast<double>(p);
    along.push_back(static_cast<float>(dot(d, axis)));
    across.push_back(static_cast<float>(dot(d, side)));
    heights.push_back(p.z);
  }
  const double first = quantile(along, 0.1), last = quantile(along, 0.9);
  const double middle = quantile(across, 0.5);
  const double height = quantile(heights, 0.05) + kSensorHeight_m;
  std::vector<Vec3d> positions;
  for (std::size_t k = 0; k < kLinePoses; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(kLinePoses - 1);
    Vec3d position = (first + share * (last - first)) * axis + middle * side;
    position.z = height;
    positions.push_back(position + cloud.origin);
  }
  return positions;
}

/// The poses of the chosen scans.
Trajectory poses_of_scans(const fs::path& sequence, const ScanRange& range) {
  const Trajectory all = load_trajectory(sequence);
  Trajectory chosen;
  for (const std::size_t k : chosen_scans(range, all.size(), sequence)) chosen.push_back(all[k]);
  return chosen;
}

PointCloud without(const PointCloud& cloud, const RemovedPoints& removed) {
  std::vector<std::uint32_t> kept;
  kept.reserve(cloud.size() - removed.points);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (removed.ids[cloud.classes[i]] == 0) kept.push_back(i);
  }
  return gather(cloud, kept);
}

}  // namespace

ComparisonData find_comparison_data(const fs::path& data, Preset preset) {
  require_input(data);
  ComparisonData found;
  if (preset == Preset::paper_pc3d) {
    found = pc3d_data(data);
  } else if (preset == Preset::paper_kitti) {
    found = kitti_data(data);
  } else if (is_street(data)) {
    found = street_data(data);
  } else if (is_kitti_sequence(data / "sequences" / "00")) {
    set_sequence(found, data / "sequences" / "00");
    if (is_kitti_sequence(data / "sequences" / "01")) found.held_out = data / "sequences" / "01";
  } else if (is_kitti_sequence(data)) {
    set_sequence(found, data);
  } else {
    found.inputs = {data};
  }
  found.title = title_of(data);
  return found;
}

PointFacts survey_points(const ComparisonData& data, const fs::path& original_file,
                         Session& session) {
  LoadOptions options;
  const bool all_scans = data.scans == ScanRange();
  options.first_scan = data.scans.first;
  options.scan_count = data.scans.count;
  options.scan_stride = data.scans.stride;
  PointCloud cloud = load_cloud(data.inputs, options, session.executor, session.progress).first;
  if (cloud.empty()) throw Error(ErrorKind::data, data.title + ": no points");
  PointFacts facts;
  facts.points = cloud.size();
  facts.has_classes = !cloud.classes.empty();
  const auto known = std::count_if(cloud.classes.begin(), cloud.classes.end(),
                                   [](std::uint16_t id) { return id != 0; });
  facts.labelled = 2 * static_cast<std::size_t>(known) > cloud.size();
  if (data.trajectory.empty()) {
    facts.trajectory = trajectory_of(cloud);
  } else if (!all_scans && data.trajectory == data.inputs.front()) {
    facts.trajectory = poses_of_scans(data.trajectory, data.scans);
  }
  const std::optional<LabelScheme> scheme = label_scheme_for(data.labels, data.inputs);
  const LabelScheme* const labels = scheme ? &*scheme : nullptr;
  check_label_use({"", data.removal, data.removal_is_asked}, cloud, labels, session.progress);
  facts.removed = points_to_remove(cloud, labels, data.removal);
  const bool whole = data.inputs.size() == 1 && all_scans && facts.removed.points == 0;
  facts.original = whole ? data.inputs.front() : original_file;
  if (facts.removed.points > 0) cloud = without(cloud, facts.removed);
  if (cloud.empty()) throw Error(ErrorKind::data, data.title + ": all points are removed");
  if (!whole) {
    write_if_changed(original_file, [&](const fs::path& file) { save_cloud_ply(file, cloud); });
  }
  return facts;
}

Trajectory trajectory_of(const PointCloud& cloud) {
  return poses_at(cloud.has_beams() ? path_of_sensor_positions(cloud) : path_through_points(cloud));
}

}  // namespace adasplats
