// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/kitti_boxes.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

// Noise moves points off the faces of their object.
constexpr double kMargin_m = 0.05;

/// A word in the name of a class and its KITTI type; the first match counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kTypes = {
    {{"bicyclist", "Cyclist"},
     {"motorcyclist", "Cyclist"},
     {"rider", "Cyclist"},
     {"other-vehicle", "Misc"},
     {"truck", "Truck"},
     {"rails", "Tram"},
     {"tram", "Tram"},
     {"person", "Pedestrian"},
     {"pedestrian", "Pedestrian"},
     {"car", "Car"},
     {"vehicle", "Car"}}};

std::size_t points_within(const RigidTransform& box_from_sensor, Vec3d size_m,
                          const ScanView& scan) {
  const Vec3d half = 0.5 * size_m + Vec3d{kMargin_m, kMargin_m, kMargin_m};
  std::size_t count = 0;
  for (const Vec3f& position : scan.positions) {
    const Vec3d p = box_from_sensor * vec_cast<double>(position);
    if (std::fabs(p.x) <= half.x && std::fabs(p.y) <= half.y && std::fabs(p.z) <= half.z) ++count;
  }
  return count;
}

double within_half_turn(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

/// One line of numbers with this number of decimals.
std::string numbers(std::initializer_list<double> values, int decimals) {
  std::string line;
  std::array<char, 64> buffer{};
  for (const double value : values) {
    std::snprintf(buffer.data(), buffer.size(), " %.*f", decimals, value + 0.0);
    line += buffer.data();
  }
  return line;
}

std::string camera_line(const SensedBox& box) {
  const Vec3d bottom = box.center_m - Vec3d{0, 0, 0.5 * box.size_m.z};
  // A rotation about the camera's y (down), starting at its x (right).
  const double rotation_y = within_half_turn(-box.yaw_rad - 0.5 * std::numbers::pi);
  return box.type + " -1 3 -10 -1 -1 -1 -1" +
         numbers(
             {box.size_m.z, box.size_m.y, box.size_m.x, -bottom.y, -bottom.z, bottom.x, rotation_y},
             3) +
         "\n";
}

std::string velodyne_line(const SensedBox& box) {
  return box.type + " " + std::to_string(box.instance) +
         numbers({box.center_m.x, box.center_m.y, box.center_m.z, box.size_m.x, box.size_m.y,
                  box.size_m.z, box.yaw_rad},
                 4) +
         " " + std::to_string(box.points) + "\n";
}

}  // namespace

std::string_view kitti_type(std::string_view class_name) {
  for (const auto& [word, type] : kTypes)
    if (class_name.find(word) != std::string_view::npos) return type;
  return "Misc";
}

std::vector<SensedBox> sensed_boxes(std::span<const ObjectBox> boxes, const ScanView& scan,
                                    const LabelScheme* labels) {
  std::vector<SensedBox> sensed;
  for (const ObjectBox& box : boxes) {
    const RigidTransform sensor_from_box = scan.world_from_sensor.inverse() * box.world_from_box;
    const SemanticClass* const known = labels != nullptr ? labels->find(box.class_id) : nullptr;
    const Mat3d& axes = sensor_from_box.rotation;
    sensed.push_back({std::string(kitti_type(known != nullptr ? known->name : "")), box.class_id,
                      box.instance, sensor_from_box.translation, box.size_m,
                      std::atan2(axes.rows[1].x, axes.rows[0].x),
                      points_within(sensor_from_box.inverse(), box.size_m, scan)});
  }
  return sensed;
}

std::vector<EncodedFile> encode_kitti_boxes(const std::string& folder, std::size_t index,
                                            std::span<const SensedBox> boxes,
                                            std::size_t min_points) {
  std::string camera, velodyne;
  for (const SensedBox& box : boxes) {
    if (box.points < min_points) continue;
    camera += camera_line(box);
    velodyne += velodyne_line(box);
  }
  const std::filesystem::path below(folder);
  const std::string name = scan_name(index) + ".txt";
  return {{(below / "label_2" / name).string(), camera},
          {(below / "label_velodyne" / name).string(), velodyne}};
}

void write_kitti_boxes(const std::filesystem::path& folder, std::size_t index,
                       std::span<const SensedBox> boxes, std::size_t min_points) {
  write_encoded(folder, encode_kitti_boxes("", index, boxes, min_points), FileWrites::atomic);
}

}  // namespace adasplats
