// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/kitti_sequence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <variant>

#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {

std::vector<std::filesystem::path> files_by_name(const std::filesystem::path& folder,
                                                 const std::string& extension) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) return files;
  for (const std::filesystem::path& path : list_folder(folder)) {
    // A leading dot marks files that are being written or belong to some tool.
    if (path.extension() == extension && path.filename().string().front() != '.')
      files.push_back(path);
  }
  return files;
}

std::optional<std::size_t> number_in_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  constexpr std::size_t kMaxDigits = 18;  // fits 64 bits
  if (stem.empty() || stem.size() > kMaxDigits) return std::nullopt;
  std::size_t number = 0;
  for (const char c : stem) {
    if (c < '0' || c > '9') return std::nullopt;
    number = 10 * number + static_cast<std::size_t>(c - '0');
  }
  return number;
}

namespace {

static_assert(std::endian::native == std::endian::little, "KITTI files are little-endian");

/// The pose of each scan: by the number in its name where every name is one that has a pose, else
/// one by one.
Trajectory poses_of_scans(const std::filesystem::path& poses_file, Trajectory poses,
                          const std::vector<std::filesystem::path>& scans) {
  Trajectory matched;
  for (const std::filesystem::path& scan : scans) {
    const auto number = number_in_name(scan);
    if (!number || *number >= poses.size()) break;
    matched.push_back(poses[*number]);
  }
  if (matched.size() == scans.size()) return matched;
  if (poses.size() == scans.size()) return poses;
  throw Error(ErrorKind::data, poses_file.string() + ": " + std::to_string(poses.size()) +
                                   " poses, " + std::to_string(scans.size()) +
                                   " scans; every scan needs a pose");
}

void require_labels_of_scans(const KittiSequence& sequence) {
  const std::filesystem::path folder = sequence.folder / "labels";
  if (sequence.labels.size() != sequence.scans.size())
    throw Error(ErrorKind::data, folder.string() + ": " + std::to_string(sequence.labels.size()) +
                                     " label files, " + std::to_string(sequence.scans.size()) +
                                     " scans");
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    const std::filesystem::path expected = sequence.scans[i].stem();
    if (sequence.labels[i].stem() != expected)
      throw Error(ErrorKind::data, sequence.labels[i].string() + ": belongs to no scan, expected " +
                                       expected.string() + ".label");
  }
}

const std::vector<float>& float_column(const Table& table, std::string_view name) {
  return std::get<std::vector<float>>(table.find(name)->values);
}

void take_labels(const std::filesystem::path& path, KittiScan& scan) {
  const std::vector<std::uint32_t> labels = read_kitti_labels(path);
  const std::size_t points = scan.positions.size();
  if (labels.size() != points)
    throw Error(ErrorKind::data, path.string() + ": " + std::to_string(labels.size()) +
                                     " labels, but the scan has " + std::to_string(points) +
                                     " points; one of the two files is truncated or of another "
                                     "scan");
  scan.classes.reserve(points);
  scan.instances.reserve(points);
  for (const std::uint32_t label : labels) {
    scan.classes.push_back(static_cast<std::uint16_t>(label & 0xffff));
    scan.instances.push_back(static_cast<std::uint16_t>(label >> 16));
  }
}

template <class T>
void keep_outside(const std::vector<std::uint16_t>& in_boxes, std::vector<T>& values) {
  if (values.size() != in_boxes.size()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (in_boxes[i] == 0) values[kept++] = values[i];
  values.resize(kept);
}

/// Takes what is in boxes out of a scan.
void remove_points_in_boxes(KittiScan& scan) {
  if (scan.in_boxes.empty()) return;
  keep_outside(scan.in_boxes, scan.positions);
  keep_outside(scan.in_boxes, scan.intensities);
  keep_outside(scan.in_boxes, scan.classes);
  keep_outside(scan.in_boxes, scan.instances);
  keep_outside(scan.in_boxes, scan.origins);
  keep_outside(scan.in_boxes, scan.lasers);
  keep_outside(scan.in_boxes, scan.times_s);
  scan.in_boxes = {};
}

KittiScan read_file_of(const KittiSequence& sequence, std::size_t index) {
  const std::filesystem::path& path = sequence.scans.at(index);
  if (sequence.reader) return sequence.reader->read(path);
  KittiScan scan;
  // A scan in which nothing returned is an empty file.
  std::error_code problem;
  if (std::filesystem::file_size(path, problem) != 0 || problem) {
    Table table = read_kitti_bin(path);
    const auto& x = float_column(table, "x");
    const auto& y = float_column(table, "y");
    const auto& z = float_column(table, "z");
    scan.positions.resize(table.rows);
    for (std::size_t i = 0; i < table.rows; ++i) scan.positions[i] = {x[i], y[i], z[i]};
    scan.intensities = float_column(table, "intensity");
  }
  return scan;
}

/// A scan without labels, with the boxes of its points.
KittiScan read_returns(const KittiSequence& sequence, std::size_t index) {
  KittiScan scan = read_file_of(sequence, index);
  if (sequence.boxes) scan.in_boxes = sequence.boxes->objects_in(sequence.trajectory[index], scan);
  return scan;
}

}  // namespace

bool is_kitti_sequence(const std::filesystem::path& folder) {
  std::error_code ignored;  // what cannot be looked into is no sequence
  return std::filesystem::is_directory(folder / "velodyne", ignored) || is_kitti_raw_drive(folder);
}

bool lacks_poses(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_directory(folder / "velodyne", ignored) &&
         !std::filesystem::exists(folder / "poses.txt", ignored);
}

KittiSequence open_kitti_sequence(const std::filesystem::path& folder) {
  if (is_kitti_raw_drive(folder)) return open_kitti_raw_drive(folder);
  if (!is_kitti_sequence(folder))
    throw Error(ErrorKind::no_input,
                folder.string() + ": not a SemanticKITTI sequence (no folder 'velodyne')");
  KittiSequence sequence;
  sequence.folder = folder;
  sequence.scans = files_by_name(folder / "velodyne", ".bin");
  if (sequence.scans.empty())
    throw Error(ErrorKind::no_input, (folder / "velodyne").string() + ": holds no .bin files");
  sequence.labels = files_by_name(folder / "labels", ".label");
  if (!sequence.labels.empty()) require_labels_of_scans(sequence);
  const std::filesystem::path poses_file = folder / "poses.txt";
  if (!std::filesystem::exists(poses_file) && !files_by_name(folder / "calib", ".txt").empty())
    throw Error(
        ErrorKind::no_input,
        folder.string() +
            ": contains frames of KITTI's object benchmark (calib, no poses.txt), which "
            "have no common world; give one of them with `viewpoint` 0,0,0 (the sensor), for "
            "example " +
            sequence.scans.front().string());
  if (!std::filesystem::exists(poses_file))
    throw Error(ErrorKind::no_input,
                poses_file.string() +
                    ": is missing; every scan of a sequence needs a pose (poses of another file: "
                    "give it as `trajectory`)");
  sequence.trajectory = poses_of_scans(poses_file, read_trajectory(poses_file), sequence.scans);
  sequence.has_times = has_times(poses_file);
  return sequence;
}

MeasuredBeam beam_of(const KittiSequence& sequence, std::size_t index, const KittiScan& scan,
                     std::size_t i) {
  const Vec3d point = vec_cast<double>(scan.positions[i]);
  if (scan.origins.empty()) return sequence.beams.beam_of(index, point);
  const Vec3d origin = vec_cast<double>(scan.origins[i]);
  const LaserOffsets& offsets = sequence.beams.offsets;
  const std::uint16_t laser = scan.lasers[i];
  const Vec3d end =
      offsets.corrected(origin, point, {0, 0, 1}, offsets.laser_of(point - origin, laser));
  return {origin, end, laser};
}

KittiSequence with_scans(const KittiSequence& all, std::span<const std::size_t> scans) {
  KittiSequence chosen;
  chosen.folder = all.folder;
  chosen.has_times = all.has_times;
  chosen.beams.from_hdl64 = all.beams.from_hdl64;
  chosen.beams.recognised = all.beams.recognised;
  chosen.reader = all.reader;
  chosen.boxes = all.boxes;
  chosen.facts = all.facts;
  chosen.rig_sensor = all.rig_sensor;
  for (const std::size_t i : scans) {
    chosen.scans.push_back(all.scans[i]);
    if (!all.labels.empty()) chosen.labels.push_back(all.labels[i]);
    chosen.trajectory.push_back(all.trajectory[i]);
    if (!all.beams.sweeps_m.empty()) chosen.beams.sweeps_m.push_back(all.beams.sweeps_m[i]);
    if (!all.beams.raw_motions.empty())
      chosen.beams.raw_motions.push_back(all.beams.raw_motions[i]);
  }
  return chosen;
}

double time_of_point(const KittiScan& scan, const TimedPose& pose, std::size_t i) {
  return scan.times_s.empty() || !std::isfinite(scan.times_s[i]) ? pose.time_s : scan.times_s[i];
}

KittiScan read_kitti_points(const KittiSequence& sequence, std::size_t index) {
  KittiScan scan = read_returns(sequence, index);
  remove_points_in_boxes(scan);
  return scan;
}

KittiScan read_all_returns(const KittiSequence& sequence, std::size_t index) {
  KittiScan scan = read_returns(sequence, index);
  if (!sequence.labels.empty()) take_labels(sequence.labels.at(index), scan);
  return scan;
}

std::optional<KittiScan> try_kitti_points(const KittiSequence& sequence, std::size_t index) {
  try {
    return read_kitti_points(sequence, index);
  } catch (const Error& error) {
    std::error_code ignored;
    const bool is_closed = error.kind() == ErrorKind::no_input &&
                           std::filesystem::exists(sequence.scans.at(index), ignored);
    if (error.kind() == ErrorKind::io || is_closed) throw;
    return std::nullopt;
  }
}

std::vector<std::uint32_t> read_kitti_labels(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  std::vector<std::uint32_t> labels(bytes.size() / sizeof(std::uint32_t));
  if (bytes.size() != labels.size() * sizeof(std::uint32_t))
    throw Error(ErrorKind::data,
                path.string() + ": " + std::to_string(bytes.size()) + " bytes, expected 4 a label");
  if (!labels.empty()) std::memcpy(labels.data(), bytes.data(), bytes.size());
  return labels;
}

KittiScan read_kitti_scan(const KittiSequence& sequence, std::size_t index) {
  KittiScan scan = read_all_returns(sequence, index);
  remove_points_in_boxes(scan);
  return scan;
}

}  // namespace adasplats
