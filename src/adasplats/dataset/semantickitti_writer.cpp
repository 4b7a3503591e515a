// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/semantickitti_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/atomic_file.h"

namespace adasplats {

namespace {

static_assert(std::endian::native == std::endian::little, "KITTI files are little-endian");

// Camera axes (x right, y down, z forward) against LiDAR axes (x forward, y left, z up). A change
// of axes alone is exact in floating point, so poses read back as they were.
constexpr RigidTransform kCameraFromVelodyne = {{{{0, -1, 0}, {0, 0, -1}, {1, 0, 0}}}, {}};

/// The shortest text that reads back as the same bits.
std::string exact_text(double value) {
  std::array<char, 32> buffer;
  // Adding zero makes of the -0 that axis changes leave a 0.
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0).ptr;
  return std::string(buffer.data(), end);
}

/// Twelve numbers: the upper 3x4 of the matrix by rows.
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

std::string scan_name(std::size_t index) {
  const std::string digits = std::to_string(index);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

void create_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem)
    throw system_error(ErrorKind::cannot_create, folder, "cannot be created", problem.value());
}

template <class T>
void write_values(const std::filesystem::path& path, const std::vector<T>& values) {
  AtomicFile file(path);
  file.write(values.data(), values.size() * sizeof(T));
  file.commit();
}

/// Scans of an earlier, longer run would belong to no pose.
void refuse_other_scans(const std::filesystem::path& folder, std::size_t scans) {
  std::error_code problem;
  std::filesystem::directory_iterator entry(folder, problem);
  for (; !problem && entry != std::filesystem::directory_iterator(); entry.increment(problem)) {
    const std::filesystem::path& path = entry->path();
    const std::string name = path.stem().string();
    if (path.extension() != ".bin") continue;
    const bool ours = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos &&
                      name.size() < 18 && std::stoull(name) < scans;
    if (!ours)
      throw Error(ErrorKind::cannot_create, path.string() + ": is of another run, this one wrote " +
                                                std::to_string(scans) +
                                                " scans; remove it or write elsewhere");
  }
  if (problem) throw system_error(ErrorKind::io, folder, "cannot be listed", problem.value());
}

bool ascends(const Trajectory& trajectory) {
  return std::ranges::adjacent_find(trajectory, [](const TimedPose& a, const TimedPose& b) {
           return !(a.time_s < b.time_s);
         }) == trajectory.end();
}

}  // namespace

SemanticKittiWriter::SemanticKittiWriter(std::filesystem::path sequence_folder)
    : folder_(std::move(sequence_folder)) {
  std::error_code ignored;  // what cannot be looked into cannot be written either
  if (std::filesystem::exists(folder_ / "poses.txt", ignored))
    throw Error(ErrorKind::cannot_create,
                folder_.string() + ": already holds a whole sequence (poses.txt)");
  create_folder(folder_ / "velodyne");
}

void SemanticKittiWriter::write_scan(std::size_t index, const Scan& scan) {
  const std::filesystem::path labels = folder_ / "labels";
  if (!scan.classes.empty() && !has_labels_) {
    create_folder(labels);
    has_labels_ = true;
  }
  if (scan.classes.empty() && scan.size() != 0) has_unlabelled_ = true;
  if (has_labels_ && has_unlabelled_)
    throw std::logic_error("SemanticKittiWriter: scans with and without classes");
  const std::string name = scan_name(index);
  write_values(folder_ / "velodyne" / (name + ".bin"), points_with_intensity(scan));
  if (!scan.classes.empty()) write_values(labels / (name + ".label"), packed_labels(scan));
  if (trajectory_.size() <= index) {
    trajectory_.resize(index + 1);
    point_counts_.resize(index + 1);
  }
  trajectory_[index] = {scan.time_s, scan.world_from_sensor};
  point_counts_[index] = scan.size();
}

void SemanticKittiWriter::finish() {
  refuse_other_scans(folder_ / "velodyne", trajectory_.size());
  std::string poses, times;
  for (std::size_t i = 0; i < trajectory_.size(); ++i) {
    if (!point_counts_[i])
      throw std::logic_error("SemanticKittiWriter: scan " + std::to_string(i) + " is missing");
    if (has_labels_ && *point_counts_[i] == 0)
      write_file(folder_ / "labels" / (scan_name(i) + ".label"), "");
    poses += matrix_text(kCameraFromVelodyne * trajectory_[i].world_from_sensor *
                         kCameraFromVelodyne.inverse()) +
             "\n";
    times += exact_text(trajectory_[i].time_s) + "\n";
  }
  write_file(folder_ / "calib.txt", "Tr: " + matrix_text(kCameraFromVelodyne) + "\n");
  // Several drives one after another have no common clock; readers then count scans.
  if (ascends(trajectory_)) write_file(folder_ / "times.txt", times);
  write_file(folder_ / "poses.txt", poses);
}

}  // namespace adasplats
