// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/image.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// A quantity of the surface that each pixel shows.
enum class ImageLayer : std::uint8_t {
  depth,      ///< distance along the axis of the camera, m
  range,      ///< distance along the ray, m
  class_id,   ///< class of the label scheme
  normal,     ///< unit normal in world axes, towards the camera
  primitive,  ///< index of the splat in the model, or of the triangle
};

inline constexpr std::pair<std::string_view, ImageLayer> kImageLayers[] = {
    {"depth", ImageLayer::depth},
    {"range", ImageLayer::range},
    {"class", ImageLayer::class_id},
    {"normal", ImageLayer::normal},
    {"splat", ImageLayer::primitive}};

/// Layers of one picture, rows from the top; those that were not wanted are empty. Pixels without a
/// hit are NaN or -1.
struct LayerImages {
  int width = 0, height = 0;
  std::vector<float> depth_m, range_m;
  std::vector<float> normals;  ///< x, y, z of each pixel
  std::vector<std::int32_t> classes, primitives;
  std::uint64_t unlit_pixels = 0;  ///< pixels that the lens shows nothing in
};

/// Casts one ray through the centre of every pixel. The values do not depend on the number of
/// threads. Errors: usage (classes of a scene without classes), those of check_image().
LayerImages cast_layers(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
                        std::span<const ImageLayer> wanted, const Executor& executor);

/// Metres as whole millimetres of a 16-bit PNG; 0 without a hit.
struct Millimetres {
  std::vector<std::uint16_t> values;
  std::uint64_t clipped = 0;  ///< values beyond 65.535 m, written as 65535, or not above 0
};
Millimetres millimetres_of(std::span<const float> metres);

}  // namespace adasplats
