// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// Input of the shading of a hit, in the memory of the device that shades it. Pointers are null if
/// the scene has no such values.
struct ShadingTables {
  const Disk* disks = nullptr;
  std::uint32_t disk_count = 0;
  const Vec3f* vertices = nullptr;
  const std::array<std::uint32_t, 3>* triangles = nullptr;
  const std::uint16_t* classes = nullptr;
  const SemanticGroup* groups = nullptr;
  const float* intensities = nullptr;
  const ColorBytes* colors = nullptr;   ///< as in the file
  const Vec3f* class_colors = nullptr;  ///< by class id; negative: none
  std::uint32_t class_color_count = 0;
  ImageColor color = ImageColor::semantic;
  ValueRange range;  ///< of intensities or heights, m relative to the scene's origin
};

namespace shading {

inline constexpr Vec3f kNeutral = {0.72F, 0.72F, 0.72F};

/// Muted colours that stay apart in greyscale.
ADASPLATS_HD inline Vec3f color_of(SemanticGroup group) {
  switch (group) {
    case SemanticGroup::ground: return {0.62F, 0.60F, 0.64F};
    case SemanticGroup::surface: return {0.90F, 0.76F, 0.55F};
    case SemanticGroup::linear: return {0.85F, 0.35F, 0.30F};
    case SemanticGroup::non_surface: return {0.42F, 0.66F, 0.36F};
  }
  return {0.72F, 0.72F, 0.72F};
}

/// Share of the light that a surface reflects. A lamp at the camera shows the shape; light from the
/// sky and a low sun distinguish ground, facades and the two sides of a street. Normals of clouds
/// have no reliable sign, so every term uses both sides.
ADASPLATS_HD inline float light(Vec3f normal, Vec3f view) {
  constexpr Vec3f kSun = {0.36F, 0.80F, 0.48F};
  constexpr float kAmbient = 0.22F, kHeadlight = 0.38F, kSkylight = 0.26F, kSunlight = 0.14F;
  const float sum = kAmbient + kHeadlight * std::fabs(dot(normal, view)) +
                    kSkylight * std::fabs(normal.z) + kSunlight * std::fabs(dot(normal, kSun));
  // To the power of 3/4, as screens show it: shadows stay readable. Square roots are exact
  // anywhere.
  return std::sqrt(sum * std::sqrt(sum));
}

ADASPLATS_HD inline Vec3f normal_towards(const ShadingTables& tables, const Ray& ray,
                                         std::uint32_t primitive) {
  Vec3f normal;
  if (primitive < tables.disk_count) {
    normal = tables.disks[primitive].normal;
  } else {
    const std::uint32_t* corner = &tables.triangles[primitive - tables.disk_count][0];
    const Vec3f a = tables.vertices[corner[0]];
    normal = cross(tables.vertices[corner[1]] - a, tables.vertices[corner[2]] - a);
    const float doubled_area = length(normal);
    // A sliver may have zero area in float and still be hit.
    normal = doubled_area > 0.0F ? normal / doubled_area : -ray.direction;
  }
  return dot(normal, ray.direction) > 0.0F ? -normal : normal;
}

ADASPLATS_HD inline Vec3f semantic_color(const ShadingTables& tables, std::uint32_t primitive) {
  if (tables.classes != nullptr) {
    const std::uint16_t id = tables.classes[primitive];
    if (id < tables.class_color_count && tables.class_colors[id].x >= 0.0F)
      return tables.class_colors[id];
  }
  return tables.groups == nullptr ? kNeutral : color_of(tables.groups[primitive]);
}

ADASPLATS_HD inline Vec3f color_in(ValueRange range, float value) {
  return viridis((value - range.low) / (range.high - range.low));
}

ADASPLATS_HD inline Vec3f intensity_color(const ShadingTables& tables, std::uint32_t primitive) {
  if (tables.intensities == nullptr) return kNeutral;
  const float intensity = tables.intensities[primitive];
  if (!(intensity - intensity == 0.0F)) return kNeutral;  // not finite
  return color_in(tables.range, intensity);
}

ADASPLATS_HD inline Vec3f file_color(const ShadingTables& tables, std::uint32_t primitive) {
  if (tables.colors == nullptr) return kNeutral;
  const std::uint8_t* rgb = &tables.colors[primitive][0];
  return {static_cast<float>(rgb[0]) / 255, static_cast<float>(rgb[1]) / 255,
          static_cast<float>(rgb[2]) / 255};
}

ADASPLATS_HD inline Vec3f error_color(const ShadingTables& tables, std::uint32_t primitive) {
  constexpr Vec3f kNotKnown = {0.59F, 0.59F, 0.59F};
  const float error = tables.intensities == nullptr ? 0.0F : tables.intensities[primitive];
  if (!(error - error == 0.0F)) return kNotKnown;  // not finite
  return signed_color((error - tables.range.low) / (tables.range.high - tables.range.low));
}

/// log10(x) of a normal number above 0, to a few units in the last place of a float. The library's
/// has other last bits on a GPU. x = m * 2^k with m around 1, and with s = (m - 1) / (m + 1)
/// ln(m) = 2 (s + s^3 / 3 + s^5 / 5 + ...).
ADASPLATS_HD inline float log10_anywhere(float x) {
  constexpr std::uint32_t kRootOfHalf = 0x3f3504f3U;  // as a float: m from here to the root of 2
  constexpr double kLn2 = 0.6931471805599453, kLn10 = 2.302585092994046;
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::int32_t k = static_cast<std::int32_t>(bits - kRootOfHalf) >> 23;
  const auto m =
      static_cast<double>(std::bit_cast<float>(bits - (static_cast<std::uint32_t>(k) << 23)));
  const double s = (m - 1) / (m + 1), s2 = s * s;
  const double ln_m = 2 * s * (1 + s2 * (1.0 / 3 + s2 * (1.0 / 5 + s2 * (1.0 / 7 + s2 / 9))));
  return static_cast<float>((k * kLn2 + ln_m) / kLn10);
}

}  // namespace shading

/// The colour of a surface hit by a ray, the same on every backend: 0..1, or above.
ADASPLATS_HD inline Vec3f shade(const ShadingTables& tables, const Ray& ray, const Hit& hit) {
  const Vec3f normal = shading::normal_towards(tables, ray, hit.primitive);
  switch (tables.color) {
    case ImageColor::rgb:
      return (0.5F + 0.5F * shading::light(normal, ray.direction)) *
             shading::file_color(tables, hit.primitive);
    case ImageColor::shading:
      return shading::light(normal, ray.direction) * Vec3f{0.92F, 0.92F, 0.92F};
    case ImageColor::semantic:
      return shading::light(normal, ray.direction) * shading::semantic_color(tables, hit.primitive);
    case ImageColor::normal: return 0.5F * (normal + Vec3f{1, 1, 1});
    case ImageColor::intensity:
      // The colour itself is the message: only a hint of the shape.
      return (0.5F + 0.5F * shading::light(normal, ray.direction)) *
             shading::intensity_color(tables, hit.primitive);
    case ImageColor::height:
      return (0.5F + 0.5F * shading::light(normal, ray.direction)) *
             shading::color_in(tables.range, ray.origin.z + hit.t * ray.direction.z);
    case ImageColor::error:
      return (0.5F + 0.5F * shading::light(normal, ray.direction)) *
             shading::error_color(tables, hit.primitive);
    case ImageColor::range: return viridis(1.0F - 0.5F * shading::log10_anywhere(hit.t));
  }
  return shading::kNeutral;
}

}  // namespace adasplats
