// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/semantickitti_writer.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {

namespace {

static_assert(std::endian::native == std::endian::little, "KITTI files are little-endian");

// Camera axes (x right, y down, z forward) from LiDAR axes (x forward, y left, z up). A permutation
// of axes is exact in floating point, so poses are read back unchanged.
constexpr RigidTransform kCameraFromVelodyne = {{{{0, -1, 0}, {0, 0, -1}, {1, 0, 0}}}, {}};

/// Twelve numbers: the upper 3x4 of the matrix, row-major.
std::string matrix_text(const RigidTransform& transform) {
  std::string text;
  for (int r = 0; r < 3; ++r) {
    const Vec3d row = transform.rotation.rows[r];
    for (const double value : {row.x, row.y, row.z, transform.translation[r]}) {
      if (!text.empty()) text += ' ';
      text += exact_text(value);
    }
  }
  return text;
}

constexpr std::size_t kPointBytes = 4 * sizeof(float);

std::size_t size_of(const std::filesystem::path& path) {
  std::error_code problem;
  const auto bytes = std::filesystem::file_size(path, problem);
  if (problem) throw system_error(ErrorKind::io, path, "cannot be accessed", problem.value());
  return static_cast<std::size_t>(bytes);
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Rejects scans of an earlier, longer run, which would have no pose.
void refuse_other_scans(const std::filesystem::path& folder, std::size_t scans) {
  for (const std::filesystem::path& path : list_folder(folder)) {
    const std::string name = path.stem().string();
    if (path.extension() != ".bin") continue;
    const bool ours = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos &&
                      name.size() < 18 && std::stoull(name) < scans;
    if (!ours)
      throw Error(ErrorKind::cannot_create,
                  path.string() + ": belongs to another run; this one wrote " +
                      std::to_string(scans) + " scans; remove it or use another folder");
  }
}

bool ascends(const Trajectory& trajectory) {
  return std::ranges::adjacent_find(trajectory, [](const TimedPose& a, const TimedPose& b) {
           return !(a.time_s < b.time_s);
         }) == trajectory.end();
}

}  // namespace

SemanticKittiPoses semantickitti_poses(const Trajectory& trajectory) {
  SemanticKittiPoses texts;
  texts.calib = "Tr: " + matrix_text(kCameraFromVelodyne) + "\n";
  for (const TimedPose& pose : trajectory) {
    texts.poses +=
        matrix_text(kCameraFromVelodyne * pose.world_from_sensor * kCameraFromVelodyne.inverse()) +
        "\n";
    texts.times += exact_text(pose.time_s) + "\n";
  }
  return texts;
}

SemanticKittiWriter::SemanticKittiWriter(std::filesystem::path sequence_folder,
                                         std::filesystem::path more_poses)
    : folder_(std::move(sequence_folder)), more_poses_(std::move(more_poses)) {
  std::error_code ignored;  // a folder that cannot be read fails on writing, too
  if (std::filesystem::exists(folder_ / "poses.txt", ignored))
    throw Error(ErrorKind::cannot_create,
                folder_.string() + ": already contains a complete sequence (poses.txt)");
  create_folder(folder_ / "velodyne");
}

EncodedScan SemanticKittiWriter::encode(std::size_t index, const ScanView& scan,
                                        std::span<const std::uint32_t> order) {
  EncodedScan encoded;
  encoded.pose = {scan.time_s, scan.world_from_sensor};
  encoded.points = scan.size();
  encoded.has_classes = !scan.classes.empty();
  const std::string name = scan_name(index);
  if (encoded.has_classes)
    encoded.files.push_back({"labels/" + name + ".label", bytes_of(packed_labels(scan, order))});
  encoded.files.push_back({"velodyne/" + name + ".bin", points_with_intensity(scan, order)});
  return encoded;
}

void SemanticKittiWriter::require_alike(const EncodedScan& scan) {
  has_labels_ = has_labels_ || scan.has_classes;
  has_unlabelled_ = has_unlabelled_ || (!scan.has_classes && scan.points != 0);
  if (has_labels_ && has_unlabelled_)
    throw std::logic_error("SemanticKittiWriter: only some scans have classes");
}

void SemanticKittiWriter::note_written(std::size_t index, const EncodedScan& scan) {
  require_alike(scan);
  note(index, scan.pose, scan.points);
}

void SemanticKittiWriter::write_scan(std::size_t index, const ScanView& scan) {
  const EncodedScan encoded = encode(index, scan);
  require_alike(encoded);
  write_encoded(folder_, encoded.files, FileWrites::atomic);
  note_written(index, encoded);
}

void SemanticKittiWriter::keep_scan(std::size_t index, const TimedPose& pose) {
  const std::filesystem::path points = folder_ / "velodyne" / (scan_name(index) + ".bin");
  const std::filesystem::path labels = folder_ / "labels" / (scan_name(index) + ".label");
  const std::size_t count = size_of(points) / kPointBytes;
  const bool labelled = std::filesystem::exists(labels);
  if (labelled && size_of(labels) != count * sizeof(std::uint32_t))
    throw Error(ErrorKind::io, labels.string() + ": does not have the same number of points as " +
                                   points.string() + "; remove both");
  has_labels_ = has_labels_ || labelled;
  has_unlabelled_ = has_unlabelled_ || (!labelled && count != 0);
  note(index, pose, count);
}

void SemanticKittiWriter::note(std::size_t index, const TimedPose& pose, std::size_t points) {
  if (trajectory_.size() <= index) {
    trajectory_.resize(index + 1);
    point_counts_.resize(index + 1);
  }
  trajectory_[index] = pose;
  point_counts_[index] = points;
}

void SemanticKittiWriter::finish() {
  refuse_other_scans(folder_ / "velodyne", trajectory_.size());
  for (std::size_t i = 0; i < trajectory_.size(); ++i) {
    if (!point_counts_[i])
      throw std::logic_error("SemanticKittiWriter: scan " + std::to_string(i) + " is missing");
    if (has_labels_ && *point_counts_[i] == 0)
      write_file(folder_ / "labels" / (scan_name(i) + ".label"), "");
  }
  const auto [calib, poses, times] = semantickitti_poses(trajectory_);
  write_file(folder_ / "calib.txt", calib);
  // Concatenated drives have no common clock; readers then count scans.
  if (ascends(trajectory_)) write_file(folder_ / "times.txt", times);
  if (!more_poses_.empty()) {
    create_folder(more_poses_.parent_path());
    write_file(more_poses_, poses);
  }
  write_file(folder_ / "poses.txt", poses);
}

}  // namespace adasplats
