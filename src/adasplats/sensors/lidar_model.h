// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/divergence.h"
#include "adasplats/sensors/packet_layout.h"
#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/sensors/unit_fields.h"
#include "adasplats/sensors/unit_intensity.h"
#include "adasplats/sensors/vehicle_body.h"

namespace adasplats {

/// The sensor where a user names none: the HDL-64 as the paper describes it.
inline constexpr const char* kDefaultSensor = "hdl-64-paper";

/// One emitted ray of one revolution, in the sensor frame.
struct Firing {
  Vec3f direction;       ///< unit length
  std::uint16_t ring;    ///< beam number, 0 = topmost
  std::uint32_t column;  ///< azimuth step
  float time_s;          ///< since the start of the revolution
  Vec3f origin;          ///< where the beam leaves, m; zero for a sensor that is one point
};

/// Two wedge prisms that turn: a pattern that does not repeat from scan to scan.
struct RosettePattern {
  double prism_hz[2] = {0, 0};          ///< turns a second, signed
  double deflection_rad[2] = {0, 0};    ///< of each prism
  double points_per_s = 0;              ///< of all lasers
  std::vector<double> laser_tilts_rad;  ///< elevations of the lasers before the prisms; empty: {0}
};

/// A rotating LiDAR: which rays one revolution holds. Never sees a scene.
/// Azimuth counter-clockwise from +x, elevation up from the xy-plane.
struct LidarModel {
  std::string name;
  std::vector<double> elevations_rad;       ///< one a beam, topmost first
  std::vector<double> azimuth_offsets_rad;  ///< one a beam, or empty for zero
  /// Where each beam leaves in the frame of the turning head (x towards the head's azimuth, z up),
  /// one a beam, or empty for zero.
  std::vector<Vec3d> beam_origins_m;
  /// When each beam fires after its column began, s; one a beam, or empty for zero. The head turns
  /// on meanwhile.
  std::vector<double> firing_times_s;
  /// What each ring of this very unit measures beside the range: to be added to what it reports.
  /// One a ring, or empty for zero. Simulated only where that is asked for (SimulateOptions).
  std::vector<double> range_offsets_m;
  /// Standard deviation of the noise of each ring of this unit; instead of range_noise_m where not
  /// empty.
  std::vector<double> ring_noise_m;
  /// What this unit makes of intensities; without: they are reported as the scene has them.
  std::optional<UnitIntensity> intensity;
  /// How what this unit measures is alike in neighbouring beams; without: each beam by itself.
  std::optional<UnitFields> fields;
  /// Which beams this unit loses; without: none.
  std::optional<RayDropModel> drop;
  /// Its returns from what carries it; without: none.
  std::optional<VehicleBody> body;
  /// How its packets are laid out; without: none are known.
  std::optional<PacketLayout> packets;
  std::uint32_t columns = 0;     ///< azimuth steps a revolution
  double first_azimuth_rad = 0;  ///< of the head when a revolution begins
  double rotation_hz = 10.0;     ///< revolutions, or scans of a free pattern, a second
  double min_range_m = 0.0;
  double max_range_m = 120.0;
  double range_noise_m = 0.0;       ///< standard deviation of white noise on the range
  double angular_noise_rad = 0.0;   ///< the same on the azimuth and elevation that are reported
  double range_resolution_m = 0.0;  ///< ranges are multiples of it; 0: any
  /// Full angles of the beam between 1/e^2 of the axis' intensity, horizontal and vertical, rad; 0:
  /// not known. Whatever the source states was converted by full_e2_angle_rad().
  double divergence_rad[2] = {0, 0};
  DivergenceKind divergence_kind = DivergenceKind::unknown;  ///< what the source states
  int max_returns = 1;                    ///< echoes that the sensor reports of a firing
  bool clockwise = false;                 ///< seen from above
  std::vector<Firing> free_pattern;       ///< used instead of beams x columns where not empty
  std::optional<RosettePattern> rosette;  ///< used instead of both where it is there
  std::string source;                     ///< where the numbers are from: manual and page, or file

  std::size_t rays_per_scan() const;
  std::size_t rings() const;
};

/// The rays of one revolution ring by ring (neighbours in azimuth side by side: a laser row), or
/// the free pattern as it stands. Paper section "Firing Sequence Rays Generation". `scan_index`
/// counts the scans of a sensor whose pattern does not repeat (repeats()); others ignore it.
std::vector<Firing> firings_of(const LidarModel& model, std::uint64_t scan_index = 0);

/// Whether every scan has the same firings.
bool repeats(const LidarModel& model);

/// Velodyne HDL-64 as in paper section "Velodyne HDL-64": 64 beams from +2.0 to -24.8 degrees, both
/// included, 2250 columns, 120 m.
LidarModel hdl_64_paper();
/// Velodyne HDL-32 as in paper section "Velodyne HDL-32": 32 beams from +10.67 to -30.67 degrees,
/// both included, 1800 columns, 100 m.
LidarModel hdl_32_paper();

/// A name of the library (lidar_model_names()) or a file, known by its extension, else by what
/// it holds; docs/sensors.md has the keys:
/// - TOML: beams or a rosette, or `like` another sensor;
/// - JSON: metadata of an Ouster sensor as it writes them;
/// - YAML: a Velodyne calibration of the ROS driver; CSV: Hesai's angles, with the firing times
///   beside them; both have the rest from the sensor of the library with as many beams;
/// - CSV of rays: azimuth_deg, elevation_deg[, time_s[, ring]].
/// Beams are sorted, topmost first; those that skip columns come as a free pattern.
/// Errors: usage (unknown name, with the nearest known), no_input, config (TOML: unknown key, with
/// line), data (anything wrong in the other formats).
LidarModel load_lidar_model(const std::string& name_or_path);

/// Names that load_lidar_model knows.
std::vector<std::string> lidar_model_names();

/// "unknown sensor 'vlp-16', did you mean 'velodyne-vlp-16'?", or all names and then `or_else`.
std::string unknown_lidar_model(const std::string& name, const std::string& or_else = "");

}  // namespace adasplats
