// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/sensors/vehicle_body.h"

namespace adasplats {

// A calibrated sensor: the properties of one physical device, as opposed to those of its type.

/// Number of quantiles of the reported intensity per level (texture_node()).
inline constexpr std::size_t kTextureNodes = 15;

/// How a calibrated sensor turns the intensity that a model of the scene predicts into the one that
/// it reports: gains of its lasers, returns with intensity zero, the scatter on surfaces of one
/// level, and the steps of its converter. SensorFields hold which beams report much and which
/// little. Fitted by fit_unit(). All values in the sensor's intensity unit.
struct SensorIntensity {
  double step = 0;     ///< values are multiples of it; 0: any
  double highest = 0;  ///< maximum reported value

  /// Predicted intensity -> level, per ring (topmost 0): `ring_nodes` ascending values of each,
  /// linear in between.
  std::size_t ring_nodes = 0;
  std::vector<float> ring_expected, ring_level;

  std::vector<float> levels;      ///< ascending; index of the two tables below
  std::vector<float> zero_share;  ///< per level: share of returns with intensity zero
  /// Per level, kTextureNodes quantiles of the other returns: the shares of texture_node() report
  /// at most this intensity.
  std::vector<float> reported;
};

/// The quantities that SensorFields hold for each beam.
enum class SensorField : std::uint8_t { drop = 0, intensity = 1, noise = 2, zero = 3 };
inline constexpr std::size_t kSensorFields = 4;

/// Some revolutions of a calibrated sensor: for each beam the quantile of its echo, intensity and
/// range among those that the model of the scene allows. They keep the correlation between
/// neighbouring beams, whatever its cause: patches of lost beams, the grain of surfaces, noisy
/// lasers. Fitted by fit_unit(). A simulated scan uses one of the revolutions, turned by some
/// columns (unit_field_rules.h): it has the texture of measured scans without their scene.
struct SensorFields {
  std::uint32_t turns = 0, rings = 0, columns = 0;
  /// Turn t, ring r (topmost 0) and column c: kSensorFields bytes from ((t * rings + r) * columns +
  /// c) * kSensorFields on.
  /// - drop: (b + 0.5)^2 / 2^16 of all echoes as likely to be lost are lost earlier than this
  /// - intensity: (b + 0.5) / 256 of all intensities of such surfaces that are not zero are lower
  /// - noise: (b - 128) |b - 128| / 127^2 of kMaxFieldNoise_m, on the range
  /// - zero: (b + 0.5)^2 / 2^16 of all returns as likely to report zero report it earlier
  std::vector<std::uint8_t> bytes;
};

inline constexpr double kMaxFieldNoise_m = 0.3;

/// Offsets of a calibrated sensor from the table of its type, per ring (topmost 0), to be added to
/// the values that it reports; rings past the end have none.
struct SensorOffsets {
  std::span<const double> range_m;
  std::span<const double> elevation_rad;
};

/// Other properties of a calibrated sensor (fit_unit()).
struct SensorTraits {
  std::span<const double> ring_noise_m;  ///< topmost first; empty: not measured
  std::optional<double> max_range_m;
  const SensorIntensity* intensity = nullptr;
  const SensorFields* fields = nullptr;
  const RayDropModel* drop = nullptr;
  const VehicleBody* body = nullptr;
  std::string fitted_to;  ///< description for the reader of the file
};

/// The file of a calibrated sensor of a type in the library (TOML, as load_lidar_model reads it):
/// the keys of the type with corrected elevations, and range_offsets_m. Elevations to 1e-5 degrees,
/// ranges to 0.01 mm. Errors: usage (unknown name); std::logic_error for a sensor without beams or
/// more offsets than beams.
std::string calibrated_sensor_toml(const std::string& library_name, const SensorOffsets& offsets,
                                   const SensorTraits& traits = {});

}  // namespace adasplats
