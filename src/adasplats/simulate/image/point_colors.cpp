// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/point_colors.h"

#include <cmath>
#include <type_traits>

#include "adasplats/core/error.h"
#include "adasplats/simulate/image/class_colors.h"
#include "adasplats/simulate/image/color_map.h"

namespace adasplats {
namespace {

constexpr Rgb kNeutral = {184, 184, 184};

Rgb viridis_rgb(float share) { return rgb_of(viridis(share)); }

std::vector<Rgb> by_class(const PointCloud& cloud, const LabelScheme& labels) {
  std::vector<Rgb> of_class;
  for (const SemanticClass& known : labels.classes()) {
    if (known.id >= of_class.size()) of_class.resize(known.id + std::size_t{1}, kNeutral);
    if (known.rgb != kNoClassColor) of_class[known.id] = known.rgb;
  }
  std::vector<Rgb> colors(cloud.size(), kNeutral);
  for (std::size_t i = 0; i < cloud.classes.size(); ++i)
    if (cloud.classes[i] < of_class.size()) colors[i] = of_class[cloud.classes[i]];
  return colors;
}

/// By one value a point; grey where it is not finite.
std::vector<Rgb> by_value(const std::vector<float>& values, ValueRange range) {
  std::vector<Rgb> colors;
  colors.reserve(values.size());
  for (const float value : values)
    colors.push_back(std::isfinite(value)
                         ? viridis_rgb((value - range.low) / (range.high - range.low))
                         : kNeutral);
  return colors;
}

std::vector<Rgb> by_intensity(const PointCloud& cloud, ValueRange range) {
  if (cloud.intensities.empty()) return std::vector<Rgb>(cloud.size(), kNeutral);
  return by_value(cloud.intensities, range);
}

std::vector<float> heights_of(const PointCloud& cloud) {
  std::vector<float> heights;
  heights.reserve(cloud.size());
  for (const Vec3f p : cloud.positions) heights.push_back(p.z);
  return heights;
}

std::vector<Rgb> by_range(const PointCloud& cloud, Vec3d eye) {
  std::vector<Rgb> colors;
  colors.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto range_m = static_cast<float>(length(cloud.world(i) - eye));
    colors.push_back(viridis_rgb(1.0F - 0.5F * std::log10(range_m)));
  }
  return colors;
}

/// Whether values other than NaN differ.
template <class T>
bool has_several_values(std::span<const T> values) {
  const T* first = nullptr;
  for (const T& value : values) {
    if constexpr (std::is_floating_point_v<T>)
      if (std::isnan(value)) continue;
    if (first != nullptr && value != *first) return true;
    if (first == nullptr) first = &value;
  }
  return false;
}

}  // namespace

std::vector<Rgb> point_colors(const PointCloud& cloud, const LabelScheme* labels,
                              std::optional<ImageColor> color, Vec3d eye,
                              std::optional<ValueRange> range) {
  const ImageColor shown = color.value_or(default_color(cloud, labels));
  const ValueRange ends = range.value_or(shown_range(cloud, shown));
  switch (shown) {
    case ImageColor::shading: return std::vector<Rgb>(cloud.size(), kNeutral);
    case ImageColor::semantic:
      if (labels == nullptr || cloud.classes.empty())
        throw Error(ErrorKind::usage,
                    "points can be coloured by class only with classes and a label scheme");
      return by_class(cloud, *labels);
    case ImageColor::normal: throw Error(ErrorKind::usage, "a point cloud has no normals to show");
    case ImageColor::intensity: return by_intensity(cloud, ends);
    case ImageColor::range: return by_range(cloud, eye);
    case ImageColor::height: return by_value(heights_of(cloud), ends);
    case ImageColor::rgb: {
      std::vector<Rgb> colors = file_colors(cloud);
      if (colors.empty() && !cloud.empty())
        throw Error(ErrorKind::usage,
                    "points can be coloured by rgb only with columns red, green and blue");
      return colors;
    }
    case ImageColor::error: throw Error(ErrorKind::usage, "a point cloud has no errors to show");
  }
  return {};
}

ValueRange shown_range(const PointCloud& cloud, ImageColor color) {
  constexpr double kLow = 0.02, kHigh = 0.98;
  if (color == ImageColor::intensity) return quantile_range(cloud.intensities, kLow, kHigh);
  return color == ImageColor::height ? quantile_range(heights_of(cloud), kLow, kHigh)
                                     : ValueRange{};
}

ImageColor default_color(const PointCloud& cloud, const LabelScheme* labels) {
  if (has_several(file_colors(cloud))) return ImageColor::rgb;
  return default_color(cloud.classes, cloud.intensities, labels).value_or(ImageColor::height);
}

std::optional<ImageColor> default_color(std::span<const std::uint16_t> classes,
                                        std::span<const float> intensities,
                                        const LabelScheme* labels) {
  if (has_several_values(classes) && share_with_class_colors(classes, labels) >= kMaxHaveClasses)
    return ImageColor::semantic;
  if (has_several_values(intensities)) return ImageColor::intensity;
  return std::nullopt;
}

}  // namespace adasplats
