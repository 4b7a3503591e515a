// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/pandaset_frames.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/dataset/tree_names.h"
#include "adasplats/io/pickle/data_frame.h"
#include "adasplats/io/pickle/gzip.h"

namespace adasplats {
namespace {

/// PandaSet's names of KITTI's object types.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kPandaLabels = {
    {{"Car", "Car"},
     {"Truck", "Medium-sized Truck"},
     {"Pedestrian", "Pedestrian"},
     {"Cyclist", "Bicycle"},
     {"Tram", "Tram / Subway"},
     {"Misc", "Other Vehicle - Uncommon"}}};

std::string panda_label(std::string_view kitti) {
  for (const auto& [type, label] : kPandaLabels)
    if (type == kitti) return std::string(label);
  return "Other Static Object";
}

/// The columns of cuboids, in PandaSet's order.
struct CuboidColumns {
  using Texts = std::vector<std::string>;
  using Numbers = std::vector<double>;
  using Integers = std::vector<std::int64_t>;

  Texts uuids, labels, motions, siblings, riders, behaviours, ages;
  Numbers yaws, x, y, z, width, length, height;
  std::vector<bool> stationary;
  Integers cameras, sensors;

  void add(const TreeBox& box) {
    const RigidTransform& pose = box.box.world_from_box;
    const Vec3d along = {pose.rotation.rows[0].x, pose.rotation.rows[1].x, 0};
    const bool is_person = box.type == "Pedestrian", is_rider = box.type == "Cyclist";
    uuids.push_back(uuid_of("object " + std::to_string(box.box.instance)));
    labels.push_back(panda_label(box.type));
    yaws.push_back(
        std::remainder(std::atan2(along.y, along.x) - std::numbers::pi / 2, 2 * std::numbers::pi));
    stationary.push_back(!box.moves);
    cameras.push_back(-1);
    x.push_back(pose.translation.x);
    y.push_back(pose.translation.y);
    z.push_back(pose.translation.z);
    width.push_back(box.box.size_m.y);
    length.push_back(box.box.size_m.x);
    height.push_back(box.box.size_m.z);
    motions.emplace_back(is_person ? "" : (box.moves ? "Moving" : "Parked"));
    siblings.emplace_back("");
    sensors.push_back(-1);
    riders.emplace_back(is_rider ? "With Rider" : "");
    behaviours.emplace_back(is_person ? (box.moves ? "Walking" : "Standing") : "");
    ages.emplace_back(is_person ? "Adult" : "");
  }

  std::vector<FrameColumn> take() {
    return {{"uuid", std::move(uuids)},
            {"label", std::move(labels)},
            {"yaw", std::move(yaws)},
            {"stationary", std::move(stationary)},
            {"camera_used", std::move(cameras)},
            {"position.x", std::move(x)},
            {"position.y", std::move(y)},
            {"position.z", std::move(z)},
            {"dimensions.x", std::move(width)},
            {"dimensions.y", std::move(length)},
            {"dimensions.z", std::move(height)},
            {"attributes.object_motion", std::move(motions)},
            {"cuboids.sibling_id", std::move(siblings)},
            {"cuboids.sensor_id", std::move(sensors)},
            {"attributes.rider_status", std::move(riders)},
            {"attributes.pedestrian_behavior", std::move(behaviours)},
            {"attributes.pedestrian_age", std::move(ages)}};
  }
};

}  // namespace

std::string pandaset_points(const ScanView& scan, std::span<const std::uint32_t> order) {
  std::vector<double> x, y, z, intensities, times;
  for (auto* values : {&x, &y, &z, &intensities, &times}) values->reserve(order.size());
  for (const std::uint32_t i : order) {
    const Vec3d p = world_point_of(scan, i);
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    const double intensity = scan.intensities.empty() ? 0.0 : double{scan.intensities[i]};
    // A NaN would break the training of networks on these files.
    intensities.push_back(std::isnan(intensity) ? 0.0 : intensity);
    times.push_back(scan.moved() && !scan.times_s.empty() ? scan.begin_s() + double{scan.times_s[i]}
                                                          : scan.time_s);
  }
  std::vector<std::int64_t> sensors(order.size(), 0);
  const std::vector<FrameColumn> columns = {{"x", std::move(x)},     {"y", std::move(y)},
                                            {"z", std::move(z)},     {"i", std::move(intensities)},
                                            {"t", std::move(times)}, {"d", std::move(sensors)}};
  return gzipped(pickled_data_frame(columns));
}

std::string pandaset_classes(const ScanView& scan, std::span<const std::uint32_t> order) {
  std::vector<std::int64_t> classes;
  classes.reserve(order.size());
  for (const std::uint32_t i : order) classes.push_back(scan.classes[i]);
  return gzipped(pickled_data_frame(std::vector<FrameColumn>{{"class", std::move(classes)}}));
}

std::string pandaset_cuboids(std::span<const TreeBox> boxes) {
  CuboidColumns columns;
  for (const TreeBox& box : boxes) columns.add(box);
  return gzipped(pickled_data_frame(columns.take()));
}

}  // namespace adasplats
