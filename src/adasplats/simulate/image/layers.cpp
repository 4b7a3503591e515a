// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/error.h"
#include "adasplats/simulate/image/shading.h"

namespace adasplats {

namespace {

// Rays are cast in blocks of 4 x 4 pixels, which meet nearly the same boxes of the tree.
constexpr std::size_t kPixelBlock = 4;
constexpr std::size_t kSlabRows = 256;  // rows, a multiple of a block

/// Fills rows of the layers; one object serves all threads.
class LayerCaster {
 public:
  LayerCaster(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
              std::span<const ImageLayer> wanted, const Executor& executor)
      : tracer_(tracer),
        executor_(executor),
        rays_of_(camera.rays(scene.origin)),
        forward_(vec_cast<float>(camera.world_from_camera.rotation * Vec3d{1, 0, 0})),
        shading_(scene, {}),
        width_(static_cast<std::size_t>(camera.width)),
        height_(static_cast<std::size_t>(camera.height)) {
    images_.width = camera.width;
    images_.height = camera.height;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const std::size_t count = width_ * height_;
    for (const ImageLayer layer : wanted) {
      switch (layer) {
        case ImageLayer::depth: images_.depth_m.assign(count, kNone); break;
        case ImageLayer::range: images_.range_m.assign(count, kNone); break;
        case ImageLayer::class_id: images_.classes.assign(count, -1); break;
        case ImageLayer::normal: images_.normals.assign(3 * count, kNone); break;
        case ImageLayer::primitive: images_.primitives.assign(count, -1); break;
      }
    }
  }

  LayerImages cast() {
    for (std::size_t top = 0; top < height_; top += kSlabRows)
      cast_slab(top, std::min(top + kSlabRows, height_));
    images_.unlit_pixels = unlit_;
    return std::move(images_);
  }

 private:
  /// Calls body(pixel) for the pixels of the rows [top, bottom), block by block.
  template <class Body>
  void for_each_pixel(std::size_t top, std::size_t bottom, Body&& body) const {
    for (std::size_t left = 0; left < width_; left += kPixelBlock)
      for (std::size_t y = top; y < bottom; ++y)
        for (std::size_t x = left; x < std::min(left + kPixelBlock, width_); ++x) body(x, y);
  }

  /// Casts the rays of many rows in one call, which a GPU needs.
  void cast_slab(std::size_t top, std::size_t bottom) {
    std::vector<Ray> rays((bottom - top) * width_);
    std::vector<Hit> hits(rays.size());
    const std::size_t bands = (bottom - top + kPixelBlock - 1) / kPixelBlock;
    const auto for_bands = [&](auto&& body) {
      executor_.for_chunks(bands, 1, [&](std::size_t band, std::size_t) {
        const std::size_t first = top + band * kPixelBlock;
        std::size_t i = band * kPixelBlock * width_;
        for_each_pixel(first, std::min(first + kPixelBlock, bottom),
                       [&](std::size_t x, std::size_t y) { body(x, y, i++); });
      });
    };
    for_bands([&](std::size_t x, std::size_t y, std::size_t i) {
      rays[i] = rays_of_.ray(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
    });
    tracer_.nearest(rays, hits, executor_);
    for_bands([&](std::size_t x, std::size_t y, std::size_t i) {
      if (hits[i].valid()) set(y * width_ + x, rays[i], hits[i]);
    });
    unlit_ += static_cast<std::uint64_t>(
        std::ranges::count_if(rays, [](const Ray& ray) { return ray.direction == Vec3f{}; }));
  }

  void set(std::size_t pixel, const Ray& ray, Hit hit) {
    if (!images_.depth_m.empty()) images_.depth_m[pixel] = hit.t * dot(ray.direction, forward_);
    if (!images_.range_m.empty()) images_.range_m[pixel] = hit.t;
    if (!images_.classes.empty()) images_.classes[pixel] = shading_.tables().classes[hit.primitive];
    if (!images_.primitives.empty())
      images_.primitives[pixel] = static_cast<std::int32_t>(hit.primitive);
    if (images_.normals.empty()) return;
    const Vec3f normal = shading::normal_towards(shading_.tables(), ray, hit.primitive);
    for (int axis = 0; axis < 3; ++axis)
      images_.normals[3 * pixel + static_cast<std::size_t>(axis)] = normal[axis];
  }

  const Tracer& tracer_;
  const Executor& executor_;
  CameraRays rays_of_;
  Vec3f forward_;
  Shading shading_;
  std::size_t width_, height_;
  LayerImages images_;
  std::uint64_t unlit_ = 0;
};

}  // namespace

LayerImages cast_layers(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
                        std::span<const ImageLayer> wanted, const Executor& executor) {
  check_image(camera, {});
  if (scene.attributes.classes.empty() &&
      std::ranges::find(wanted, ImageLayer::class_id) != wanted.end())
    throw Error(ErrorKind::usage, "the model has no classes for the layer class");
  return LayerCaster(tracer, scene, camera, wanted, executor).cast();
}

Millimetres millimetres_of(std::span<const float> metres) {
  constexpr double kMax = 65535;
  Millimetres result;
  result.values.reserve(metres.size());
  for (const float value : metres) {
    const double mm = std::round(1000.0 * static_cast<double>(value));
    if (mm > kMax || mm <= 0) ++result.clipped;  // not for NaN
    result.values.push_back(mm > 0 ? static_cast<std::uint16_t>(std::min(mm, kMax)) : 0);
  }
  return result;
}

}  // namespace adasplats
