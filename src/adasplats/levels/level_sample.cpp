// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_sample.h"

#include <algorithm>
#include <cmath>

namespace adasplats {
namespace {

constexpr double kMax16 = 65535;
constexpr float kMax15 = 32767;

/// Maps 0..1 to 0..max.
template <class T>
T quantized(double share, double max) {
  return static_cast<T>(std::lround(std::clamp(share, 0.0, 1.0) * max));
}

std::uint16_t position_code(float value, float low, float high) {
  const double size = static_cast<double>(high) - static_cast<double>(low);
  if (!(size > 0)) return 0;
  return quantized<std::uint16_t>((static_cast<double>(value) - static_cast<double>(low)) / size,
                                  kMax16);
}

double share_of(float value, ByteRange range) {
  const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
  return (static_cast<double>(value) - low) / (high - low);
}

std::uint8_t intensity_byte(float value, ByteRange range) {
  return quantized<std::uint8_t>(share_of(value, range), 255);
}

/// 0: unknown.
std::uint8_t error_byte(float value, ByteRange range) {
  if (std::isnan(value)) return 0;
  return static_cast<std::uint8_t>(1 + quantized<std::uint8_t>(share_of(value, range), 254));
}

}  // namespace

OctahedralNormal octahedral(Vec3f normal) {
  const float size = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
  if (!(size > 0)) return {0, 0};
  float x = normal.x / size, y = normal.y / size;
  if (normal.z < 0) {
    const float folded_x = (1 - std::fabs(y)) * (x < 0 ? -1.0F : 1.0F);
    y = (1 - std::fabs(x)) * (y < 0 ? -1.0F : 1.0F);
    x = folded_x;
  }
  const auto code = [](float v) {
    return static_cast<std::int16_t>(std::lround(std::clamp(v, -1.0F, 1.0F) * kMax15));
  };
  return {code(x), code(y)};
}

Vec3f normal_of(OctahedralNormal code) {
  float x = static_cast<float>(code.u) / kMax15, y = static_cast<float>(code.v) / kMax15;
  const float z = 1 - std::fabs(x) - std::fabs(y);
  if (z < 0) {
    const float unfolded_x = (1 - std::fabs(y)) * (x < 0 ? -1.0F : 1.0F);
    y = (1 - std::fabs(x)) * (y < 0 ? -1.0F : 1.0F);
    x = unfolded_x;
  }
  return normalized(Vec3f{x, y, z});
}

std::vector<LevelElement> encode(std::span<const LevelSample> samples, ByteRange intensities,
                                 ByteRange errors_m, LevelNode& node) {
  node.count = static_cast<std::uint32_t>(samples.size());
  if (samples.empty()) return {};
  node.low = node.high = samples.front().position;
  for (const LevelSample& sample : samples) {
    node.low = min(node.low, sample.position);
    node.high = max(node.high, sample.position);
    node.largest_radius_m = std::max(node.largest_radius_m, sample.radius_m);
  }
  std::vector<LevelElement> elements;
  elements.reserve(samples.size());
  for (const LevelSample& sample : samples) {
    LevelElement element{};
    for (int axis = 0; axis < 3; ++axis)
      element.position[axis] =
          position_code(sample.position[axis], node.low[axis], node.high[axis]);
    if (sample.radius_m > 0)
      element.radius =
          std::max<std::uint16_t>(1, position_code(sample.radius_m, 0, node.largest_radius_m));
    const OctahedralNormal normal = octahedral(sample.normal);
    element.normal[0] = normal.u;
    element.normal[1] = normal.v;
    element.class_id = sample.class_id;
    element.intensity = intensity_byte(sample.intensity, intensities);
    element.error = error_byte(sample.error_m, errors_m);
    elements.push_back(element);
  }
  return elements;
}

std::vector<LevelColor> encode_colors(std::span<const LevelSample> samples) {
  std::vector<LevelColor> colors;
  colors.reserve(samples.size());
  for (const LevelSample& sample : samples) {
    LevelColor color = {0, 0, 0, 255};
    for (int k = 0; k < 3; ++k)
      color[static_cast<std::size_t>(k)] =
          quantized<std::uint8_t>(static_cast<double>(sample.color[k]) / 255, 255);
    colors.push_back(color);
  }
  return colors;
}

}  // namespace adasplats
