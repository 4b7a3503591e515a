// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/point_image.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/image/developing.h"
#include "adasplats/simulate/image/frame.h"

namespace adasplats {
namespace {

constexpr std::size_t kPointsPerChunk = 1 << 14;
constexpr double kNearest_m = 0.05;  // closer to a pinhole, a point would fill the picture

/// What a pixel shows: the depth's bits above the point's index, so the smallest is the nearest
/// point, and of equally near ones the first. Bits of positive floats sort as they do.
using PixelKey = std::uint64_t;
constexpr PixelKey kNothing = ~PixelKey{0};

/// A point in the picture.
struct Projected {
  double u, v;      ///< pixels from the top left corner
  double depth_m;   ///< along the view; of a lens: the range
  double px_per_m;  ///< of something at that depth that faces the camera
};

/// The inverse of Camera::ray.
class Projection {
 public:
  Projection(const Camera& camera, Vec3d origin)
      : camera_from_local_(camera.world_from_camera.inverse() * RigidTransform{{}, origin}),
        width_(camera.width),
        height_(camera.height),
        focal_px_(0.5 * camera.width / std::tan(0.5 * camera.horizontal_fov_rad)),
        parallel_px_per_m_(
            camera.orthographic_width_m > 0 ? camera.width / camera.orthographic_width_m : 0.0),
        lens_(camera.lens) {}

  /// Nothing where the point is not finite, behind the camera, or not shown by its lens.
  std::optional<Projected> operator()(Vec3f position) const {
    const Vec3d p = camera_from_local_ * vec_cast<double>(position);
    if (lens_) return through_lens(p);
    const bool parallel = parallel_px_per_m_ > 0;
    if (!is_finite(p) || !(p.x > (parallel ? 0.0 : kNearest_m))) return std::nullopt;
    const double px_per_m = parallel ? parallel_px_per_m_ : focal_px_ / p.x;
    return Projected{0.5 * width_ - p.y * px_per_m, 0.5 * height_ - p.z * px_per_m, p.x, px_per_m};
  }

 private:
  /// As in pictures of models, the nearest is the one with the smallest range.
  std::optional<Projected> through_lens(Vec3d p) const {
    const double range_m = length(p);
    if (!is_finite(p) || !(range_m > kNearest_m)) return std::nullopt;
    const std::optional<Lens::Point> at = project(*lens_, {-p.y, -p.z, p.x});
    if (!at) return std::nullopt;
    return Projected{at->x + 0.5, at->y + 0.5, range_m, std::sqrt(lens_->fx * lens_->fy) / range_m};
  }

  RigidTransform camera_from_local_;
  double width_, height_, focal_px_;
  double parallel_px_per_m_;  ///< 0: a pinhole
  std::optional<Lens> lens_;
};

void put(PixelKey& pixel, PixelKey key) {
  std::atomic_ref<PixelKey> shared(pixel);
  PixelKey seen = shared.load(std::memory_order_relaxed);
  while (key < seen && !shared.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
  }
}

/// Draws into a buffer of keys; one object serves all threads.
class Canvas {
 public:
  Canvas(const Camera& camera, const PointImageOptions& options)
      : width_(camera.width),
        height_(camera.height),
        options_(options),
        keys_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNothing) {}

  void draw(const Projected& point, std::uint32_t index) {
    const double wanted_px = std::min(options_.point_size_m * point.px_per_m, 1e4);
    const int size =
        std::clamp(static_cast<int>(std::lround(wanted_px)), options_.min_px, options_.max_px);
    const double left = point.u - 0.5 * size;
    const double top = point.v - 0.5 * size;
    // Compared as doubles: the position of a point far outside does not fit an integer.
    if (!(left > -size - 1 && top > -size - 1 && left < width_ && top < height_)) return;
    const int first_x = static_cast<int>(std::lround(left));
    const int first_y = static_cast<int>(std::lround(top));
    const auto depth = static_cast<float>(point.depth_m);
    const PixelKey key = PixelKey{std::bit_cast<std::uint32_t>(depth)} << 32 | index;
    for (int y = std::max(first_y, 0); y < std::min(first_y + size, height_); ++y)
      for (int x = std::max(first_x, 0); x < std::min(first_x + size, width_); ++x)
        put(keys_[at(x, y)], key);
  }

  /// What the pixels show: one sample each.
  Frame frame(std::span<const Rgb> colors, bool parallel, const Executor& executor) const {
    Frame frame(width_, height_);
    executor.for_chunks(keys_.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (keys_[i] == kNothing) continue;
        const float depth_m = std::bit_cast<float>(static_cast<std::uint32_t>(keys_[i] >> 32));
        frame.set(i,
                  {color_of(colors[static_cast<std::uint32_t>(keys_[i])]),
                   parallel ? -depth_m : 1.0F / depth_m},
                  1);
      }
    });
    return frame;
  }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;
  const PointImageOptions& options_;
  std::vector<PixelKey> keys_;
};

void check(const Camera& camera) {
  constexpr int kMost = 1 << 15;
  const auto outside = [](int value) { return value < 1 || value > kMost; };
  if (outside(camera.width) || outside(camera.height))
    throw Error(ErrorKind::usage, "an image of " + std::to_string(camera.width) + " x " +
                                      std::to_string(camera.height) +
                                      " pixels; expected 1 to 32768 each");
}

}  // namespace

Image draw_points(std::span<const Vec3f> positions, Vec3d origin, std::span<const Rgb> colors,
                  const Camera& camera, const PointImageOptions& options,
                  const Executor& executor) {
  check(camera);
  if (colors.size() != positions.size())
    throw std::logic_error("a picture of points needs one colour per point");
  if (positions.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::logic_error("a picture of 2^32 points or more");
  const Projection project(camera, origin);
  Canvas canvas(camera, options);
  executor.for_chunks(positions.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const std::optional<Projected> point = project(positions[i]))
        canvas.draw(*point, static_cast<std::uint32_t>(i));
  });
  ImageOptions look;
  look.background = options.background;
  look.sky = options.sky;
  look.relief = options.relief;
  Developer developer(camera, look);
  developer.hole_px = 0;  // between points there are gaps everywhere
  return develop(canvas.frame(colors, developer.parallel, executor), developer, executor);
}

}  // namespace adasplats
