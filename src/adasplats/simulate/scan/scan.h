// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/ray_drop.h"
#include "adasplats/simulate/scan/returns.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "adasplats/simulate/scan/weather.h"
#include "adasplats/splats/reflectance/reflectance.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Attributes of primitives; each but the log odds is empty or has one value per primitive.
struct PrimitiveAttributes {
  std::span<const std::uint16_t> classes;
  std::span<const std::uint16_t> instances;
  std::span<const float> intensities;  ///< reflectances if there is a `response`
  /// For the incidence angle; primitives beyond the view are assumed perpendicular to the beam.
  SceneView view;
  const IntensityResponse* response = nullptr;
  std::span<const float> drop_log_odds;  ///< as in SplatModel; those past the end: 0
};

/// Frame of the points of a scan during which the sensor moves.
enum class PointFrame : std::uint8_t {
  raw,       ///< sensor frame at the time of each point, as reported by sensors
  deskewed,  ///< sensor frame at the scan's reference pose: motion-compensated
};
inline constexpr std::pair<std::string_view, PointFrame> kPointFrames[] = {
    {"raw", PointFrame::raw}, {"deskewed", PointFrame::deskewed}};
inline Words<PointFrame> words_of(PointFrame) { return kPointFrames; }

/// One revolution of one LiDAR: the returns, by firing in the order of `firings_of`, and within a
/// firing in the order of the sensor's reports.
struct Scan {
  RigidTransform world_from_sensor;
  double time_s = 0;  ///< of that pose: the middle of the revolution if the sensor moved
  /// Motion during the revolution, as in ScanMotion; empty and 0 at rest.
  std::vector<RigidTransform> knots;
  double duration_s = 0;
  PointFrame frame = PointFrame::raw;
  std::size_t rays = 0;          ///< number of firings; size() is the number of returns
  std::vector<Vec3f> positions;  ///< sensor frame, m
  std::vector<float> ranges_m;
  std::vector<float> intensities;        ///< empty if the scene has none
  std::vector<std::uint16_t> classes;    ///< empty if the scene has none
  std::vector<std::uint16_t> instances;  ///< empty if the scene has none
  std::vector<std::uint16_t> rings;
  std::vector<std::uint32_t> columns;
  std::vector<float> times_s;  ///< since the start of the revolution
  /// 0 for the first reported return of a firing; empty if firings have at most one return.
  std::vector<std::uint8_t> return_indices;

  /// Returns.
  std::size_t size() const;
};

/// The requested attributes. The others are not computed; their arrays are empty.
struct ScanFields {
  bool positions = true;
  bool ranges = true;
  bool intensities = true;
  bool classes = true;
  bool instances = true;
  bool rings = true;
  bool columns = true;
  bool times = true;
  bool return_indices = true;
};

/// nvcc warns of a member of this type that is declared without the alias.
using WantedField = bool ScanFields::*;

/// One attribute of returns with all its names; of(scan) is its array.
template <class Of>
struct ScanAttribute {
  Of of;
  WantedField wanted;
  const char* name;    ///< in Python and in pickles
  const char* column;  ///< of scan_columns(); arrays of NPZ files have its plural
  bool is_optional;    ///< not every scan has it
  const char* about;   ///< meaning of the values
};
template <class Of>
ScanAttribute(Of, WantedField, const char*, const char*, bool, const char*) -> ScanAttribute<Of>;

/// Calls visit(ScanAttribute) for every attribute except positions, in the order of files. A new
/// attribute needs a member, a field, an entry here, and the code that computes it.
template <class Visit>
void for_each_scan_attribute(Visit&& visit) {
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.intensities); },
                      &ScanFields::intensities, "intensities", "intensity", true,
                      "in the unit of the scene's intensities"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.classes); },
                      &ScanFields::classes, "classes", "label", true,
                      "ids of the scene's label scheme"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.instances); },
                      &ScanFields::instances, "instances", "instance", true, "0 for none"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.rings); }, &ScanFields::rings,
                      "rings", "ring", false, "0 the topmost"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.columns); },
                      &ScanFields::columns, "columns", "column", false, "azimuth steps"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.times_s); },
                      &ScanFields::times, "times", "time", false, "s since the revolution began"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.ranges_m); },
                      &ScanFields::ranges, "ranges", "range", false, "m"});
  visit(ScanAttribute{[](auto& scan) -> decltype(auto) { return (scan.return_indices); },
                      &ScanFields::return_indices, "return_indices", "return_index", true,
                      "0 for the first that the sensor reports of a firing"});
}

/// Fields by the names of attributes, and "positions". Errors: usage (an unknown name, with the
/// known names).
ScanFields scan_fields(std::span<const std::string> names);

/// Keeps the points with a set flag keep[i], in every attribute.
Scan kept_points(const Scan& scan, std::span<const std::uint8_t> keep);

/// Options of the measurement of a sensor.
struct SimulateOptions {
  std::uint64_t seed = 1;       ///< of noise, drop, weather; drawn by (seed, scan index, firing)
  bool noise = true;            ///< apply the sensor's noise and its calibrated intensity response
  bool sensor_offsets = false;  ///< apply LidarModel::range_offsets_m
  BeamOptions beam;
  std::optional<RayDropModel> ray_drop;  ///< none: every echo is reported
  bool vehicle_body = true;              ///< returns from LidarModel::body
  PointFrame frame = PointFrame::raw;
  Weather weather;
  ScanFields fields;  ///< attributes that are wanted
};

/// Ray data of a sensor as floats, one per firing: begin, end and time.
std::vector<FiringRay> firing_rays(const LidarModel& sensor, std::span<const Firing> firings);

/// The rays of one revolution in the frame of a scene with local origin `scene_origin`, one per
/// firing, between the sensor's minimum and maximum range.
std::vector<Ray> scan_rays(const LidarModel& sensor, std::span<const Firing> firings,
                           const ScanMotion& motion, Vec3d scene_origin, const Executor& executor);

/// The scan from the hits of its rays: hits[(i * sub_rays + s) * depth + k] of firings[i], within
/// the sensor's range (BeamOptions; the rays are those of sub_firings()). Finds the returns, drops
/// some, adds noise and weather, and gathers the attributes of the primitives. `scan_index` selects
/// the random numbers. Throws std::logic_error if the number of hits per firing is wrong, or an
/// attribute does not have one value per primitive. For many scans see scan_caster.h.
Scan scan_of_hits(std::span<const Hit> hits, const PrimitiveAttributes& attributes,
                  const LidarModel& sensor, std::span<const Firing> firings,
                  const ScanMotion& motion, std::uint64_t scan_index,
                  const SimulateOptions& options, const Executor& executor);

/// Casts one revolution in a scene with local origin `scene_origin`. Paper section "Firing Sequence
/// Simulation". For many scans see scan_caster.h.
Scan simulate_scan(const Tracer& tracer, const PrimitiveAttributes& attributes, Vec3d scene_origin,
                   const LidarModel& sensor, std::span<const Firing> firings,
                   const ScanMotion& motion, std::uint64_t scan_index,
                   const SimulateOptions& options, const Executor& executor);

}  // namespace adasplats
