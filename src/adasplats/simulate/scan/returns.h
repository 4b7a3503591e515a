// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/maths/ray.h"
#include "adasplats/core/setting.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// The echoes of a firing that a sensor reports.
enum class ReturnMode : std::uint8_t { first, last, strongest };
inline constexpr std::pair<std::string_view, ReturnMode> kReturnModes[] = {
    {"strongest", ReturnMode::strongest}, {"first", ReturnMode::first}, {"last", ReturnMode::last}};
inline Words<ReturnMode> words_of(ReturnMode) { return kReturnModes; }

/// The rays of a firing, and the rules by which its echoes become returns.
struct BeamOptions {
  /// Number of hits per ray: 1, or the paper's D = 5; their weighted mean is the echo (section
  /// "SimKITTI32").
  int depth = 1;
  /// Maximum distance between consecutive hits of a ray that are averaged, m (paper: 10 cm).
  double depth_gap_m = 0.1;
  /// Number of rays over the cross-section of the beam (LidarModel::divergence_rad): 1, or the axis
  /// and others around it.
  int sub_rays = 1;
  /// Echoes of sub-rays of one class that are closer than this are one return, m. A receiver can
  /// separate half the length of a 5 ns pulse, about 0.75 m.
  double separation_m = 0.75;
  int returns = 1;  ///< maximum number of returns per firing
  ReturnMode mode = ReturnMode::strongest;

  std::size_t hits_per_firing() const {
    return static_cast<std::size_t>(depth) * static_cast<std::size_t>(sub_rays);
  }
};

/// Maximum number of hits per ray and of rays per firing: returns_of() does not use the heap.
inline constexpr int kMaxDepth = 64;
inline constexpr std::size_t kMaxSubRays = 64;

template <class Visit>
void visit_settings(BeamOptions& beam, Visit&& visit) {
  constexpr const char* kGroup = "Beams and returns";
  visit(
      Setting{
          .name = "depth",
          .help = "Number of splats along a ray that are averaged into an echo (the paper's D = 5)",
          .value = "D",
          .group = kGroup,
          .min = 1,
          .max = kMaxDepth},
      beam.depth);
  visit(Setting{.name = "depth_gap",
                .help = "Maximum distance between consecutive splats of a ray that are averaged, m",
                .value = "M",
                .key = "depth_gap_m",
                .group = kGroup,
                .min = 0,
                .max = std::numeric_limits<double>::infinity()},
        beam.depth_gap_m);
  visit(Setting{.name = "sub_rays",
                .help = "Number of rays per beam, spread over its cross-section",
                .value = "N",
                .group = kGroup,
                .min = 1,
                .max = kMaxSubRays,
                .basic = true},
        beam.sub_rays);
  visit(Setting{.name = "separation",
                .help = "Minimum distance between returns, m; closer echoes are merged",
                .value = "M",
                .key = "separation_m",
                .group = kGroup,
                .min = 0,
                .max = std::numeric_limits<double>::infinity()},
        beam.separation_m);
  visit(Setting{.name = "returns",
                .help = "Maximum number of returns per firing",
                .value = "N",
                .group = kGroup,
                .min = 1,
                .max = kMaxSubRays},
        beam.returns);
  visit(
      Setting{
          .name = "return_mode", .help = "Which echo is reported first, or alone", .group = kGroup},
      beam.mode);
}

/// One reported echo.
struct Return {
  float range_m = 0;            ///< along the firing's axis
  std::uint32_t primitive = 0;  ///< with the largest contribution
  float energy = 0;             ///< returned share of the beam, 0..1
};

/// Errors: usage (a setting out of range; 2 sub-rays, which cannot be distributed evenly around the
/// axis; sub-rays of a sensor without a divergence).
void check_beam(const BeamOptions& options, const LidarModel& sensor);

/// The firings of `sensor` with `options.sub_rays` rays each, ray k of firing i at i * sub_rays +
/// k; ray 0 is the axis. The others are on rings of the ellipse with half the divergence as
/// semi-axes (the 1/e^2 radii of a Gaussian beam), with the weights of sub_ray_weights(). Errors:
/// those of check_beam().
std::vector<Firing> sub_firings(const LidarModel& sensor, std::span<const Firing> firings,
                                const BeamOptions& options);

/// Energy of each sub-ray of a beam with a Gaussian profile: an equal share of that of its annulus.
/// Their sum is 1.
std::vector<float> sub_ray_weights(const BeamOptions& options);

/// Moves those of `pulses` (ascending in range) that a sensor reports to the front, in the order of
/// the reports, at most options.returns; returns their number. first: from the nearest on; last:
/// from the farthest on; strongest: the strongest, then the last or, if that is the strongest, the
/// second strongest (dual return of the Velodyne VLP-16, user manual 63-9243 rev. D,
/// section 9.3.2), then by energy. Of equal ones, the nearer. A pulse within the separation of a
/// reported one is not reported (1 m for the VLS-128: manual 63-9483 rev. A, section 6.2.3).
std::size_t reported_returns(std::span<Return> pulses, const BeamOptions& options);

/// The returns of one firing from its hits, hits[ray * depth + k], ascending in k, in the order in
/// which the sensor reports them (reported_returns()). `classes`: of the primitives, or empty. At
/// most options.returns; `out` has that size. Never mixes hits of two classes or of two objects
/// that are apart: the range of a return is the mean of the echoes within depth_gap_m of its
/// first one, as a receiver triggers on the rising edge. Returns the number of returns. Throws
/// std::logic_error if a primitive has no class.
std::size_t returns_of(std::span<const Hit> hits, std::span<const float> weights,
                       std::span<const std::uint16_t> classes, const BeamOptions& options,
                       std::span<Return> out);

}  // namespace adasplats
