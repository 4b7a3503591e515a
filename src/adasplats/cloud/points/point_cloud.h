// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/cloud/points/origin_kind.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// A beam without return.
struct EmptyBeam {
  Vec3f origin;            ///< where it left the sensor, relative to the cloud's origin, m
  Vec3f direction;         ///< unit, world axes
  std::uint32_t scan = 0;  ///< number of its scan
  /// False: it met the sky, so the space along it is free. True: unknown; it may have met a surface
  /// that returned too little.
  bool lost = false;
};

/// Columns of files that no attribute holds, with one value a point. Filled only on request
/// (LoadOptions::other_columns).
struct OtherColumns {
  std::vector<Column> columns;
  bool has_adjusted_times = false;  ///< gps_time is adjusted GPS time, as LAS has it
};

/// The scans of one sensor of a rig.
struct CloudSensor {
  std::string name;
  std::size_t scans = 0;
  bool is_in_model = true;  ///< its points become part of models
  /// How far it moves within a scan if the points have no times and nothing shows that they are
  /// motion-compensated, m, with rotations seen at 10 m.
  double unknown_sweep_m = 0;
};

/// Points of one or many scans, as a structure of arrays. World coordinates are origin +
/// position: double at the border, float inside. An attribute is empty or as long as `positions`.
struct PointCloud {
  Vec3d origin;              ///< world coordinates of the local origin, m
  Crs crs;                   ///< of the world coordinates, as the files say it
  std::string label_scheme;  ///< of the classes, as load_label_scheme() takes it; empty: not known
  std::vector<Vec3f> positions;          ///< relative to `origin`, m; finite
  std::vector<Vec3f> sensor_positions;   ///< of the LiDAR when it measured the point, as positions
  std::vector<OriginKind> origin_kinds;  ///< of sensor_positions; empty: all are measured
  std::vector<float> intensities;        ///< as measured, in the unit of the file; NaN: not known
  std::vector<std::uint16_t> classes;    ///< semantic class ids of the label scheme
  std::vector<std::uint16_t> instances;  ///< instance ids, 0 = none
  std::vector<std::uint32_t> scan_indices;  ///< number of the scan the point is from
  std::vector<std::uint16_t> lasers;  ///< of the sensor, topmost 0; kNoLaser where it is not known
  /// Of the scans by their numbers, world_from_sensor; empty: not known. No attribute of points.
  Trajectory scan_poses;
  /// Of a rig: whose scans these are, in the order of their numbers. Empty: one sensor.
  std::vector<CloudSensor> sensors;
  /// Of the scans, where they were looked for (find_empty_beams()). No attribute of points.
  std::vector<EmptyBeam> empty_beams;
  OtherColumns others;

  std::size_t size() const { return positions.size(); }
  bool empty() const { return positions.empty(); }
  /// How the sensor position of a point is known.
  OriginKind origin_kind(std::size_t i) const {
    if (sensor_positions.empty()) return OriginKind::none;
    return origin_kinds.empty() ? OriginKind::measured : origin_kinds[i];
  }
  /// Whether the beam of any point is known: a stated or measured origin.
  bool has_beams() const;
  /// Whether all normals can be turned to the sensor.
  bool has_all_origins() const;
  Vec3d world(std::size_t i) const { return origin + vec_cast<double>(positions[i]); }
};

/// One attribute of points with all its names. of(cloud) is its array in a PointCloud, or in
/// another struct with members of the same names.
template <class Of>
struct PointAttribute {
  Of of;
  const char* name;    ///< of the member, in Python and in pickles
  const char* column;  ///< of the files of save_cloud_ply(); empty: saved with the positions
  const char* title;   ///< in messages
  int tie_rank;  ///< orders points at equal positions: the lowest rank counts first; 0, 1, 2, ...
  const char* about;  ///< meaning of the values, for Python
};
template <class Of>
PointAttribute(Of, const char*, const char*, const char*, int, const char*) -> PointAttribute<Of>;

/// Calls visit(PointAttribute) for every attribute except positions, in the order of files. A new
/// attribute needs a member and an entry here, and a member of gpu::DeviceCloud with the same name.
/// Code that copies or compares all attributes uses this function. These copy chosen ones by name:
/// points_of_classes(), the windows of calibrate_drives() and even_out() of a city's tiles.
template <class Visit>
void for_each_attribute(Visit&& visit) {
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.sensor_positions); },
                       "sensor_positions", "", "sensor positions", 4, "m, relative to origin"});
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.origin_kinds); },
                       "origin_kinds", "origin_kind", "kinds of origins", 5,
                       "source of sensor_positions: 0 unknown, 1 guessed, 2 stated, 3 measured"});
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.intensities); },
                       "intensities", "intensity", "intensities", 3,
                       "in the unit of the file, NaN if unknown"});
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.classes); }, "classes",
                       "label", "classes", 0, "ids of a label scheme"});
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.instances); }, "instances",
                       "instance", "instances", 1, "0 for none"});
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.scan_indices); },
                       "scan_indices", "scan_index", "scan numbers", 2,
                       "the scan that a point is from"});
  visit(PointAttribute{[](auto& cloud) -> decltype(auto) { return (cloud.lasers); }, "lasers",
                       "laser", "lasers", 6,
                       "the laser that measured a point, topmost 0; 65535 if unknown"});
}

/// The address of an attribute's values; null for one that a cloud lacks.
template <class Values>
auto data_or_null(const Values& values) {
  return values.empty() ? nullptr : values.data();
}

/// Number of points with an origin of each kind.
using OriginCounts = std::array<std::size_t, 4>;
OriginCounts count_origins(const PointCloud& cloud);
/// "measured", or "measured 812, not known 188": the kinds that occur; "no" if no point has an
/// origin.
std::string describe_origins(const OriginCounts& counts);

/// 8-bit RGB.
using ColorBytes = std::array<std::uint8_t, 3>;
/// Names of the columns of colours.
inline constexpr std::array<const char*, 3> kRgbColumns = {"red", "green", "blue"};

/// 8-bit colours from the columns red, green and blue; empty if one of them is missing or does not
/// have `rows` values. Values up to 255 are used as they are, whole numbers up to 65535 divided by
/// 256, fractions up to 1 multiplied by 255.
std::vector<ColorBytes> color_bytes(std::span<const Column> columns, std::size_t rows);
/// The same of the points of a cloud, from `others`.
inline std::vector<ColorBytes> file_colors(const PointCloud& cloud) {
  return color_bytes(cloud.others.columns, cloud.size());
}

/// Whether colours differ; files often have a column of black for colours that were not measured.
inline bool has_several(std::span<const ColorBytes> colors) {
  return std::ranges::any_of(colors, [&](const ColorBytes& c) { return c != colors.front(); });
}

/// The points of `cloud` with all attributes, in the order of `indices`; empty beams stay.
PointCloud gather(const PointCloud& cloud, std::span<const std::uint32_t> indices);

/// Removes the points and empty beams of sensors that are not part of models.
void keep_sensors_of_model(PointCloud& cloud);

/// Adds `other` behind `cloud`. Both need the same origin and the same set of attributes
/// (std::logic_error otherwise; an empty `cloud` takes all from `other`). The poses of other's
/// scans follow; where one of them has none, there are none. The coordinate system is that of
/// `cloud`: whoever joins files compares them (SharedCrs).
void append(PointCloud& cloud, PointCloud&& other);

/// The origin for coordinates within [low, high]: zero where floats hold them to 0.1 mm (1 km
/// around zero), else the middle rounded to a whole kilometre. Depends on the box alone, so the
/// order of points does not matter.
Vec3d choose_origin(Vec3d low, Vec3d high);

}  // namespace adasplats
