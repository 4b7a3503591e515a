// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/ray.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/image/frame.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// Two pixels on opposite sides of one, and their distance from it.
struct PixelPair {
  std::int32_t dx = 0, dy = 0;
  float distance_px = 1;
};

/// Parameters for developing a frame into a picture, passed to kernels by value.
struct Developer {
  static constexpr int kScales = 3, kDirections = 4;

  Developer(const Camera& camera, const ImageOptions& options);

  CameraRays camera;
  bool parallel = false;
  float px_per_m = 1;  ///< pinhole: at a depth of 1 m
  int samples = 1;     ///< per pixel
  Vec3f background;
  bool sky = true;
  bool relief = true;
  PixelPair pairs[kScales * kDirections];
  std::int32_t hole_px = 1;  ///< openings with surfaces nearer than this around are holes
};

namespace developing {

/// Colour of openings between surfaces: dark, like windows and gaps by day.
inline constexpr Vec3f kHole = {0.13F, 0.14F, 0.18F};

ADASPLATS_HD inline Vec3f background_color(const Developer& with, Vec3f direction) {
  if (!with.sky) return with.background;
  constexpr Vec3f kZenith = {0.47F, 0.66F, 0.88F};
  constexpr Vec3f kNadir = {0.80F, 0.81F, 0.82F};
  const float up = direction.z;
  const float share = std::sqrt(std::fabs(up));  // most of the change is near the horizon
  return (1.0F - share) * with.background + share * (up > 0.0F ? kZenith : kNadir);
}

ADASPLATS_HD inline bool inside(const FrameView& frame, std::int32_t x, std::int32_t y) {
  return x >= 0 && y >= 0 && x < frame.width && y < frame.height;
}

ADASPLATS_HD inline std::int64_t place(const FrameView& frame, std::int32_t x, std::int32_t y) {
  return static_cast<std::int64_t>(y) * frame.width + x;
}

/// Result of the pixels around one pixel.
struct Surroundings {
  float shadow = 0;  ///< 0: open, 1: deep in a corner
  Vec3f color;       ///< mean of the pixel and those on the same surface
};

/// Height of the pixels of a pair above the one between them, m: 0 on any plane, on which nearness
/// is linear. -infinity if one of them is empty.
ADASPLATS_HD inline float rise_m(const Developer& with, float nearness, float before,
                                 float behind) {
  const float bend = 0.5F * (before + behind) - nearness;
  return with.parallel ? bend : bend / (nearness * nearness);
}

/// Share of the light that a pair occludes from the pixel between, 0..1; it grows with the slope.
ADASPLATS_HD inline float shadow_of(float rise_m, float distance_m, bool finest) {
  constexpr float kNoise_m = 0.02F;  // steps from splat to splat of one surface
  constexpr float kNoise = 0.06F;    // and slopes
  constexpr float kFarAbove = 2.0F;  // a steeper surface is in front of the pixel, not next to it
  const float slope = (rise_m - kNoise_m) / distance_m - kNoise;
  if (!(slope > 0.0F)) return 0.0F;
  const float shadow = slope / (1.0F + slope);
  const float share = kFarAbove / slope;
  return finest || share > 1.0F ? shadow : shadow * share * share;
}

/// Light that the surroundings occlude from a surface (after Boucheny 2009, "Eye-dome lighting";
/// Luft et al. 2006, "Image enhancement by unsharp masking the depth buffer"), at three scales:
/// edges of objects, joints between them, and corners of rooms. Also its colour: if the pixels of a
/// pair are on the surface of the one between, all three are averaged, so splats blend over about
/// half of their radius.
ADASPLATS_HD inline Surroundings look_around(const Developer& with, const FrameView& frame,
                                             std::int32_t x, std::int32_t y) {
  constexpr float kWeights[Developer::kScales] = {0.45F, 0.30F, 0.25F};
  constexpr float kSame_m = 0.03F, kSame = 0.25F;  // rise and slope within one surface
  const std::int64_t center = place(frame, x, y);
  const float nearness = frame.nearness[center], splat_px = frame.splat_px[center];
  const float m_per_px = with.parallel ? 1.0F / with.px_per_m : 1.0F / (nearness * with.px_per_m);
  Surroundings found;
  found.color = 1.0F / static_cast<float>(frame.hits[center]) * frame.colors[center];
  float weight = 1.0F;
  for (int scale = 0; scale < Developer::kScales; ++scale) {
    float shadow = 0.0F;
    for (int direction = 0; direction < Developer::kDirections; ++direction) {
      const PixelPair pair = with.pairs[scale * Developer::kDirections + direction];
      if (!inside(frame, x - pair.dx, y - pair.dy) || !inside(frame, x + pair.dx, y + pair.dy))
        continue;
      const std::int64_t step = place(frame, pair.dx, pair.dy);
      const float rise =
          rise_m(with, nearness, frame.nearness[center - step], frame.nearness[center + step]);
      const float distance_m = pair.distance_px * m_per_px;
      shadow += shadow_of(rise, distance_m, scale == 0);
      const float blend = splat_px / (2.0F * pair.distance_px);
      if (blend > 0.1F && std::fabs(rise) < kSame_m + kSame * distance_m) {
        const float share = blend < 1.0F ? blend : 1.0F;
        found.color =
            found.color +
            share / static_cast<float>(frame.hits[center - step]) * frame.colors[center - step] +
            share / static_cast<float>(frame.hits[center + step]) * frame.colors[center + step];
        weight += 2.0F * share;
      }
    }
    found.shadow += kWeights[scale] / static_cast<float>(Developer::kDirections) * shadow;
  }
  found.color = 1.0F / weight * found.color;
  return found;
}

/// Distance in pixels from (x, y) to the next non-empty pixel in one direction; `most` + 1: none.
ADASPLATS_HD inline std::int32_t gap(const FrameView& frame, std::int32_t x, std::int32_t y,
                                     std::int32_t dx, std::int32_t dy, std::int32_t most) {
  for (std::int32_t step = 1; step <= most; ++step) {
    x += dx;
    y += dy;
    if (!inside(frame, x, y)) break;
    if (frame.hits[place(frame, x, y)] > 0) return step;
  }
  return most + 1;
}

/// Degree (0..1) to which a pixel is a hole: surfaces nearby on all sides.
ADASPLATS_HD inline float hole_at(const Developer& with, const FrameView& frame, std::int32_t x,
                                  std::int32_t y) {
  constexpr int kSides = 8, kLeast = 7;
  constexpr std::int32_t kTowards[kSides][2] = {{0, -1}, {0, 1},  {-1, 0},  {1, 0},
                                                {-1, 1}, {1, -1}, {-1, -1}, {1, 1}};
  int closed = 0;
  for (int side = 0; side < kSides && side - closed <= kSides - kLeast; ++side) {
    const bool slanted = side >= 4;
    const std::int32_t most = slanted ? with.hole_px * 5 / 7 : with.hole_px;
    if (gap(frame, x, y, kTowards[side][0], kTowards[side][1], most) <= most) ++closed;
  }
  return closed < kLeast
             ? 0.0F
             : static_cast<float>(closed - kLeast + 1) / static_cast<float>(kSides - kLeast + 1);
}

}  // namespace developing

/// The colour of a pixel, the same on every backend: 0..1, or above. Pixels that the lens does not
/// light are black.
template <bool kWithLens>
ADASPLATS_HD inline Vec3f develop_pixel(const Developer& with, const FrameView& frame,
                                        std::int32_t x, std::int32_t y) {
  constexpr float kShadow = 2.6F;
  const std::int64_t at = developing::place(frame, x, y);
  const int hits = frame.hits[at];
  Vec3f sum;
  if (hits > 0) {
    sum = frame.colors[at];
    if (with.relief) {
      const developing::Surroundings around = developing::look_around(with, frame, x, y);
      sum = static_cast<float>(hits) / (1.0F + kShadow * around.shadow) * around.color;
    }
  }
  const int misses = with.samples - hits;
  if (misses > 0) {
    const Vec3f direction = kWithLens ? with.camera.lens_ray(x + 0.5, y + 0.5).direction
                                      : with.camera.plain_ray(x + 0.5, y + 0.5).direction;
    const bool is_lit = !(direction == Vec3f{});
    Vec3f behind = is_lit ? developing::background_color(with, direction) : Vec3f{};
    if (with.relief && is_lit) {
      const float hole = developing::hole_at(with, frame, x, y);
      behind = (1.0F - hole) * behind + hole * developing::kHole;
    }
    sum = sum + static_cast<float>(misses) * behind;
  }
  return 1.0F / static_cast<float>(with.samples) * sum;
}

/// The nearness (FramePixel) of a hit.
ADASPLATS_HD inline float nearness_of(const CameraRays& camera, const Ray& ray, float t) {
  if (camera.has_lens) return 1.0F / t;
  const Vec3d forward = camera.local_from_camera.rotation * Vec3d{1, 0, 0};
  const float depth_m = t * dot(ray.direction, vec_cast<float>(forward));
  return camera.pixel_m > 0 ? -depth_m : 1.0F / depth_m;
}

/// A channel of a pixel: 0..1 to 0..255, to the nearest.
ADASPLATS_HD inline std::uint8_t to_byte(float value) {
  const float clamped = value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
  return static_cast<std::uint8_t>(std::lround(255.0F * clamped));
}

}  // namespace adasplats
