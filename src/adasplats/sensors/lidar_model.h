// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/calibrated_sensor.h"
#include "adasplats/sensors/packet_layout.h"
#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/sensors/vehicle_body.h"

namespace adasplats {

/// What a divergence in a data sheet measures: manufacturers use the word differently.
enum class DivergenceKind : std::uint8_t {
  unknown,  ///< a full angle at an unstated level; treated as full_e2
  fwhm,     ///< full angle at half the intensity of the axis
  full_e2,  ///< full angle at 1/e^2 of the intensity of the axis
  half_e2,  ///< half of full_e2: measured from the axis
};

/// The word for each kind, in sensor files and in Python.
inline constexpr std::pair<std::string_view, DivergenceKind> kDivergenceKinds[] = {
    {"fwhm", DivergenceKind::fwhm},
    {"1/e2", DivergenceKind::full_e2},
    {"1/e2-half", DivergenceKind::half_e2},
    {"unknown", DivergenceKind::unknown}};

/// Converts a stated divergence to LidarModel::divergence_rad, the full angle at 1/e^2 of the axis'
/// intensity. A Gaussian beam has the intensity exp(-2 r^2 / w^2) at radius r and half of it at
/// r = w sqrt(ln(2) / 2), so w = FWHM / sqrt(2 ln 2) = 0.849 FWHM and the full angle 2 w is 1.699
/// FWHM.
double full_e2_angle_rad(double stated_rad, DivergenceKind kind);

/// The default sensor: the HDL-64 as the paper describes it.
inline constexpr const char* kDefaultSensor = "hdl-64-paper";

/// One emitted ray of one revolution, in the sensor frame.
struct Firing {
  Vec3f direction;       ///< unit length
  std::uint16_t ring;    ///< beam number, 0 = topmost
  std::uint32_t column;  ///< azimuth step
  float time_s;          ///< since the start of the revolution
  Vec3f origin;          ///< where the beam starts, m; zero if all beams share one origin
};

/// Two rotating wedge prisms: a pattern that does not repeat from scan to scan.
struct RosettePattern {
  double prism_hz[2] = {0, 0};          ///< turns a second, signed
  double deflection_rad[2] = {0, 0};    ///< of each prism
  double points_per_s = 0;              ///< of all lasers
  std::vector<double> laser_tilts_rad;  ///< elevations of the lasers before the prisms; empty: {0}
};

/// A rotating LiDAR: the rays of one revolution, independent of any scene.
/// Azimuth counter-clockwise from +x, elevation up from the xy-plane.
struct LidarModel {
  std::string name;
  std::vector<double> elevations_rad;       ///< one a beam, topmost first
  std::vector<double> azimuth_offsets_rad;  ///< one a beam, or empty for zero
  /// Origin of each beam in the frame of the rotating head (x towards the head's azimuth, z up);
  /// one a beam, or empty for zero.
  std::vector<Vec3d> beam_origins_m;
  /// Firing time of each beam after the start of its column, s; one a beam, or empty for zero. The
  /// head rotates meanwhile.
  std::vector<double> firing_times_s;
  // Properties of a calibrated sensor. Offsets are simulated only on request (SimulateOptions).
  /// Range offset of each ring, to be added to reported ranges; one a ring, or empty for zero.
  std::vector<double> range_offsets_m;
  /// Standard deviation of the range noise of each ring; replaces range_noise_m if not empty.
  std::vector<double> ring_noise_m;
  /// Response of this sensor; without it intensities are reported as the scene has them.
  std::optional<SensorIntensity> intensity;
  /// Correlation between neighbouring beams; without it beams are independent.
  std::optional<SensorFields> fields;
  /// Ray drop; without it no beam is lost.
  std::optional<RayDropModel> drop;
  /// Returns from the sensor's own vehicle; without it none.
  std::optional<VehicleBody> body;
  /// Layout of its UDP packets, if it is supported.
  std::optional<PacketLayout> packets;
  /// The profile of an Ouster's packets if it is not supported; else empty.
  std::string packet_profile;
  std::uint32_t columns = 0;     ///< azimuth steps a revolution
  double first_azimuth_rad = 0;  ///< of the head when a revolution begins
  /// Beams fire from this share of a revolution to that one; the first can be larger: the window
  /// contains the end of the revolution.
  double window_begin = 0, window_end = 1;
  double rotation_hz = 10.0;  ///< revolutions, or scans of a free pattern, a second
  double min_range_m = 0.0;
  double max_range_m = 120.0;
  double range_noise_m = 0.0;       ///< standard deviation of white noise on the range
  double angular_noise_rad = 0.0;   ///< the same on the reported azimuth and elevation
  double range_resolution_m = 0.0;  ///< ranges are multiples of it; 0: any
  /// Full angles of the beam at 1/e^2 of the axis' intensity, horizontal and vertical, rad; 0:
  /// unknown. Readers convert the value of the source with full_e2_angle_rad().
  double divergence_rad[2] = {0, 0};
  DivergenceKind divergence_kind = DivergenceKind::unknown;  ///< of the value in the source
  int max_returns = 1;                                       ///< reported echoes per firing
  bool clockwise = false;                                    ///< seen from above
  std::vector<Firing> free_pattern;  ///< replaces beams x columns if not empty
  /// Duration of the free pattern, s. If it exceeds a scan, each scan continues it where the one
  /// before ended. 0: every scan has all its rays.
  double pattern_s = 0;
  std::optional<RosettePattern> rosette;  ///< replaces both
  std::string source;                     ///< of the numbers: manual and page, or file

  std::size_t rays_per_scan() const;
  std::size_t rings() const;
  bool has_window() const { return window_begin != 0 || window_end != 1; }
  bool fires_in(std::uint32_t column) const;
};

/// The rays of one revolution ring by ring in the order of azimuth, or the free pattern unchanged.
/// Paper section "Firing Sequence Rays Generation". `scan_index` matters only to sensors with a
/// pattern that does not repeat (repeats()).
std::vector<Firing> firings_of(const LidarModel& model, std::uint64_t scan_index = 0);

/// Whether every scan has the same firings.
bool repeats(const LidarModel& model);

/// Whether all rays fire at the same time (a flash), so that motion does not distort a scan.
bool fires_at_once(const LidarModel& model);

/// Velodyne HDL-64 as in paper section "Velodyne HDL-64": 64 beams from +2.0 to -24.8 degrees, both
/// included, 2250 columns, 120 m.
LidarModel hdl_64_paper();
/// Velodyne HDL-32 as in paper section "Velodyne HDL-32": 32 beams from +10.67 to -30.67 degrees,
/// both included, 1800 columns, 100 m.
LidarModel hdl_32_paper();

/// Loads a sensor of the library (lidar_model_names()) or a file. The extension, else the content,
/// decides the format; docs/sensors.md lists the keys:
/// - TOML: beams or a rosette, or `like` another sensor;
/// - JSON: the metadata that an Ouster sensor writes;
/// - YAML or XML: a Velodyne calibration; CSV: Hesai's angles, with firing times from the file next
///   to them; the model with such beams supplies the rest; DAT: Hesai's angles of an AT128;
/// - CSV of rays: azimuth_deg, elevation_deg[, time_s[, ring]]; or Livox's tables, 10 scans a
///   second: Time/s, Azimuth/deg, Zenith/deg.
/// Beams are sorted, topmost first; beams that skip columns become a free pattern.
/// Errors: usage (unknown name, with the nearest one), no_input, config (TOML: unknown key, with
/// line), data (errors in other formats).
LidarModel load_lidar_model(const std::string& name_or_path);

/// The sensor of an Ouster's metadata that are no file; `name` is its name, and begins messages.
/// Errors: data.
LidarModel ouster_lidar_model(std::string_view metadata, const std::string& name);

/// Names of the sensors in the library.
std::vector<std::string> lidar_model_names();

/// "unknown sensor 'vlp-16', did you mean 'velodyne-vlp-16'?"; without a near name, all names and
/// then `or_else`.
std::string unknown_lidar_model(const std::string& name, const std::string& or_else = "");

}  // namespace adasplats
