// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/maths/ray.h"
#include "adasplats/scene/scene.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

/// Spearman's rank correlation, equal values sharing the mean of their ranks; NaN for fewer than
/// two pairs or if one side does not vary. Throws std::logic_error if sizes differ.
double rank_correlation(std::span<const float> a, std::span<const float> b);

/// Of a beam to a disk or triangle, 0..1.
float cos_incidence(const SceneView& view, Vec3f direction, std::uint32_t primitive);

/// What the sensor of the model would measure where a ray hits; NaN: unknown.
float expected_intensity(const PrimitiveAttributes& scene, const Ray& ray, const Hit& hit);

/// 255 if a measured intensity is above 1, else 1.
double full_scale_of(std::span<const float> measured);

/// How well predicted intensities agree with measured ones, whatever their scales.
struct IntensityAgreement {
  std::size_t beams = 0;
  double rank_correlation = 0;  ///< NaN if one side does not vary
  /// Of the line through the pairs with the least squares, in units of full_scale_of(). NaN
  /// without beams.
  double rmse_after_fit = 0;
};

/// Throws std::logic_error if sizes differ.
IntensityAgreement intensity_agreement(std::span<const float> predicted,
                                       std::span<const float> measured);

}  // namespace adasplats
