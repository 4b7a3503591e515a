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

/// Which echoes of a firing a sensor reports.
enum class ReturnMode : std::uint8_t { first, last, strongest };
inline constexpr std::pair<std::string_view, ReturnMode> kReturnModes[] = {
    {"strongest", ReturnMode::strongest}, {"first", ReturnMode::first}, {"last", ReturnMode::last}};
inline Words<ReturnMode> words_of(ReturnMode) { return kReturnModes; }

/// What a firing sends out and how its echoes become returns.
struct BeamOptions {
  /// Hits kept of each ray: 1, or the paper's D = 5, whose weighted mean is the echo (section
  /// "SimKITTI32").
  int depth = 1;
  /// Of two hits of one ray that are farther apart than this the first counts alone, m (paper: 10
  /// cm).
  double depth_gap_m = 0.1;
  /// Rays over the cross-section of the beam (LidarModel::divergence_rad): 1, or the axis and more
  /// around it.
  int sub_rays = 1;
  /// Echoes of sub-rays less than this apart, and of one class, are one return, m: half the length
  /// of a 5 ns pulse, about 0.75 m, is what a receiver can separate.
  double separation_m = 0.75;
  int returns = 1;  ///< most returns a firing
  ReturnMode mode = ReturnMode::strongest;

  std::size_t hits_per_firing() const {
    return static_cast<std::size_t>(depth) * static_cast<std::size_t>(sub_rays);
  }
};

/// Most hits a ray and most rays a firing: returns_of() works without the heap.
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

/// One echo that a sensor reports.
struct Return {
  float range_m = 0;            ///< along the firing's axis
  std::uint32_t primitive = 0;  ///< that most of it is from
  float energy = 0;             ///< share of the beam that came back from there, 0..1
};

/// Errors: usage (a setting out of range; 2
/// sub-rays, which cannot stand evenly around the axis; sub-rays of a sensor without a divergence).
void check_beam(const BeamOptions& options, const LidarModel& sensor);

/// The firings of `sensor` with `options.sub_rays` rays each, ray k of firing i at i * sub_rays +
/// k; ray 0 is the axis. The others stand on rings of the ellipse whose semi-axes are half the
/// divergence (the 1/e^2 radii of a Gaussian beam), with the weights of sub_ray_weights(). Errors:
/// those of check_beam().
std::vector<Firing> sub_firings(const LidarModel& sensor, std::span<const Firing> firings,
                                const BeamOptions& options);

/// Energy in each sub-ray of a beam with a Gaussian profile, of the annulus that it stands in
/// shared evenly; their sum is 1.
std::vector<float> sub_ray_weights(const BeamOptions& options);

/// Those of `pulses` (ascending in range) that a sensor reports, moved to the front in the order in
/// which it reports them, at most options.returns; gives how many. first: from the nearest on;
/// last: from the farthest on; strongest: the strongest, then the last or, where that is the
/// strongest, the second strongest (dual return of the Velodyne VLP-16, user manual 63-9243 rev. D,
/// section 9.3.2), further ones by energy. Of equal ones the nearer. What lies within the
/// separation of a reported one is none of its own (of the VLS-128 it is 1 m: manual 63-9483 rev.
/// A, section 6.2.3).
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
