// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/random.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/vehicle_body.h"
#include "adasplats/simulate/scan/air.h"
#include "adasplats/simulate/scan/drop_chance.h"
#include "adasplats/simulate/scan/echoes.h"
#include "adasplats/simulate/scan/intensity_rules.h"
#include "adasplats/simulate/scan/scan_ray.h"
#include "adasplats/simulate/scan/unit_field_rules.h"
#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {

// The core of the scan simulation: the report of one firing, from the hits of its rays to points,
// with the same bytes on CPU and GPU. ScanRules (scan_rules.h) makes the rules.

/// Attributes of one primitive.
struct PrimitiveValues {
  Vec3f normal;           ///< {0, 0, 0}: unknown; incidence is assumed perpendicular
  float reflectance = 0;  ///< or intensity if there is no response; NaN: none
  std::uint16_t class_id = 0;
  std::uint16_t instance = 0;
  float drop_log_odds = 0;  ///< as in SplatModel
};
static_assert(sizeof(PrimitiveValues) == 24);

/// Rules for the reports of a sensor in a scene: plain values and pointers, of the host or a
/// device.
struct FiringRules {
  // the sensor
  const Firing* firings = nullptr;
  double rotation_hz = 0;
  float min_range_m = 0;
  float max_range_m = 0;
  double range_noise_m = 0;                 ///< 0: without noise
  double angular_noise_rad = 0;             ///< likewise
  double range_resolution_m = 0;            ///< likewise
  const double* range_offsets_m = nullptr;  ///< per ring; null: not applied
  std::uint32_t range_offset_count = 0;
  const double* ring_noise_m = nullptr;  ///< per ring, instead of range_noise_m; null: unknown
  std::uint32_t ring_noise_count = 0;
  IntensityRules intensity;
  UnitFieldRules fields;
  bool field_noise = false;  ///< range noise comes from the fields
  // the beam
  BeamOptions beam;
  const float* weights = nullptr;  ///< of sub-rays
  DropRules drop;
  const std::uint8_t* blocked = nullptr;  ///< of firings; null: none is
  const std::uint32_t* body_cells =
      nullptr;  ///< of firings, numbers in `body`, kNoBody; null: none
  const BodyCell* body = nullptr;
  AirRules air;
  // the scene
  const PrimitiveValues* primitives = nullptr;
  std::uint32_t primitive_count = 0;
  bool has_intensities = false;
  bool has_response = false;
  GainTable range_gain;
  GainTable incidence_gain;
  std::uint64_t seed = 0;
};

/// For firings that hit no cell of the vehicle's body.
inline constexpr std::uint32_t kNoBody = 0xffffffff;

/// Data of one scan.
struct ScanState {
  const ScanPose* knots = nullptr;  ///< scene from sensor, as rays are cast
  std::uint32_t knot_count = 0;
  /// Reference from sensor, one per knot; null: points stay in the sensor's frame at their time.
  const ScanPose* frame_knots = nullptr;
  std::uint64_t scan_index = 0;
  /// Normals of the range noise of the first returns of firings from `first_normal` on, all that
  /// are reported with this state; null: drawn one by one.
  const double* normals = nullptr;
  std::uint32_t first_normal = 0;
};

/// One return that a sensor reports.
struct ReportedReturn {
  float range_m = 0;
  std::uint32_t primitive = 0;  ///< Hit::kNone: a particle in the air
  float intensity = 0;
  std::uint16_t class_id = 0;
  std::uint16_t index = 0;  ///< among the firing's
};
static_assert(sizeof(ReportedReturn) == 16);

/// Purposes of random numbers; each has its own stream.
enum class Draw : std::uint64_t { range = 0, angles = 1, drop = 2, intensity = 3, body = 4 };

/// The stream of a purpose in a scan. The range noise of a firing's first return uses that of the
/// scan, for compatibility with earlier versions.
ADASPLATS_HD inline std::uint64_t stream_of(Draw what, std::uint64_t scan_index,
                                            std::uint32_t return_index) {
  return scan_index ^
         (static_cast<std::uint64_t>(what) << 56 | static_cast<std::uint64_t>(return_index) << 48);
}

/// Keyed by (seed, scan, firing) and purpose.
ADASPLATS_HD inline Random scan_draw(std::uint64_t seed, Draw what, std::uint64_t scan_index,
                                     std::uint32_t firing, std::uint32_t return_index) {
  return {seed, stream_of(what, scan_index, return_index), firing};
}

/// A different stream than that of the scan's own noise.
ADASPLATS_HD inline std::uint64_t weather_seed(std::uint64_t seed) {
  return Random::mix(seed ^ 0x7765617468657221ULL);
}

ADASPLATS_HD inline float share_of_revolution(const Firing& firing, double rotation_hz) {
  const double share = static_cast<double>(firing.time_s) * rotation_hz;
  return static_cast<float>(share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share);
}

ADASPLATS_HD inline FiringRay firing_ray(const Firing& firing, double rotation_hz) {
  return {firing.direction, share_of_revolution(firing, rotation_hz), firing.origin, 0};
}

/// Cosine of the incidence angle of the beam on the primitive, 0..1; 1 without a normal.
ADASPLATS_HD inline float cos_incidence_of(const FiringRules& rules, const ScanState& scan,
                                           const Firing& firing, Vec3f normal) {
  if (normal == Vec3f{}) return 1.0F;
  const Ray ray =
      scan_ray(scan.knots, scan.knot_count, firing_ray(firing, rules.rotation_hz), 0.0F, 0.0F);
  const float cosine = std::fabs(dot(ray.direction, normal));
  return cosine < 1.0F ? cosine : 1.0F;
}

ADASPLATS_HD inline bool in_range(const FiringRules& rules, float range_m) {
  return range_m > rules.min_range_m && range_m <= rules.max_range_m;
}

/// Rounds to a multiple of the sensor's resolution.
ADASPLATS_HD inline double quantised(const FiringRules& rules, double range_m) {
  const double step_m = rules.range_resolution_m;
  return step_m > 0 ? step_m * std::round(range_m / step_m) : range_m;
}

/// Standard deviation of ranges, m.
ADASPLATS_HD inline double range_noise_of(const FiringRules& rules, const Firing& firing) {
  return firing.ring < rules.ring_noise_count ? rules.ring_noise_m[firing.ring]
                                              : rules.range_noise_m;
}

/// The normal of the range noise of return `k` of a firing.
ADASPLATS_HD inline double range_normal(const FiringRules& rules, const ScanState& scan,
                                        std::uint32_t firing, std::uint32_t k) {
  if (k == 0 && scan.normals != nullptr) return scan.normals[firing - scan.first_normal];
  return scan_draw(rules.seed, Draw::range, scan.scan_index, firing, k).normal();
}

/// The report of return `k` of a firing in clear air; false: none. The intensity is NaN if the
/// scene has none.
ADASPLATS_HD inline bool measure_return(const FiringRules& rules, const ScanState& scan,
                                        std::uint32_t firing, const Return& echo, std::uint32_t k,
                                        ReportedReturn& reported) {
  const Firing& fired = rules.firings[firing];
  const bool known = echo.primitive < rules.primitive_count;
  const PrimitiveValues none{{}, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
  const PrimitiveValues values = known ? rules.primitives[echo.primitive] : none;
  float cosine = 1;
  if (rules.drop.on || rules.has_response)
    cosine = cos_incidence_of(rules, scan, fired, values.normal);
  const bool has_fields = rules.fields.bytes != nullptr;
  BeamFields fields;
  if (has_fields)
    fields = beam_fields(rules.fields, rules.seed, scan.scan_index, fired.ring, fired.column, k);
  if (rules.drop.on) {
    if (rules.blocked != nullptr && rules.blocked[firing] != 0) return false;
    const double drawn =
        has_fields ? fields.drop
                   : scan_draw(rules.seed, Draw::drop, scan.scan_index, firing, k).uniform();
    if (is_lost(rules.drop, echo.range_m, cosine, values.reflectance, values.drop_log_odds, drawn))
      return false;
  }
  auto range_m = static_cast<double>(echo.range_m);
  if (fired.ring < rules.range_offset_count) range_m -= rules.range_offsets_m[fired.ring];
  const double noise_m = range_noise_of(rules, fired);
  if (rules.field_noise)
    range_m += fields.noise_m;
  else if (noise_m > 0)
    range_m += noise_m * range_normal(rules, scan, firing, k);
  reported.range_m = static_cast<float>(quantised(rules, range_m));
  if (!in_range(rules, reported.range_m)) return false;
  reported.primitive = echo.primitive;
  reported.class_id = values.class_id;
  reported.intensity = values.reflectance;
  // Objects without a reflectance, such as inserted meshes, are reported with intensity 0.
  if (rules.has_intensities && !(values.reflectance == values.reflectance)) {
    reported.intensity = 0;
  } else if (rules.has_response) {
    reported.intensity *=
        gain_of(rules.range_gain, reported.range_m) * gain_of(rules.incidence_gain, cosine);
  }
  if (rules.intensity.on && values.reflectance == values.reflectance) {
    IntensityShares shares = {fields.zero, fields.intensity};
    if (!has_fields) {
      Random random = scan_draw(rules.seed, Draw::intensity, scan.scan_index, firing, k);
      shares.below = random.uniform();
      shares.zero = random.uniform();
    }
    reported.intensity = unit_intensity(rules.intensity, fired.ring, reported.intensity, shares);
  }
  return true;
}

/// Whether a firing ends on the vehicle that carries the sensor, and its report; none if out of
/// range.
ADASPLATS_HD inline bool meets_body(const FiringRules& rules, const ScanState& scan,
                                    std::uint32_t firing, ReportedReturn* out, int& count) {
  if (rules.body_cells == nullptr || rules.body_cells[firing] == kNoBody) return false;
  const BodyCell& cell = rules.body[rules.body_cells[firing]];
  Random random = scan_draw(rules.seed, Draw::body, scan.scan_index, firing, 0);
  if (!(random.uniform() < static_cast<double>(cell.share))) return false;
  const double noise_m = range_noise_of(rules, rules.firings[firing]) * random.normal();
  ReportedReturn reported;
  reported.range_m =
      static_cast<float>(quantised(rules, static_cast<double>(cell.range_m) + noise_m));
  reported.primitive = Hit::kNone;
  reported.intensity = rules.has_intensities ? converted(rules.intensity, cell.intensity)
                                             : std::numeric_limits<float>::quiet_NaN();
  count = 0;
  if (in_range(rules, reported.range_m)) out[count++] = reported;
  return true;
}

/// Applies weather to the `count` returns of one firing, in place, in three steps: a particle in
/// the air may return closer than the farthest of them; each is lost or attenuated; the sensor
/// reports some of the remaining ones, reordered if the particle is among them. Returns their
/// number. `noise_m`: range noise in clear air. kRoom: size of `returns`, greater than `count`.
template <int kRoom>
ADASPLATS_HD inline int in_air(const FiringRules& rules, ReportedReturn* returns, int count,
                               double noise_m, Random random) {
  const AirRules& air = rules.air;
  double end_m = count == 0 ? air.max_range_m : 0.0;
  for (int i = 0; i < count; ++i) {
    const auto range_m = static_cast<double>(returns[i].range_m);
    end_m = end_m > range_m ? end_m : range_m;
  }
  Speck speck;
  const bool has_speck = nearest_speck(air, end_m, random, speck);
  Return pulses[kRoom];        // NOLINT: filled as far as it is read
  ReportedReturn left[kRoom];  // NOLINT: likewise
  int left_count = 0;
  const auto add = [&](ReportedReturn one, double power) {
    insert_by_range(
        pulses, left_count,
        {one.range_m, static_cast<std::uint32_t>(left_count), static_cast<float>(power)});
    left[left_count++] = one;
  };
  for (int i = 0; i < count; ++i) {
    ReportedReturn one = returns[i];
    const auto range_m = static_cast<double>(one.range_m);
    const auto intensity = static_cast<double>(one.intensity);
    const double power = usable_reflectance(intensity / air.white_intensity) /
                         needed_reflectance(range_m, air.max_range_m);
    const bool lost = random.uniform() >= reported_share(air.extinction_per_m, range_m, power);
    const double normal = random.normal();
    if (lost) continue;
    const double through = exp_of(-2.0 * air.extinction_per_m * range_m);
    // Noise grows with the inverse root of the power: sigma exp(alpha r); sigma is already
    // included.
    const double sigma_m = noise_m * std::sqrt(expm1_of(2.0 * air.extinction_per_m * range_m));
    if (sigma_m > 0) {
      one.range_m = static_cast<float>(quantised(rules, range_m + sigma_m * normal));
      if (!in_range(rules, one.range_m)) continue;
    }
    one.intensity = converted(rules.intensity, static_cast<float>(intensity * through));
    add(one, power * through);
  }
  int kept = left_count;
  for (int i = 0; i < kept; ++i) returns[i] = left[i];
  if (has_speck) {
    const auto range_m = static_cast<float>(quantised(rules, speck.range_m));
    if (in_range(rules, range_m)) {
      const double reflectance = speck.power * needed_reflectance(speck.range_m, air.max_range_m);
      add({range_m, Hit::kNone, static_cast<float>(air.white_intensity * reflectance), 0, 0},
          speck.power);
    }
    kept = select_returns(pulses, left_count, rules.beam);
    for (int i = 0; i < kept; ++i) returns[i] = left[pulses[i].primitive];
  }
  for (int i = 0; i < kept; ++i) returns[i].index = static_cast<std::uint16_t>(i);
  return kept;
}

/// Maximum number of sub-rays of most beams: report_firing() needs less memory for them.
inline constexpr int kFewSubRays = 8;

/// The report of a firing from the hits of its rays, (&hits.of(firing))[ray * depth + k]: at most
/// rules.beam.returns returns, in the order of the sensor. `hits` contains the firing and, if edges
/// are needed, kMaxEdgeRun firings before and after it. kMost: at least the number of sub-rays.
/// `out` holds kMost + 1 returns.
template <int kMost>
ADASPLATS_HD inline int report_firing(const FiringRules& rules, const ScanState& scan,
                                      std::uint32_t firing, const ScanHits& hits,
                                      ReportedReturn* out) {
  int count = 0;
  if (meets_body(rules, scan, firing, out, count)) return count;
  const auto class_of = [&](std::uint32_t primitive) -> std::uint16_t {
    return primitive < rules.primitive_count ? rules.primitives[primitive].class_id : 0;
  };
  Return echoes[kMost];  // NOLINT: filled as far as it is read
  const bool lost = rules.drop.edges.on && lost_at_edge(rules.drop.edges, rules.firings, hits,
                                                        rules.seed, scan.scan_index, firing);
  const int echo_count =
      lost ? 0
           : firing_returns<kMost>(&hits.of(firing), rules.weights, rules.beam, class_of, echoes);
  for (int k = 0; k < echo_count; ++k) {
    ReportedReturn& reported = out[count];
    if (!measure_return(rules, scan, firing, echoes[k], static_cast<std::uint32_t>(k), reported))
      continue;
    reported.index = static_cast<std::uint16_t>(count++);
  }
  if (rules.air.is_clear()) return count;
  return in_air<kMost + 1>(rules, out, count, range_noise_of(rules, rules.firings[firing]),
                           Random(weather_seed(rules.seed), scan.scan_index, firing));
}

/// The firing's direction with the sensor's angular noise.
ADASPLATS_HD inline Vec3f reported_direction(const FiringRules& rules, const ScanState& scan,
                                             std::uint32_t firing) {
  const Vec3f direction = rules.firings[firing].direction;
  if (!(rules.angular_noise_rad > 0)) return direction;
  const Vec3d d = vec_cast<double>(direction);
  Random random = scan_draw(rules.seed, Draw::angles, scan.scan_index, firing, 0);
  const double left = rules.angular_noise_rad * random.normal();
  const double up = rules.angular_noise_rad * random.normal();
  const double flat = std::sqrt(d.x * d.x + d.y * d.y);
  // Left is undefined for a vertical direction: any direction will do.
  const Vec3d to_left = flat > 0 ? Vec3d{-d.y / flat, d.x / flat, 0} : Vec3d{0, 1, 0};
  return vec_cast<float>(normalized(d + left * to_left + up * cross(d, to_left)));
}

/// The reported position of a return, m.
ADASPLATS_HD inline Vec3f reported_position(const FiringRules& rules, const ScanState& scan,
                                            std::uint32_t firing, float range_m) {
  const Firing& fired = rules.firings[firing];
  const Vec3f direction = reported_direction(rules, scan, firing);
  if (scan.frame_knots == nullptr) return fired.origin + range_m * direction;
  const FiringRay beam{direction, share_of_revolution(fired, rules.rotation_hz), fired.origin, 0};
  const Ray ray = scan_ray(scan.frame_knots, scan.knot_count, beam, 0.0F, 0.0F);
  return ray.origin + range_m * ray.direction;
}

}  // namespace adasplats
