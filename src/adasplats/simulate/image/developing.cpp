// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/developing.h"

#include <algorithm>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

constexpr std::size_t kRowsPerChunk = 16;

/// Pairs at one scale; every other scale is rotated by half the angle between two pairs.
void fill_pairs(int scale, double radius_px, std::span<PixelPair> pairs) {
  constexpr double kQuarterTurn = 0.7853981633974483;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double angle = kQuarterTurn * (static_cast<double>(k) + 0.5 * (scale % 2));
    PixelPair& pair = pairs[k];
    pair.dx = static_cast<std::int32_t>(std::lround(radius_px * std::cos(angle)));
    pair.dy = static_cast<std::int32_t>(std::lround(radius_px * std::sin(angle)));
    pair.distance_px = static_cast<float>(std::hypot(pair.dx, pair.dy));
  }
}

template <bool kWithLens>
Image developed(const Frame& frame, const Developer& developer, const Executor& executor) {
  const FrameView view = frame.view();
  Image image{frame.width, frame.height, std::vector<std::uint8_t>(3 * frame.colors.size())};
  executor.for_chunks(static_cast<std::size_t>(frame.height), kRowsPerChunk,
                      [&](std::size_t begin, std::size_t end) {
                        std::uint8_t* out = &image.pixels[3 * frame.at(0, static_cast<int>(begin))];
                        for (std::size_t y = begin; y < end; ++y)
                          for (int x = 0; x < frame.width; ++x) {
                            const Vec3f color =
                                develop_pixel<kWithLens>(developer, view, x, static_cast<int>(y));
                            for (int channel = 0; channel < 3; ++channel)
                              *out++ = to_byte(color[channel]);
                          }
                      });
  return image;
}

}  // namespace

Developer::Developer(const Camera& from, const ImageOptions& options)
    : camera(from.rays({})),
      parallel(from.orthographic_width_m > 0),
      px_per_m(static_cast<float>(parallel ? 1.0 / camera.pixel_m : camera.focal_px)),
      samples(options.samples_per_axis * options.samples_per_axis),
      background(color_of(options.background)),
      sky(options.sky),
      relief(options.relief) {
  constexpr std::array<double, kScales> kRadii_px = {2, 7, 24};  // in a picture of 1440 rows
  const double size = from.height / 1440.0;
  for (int scale = 0; scale < kScales; ++scale) {
    const double radius_px =
        std::max(kRadii_px[static_cast<std::size_t>(scale)] * size, scale + 1.0);
    fill_pairs(
        scale, radius_px,
        std::span(pairs).subspan(static_cast<std::size_t>(scale) * kDirections, kDirections));
  }
  hole_px = std::max(2, static_cast<int>(std::lround(28 * size)));
}

Image develop(const Frame& frame, const Developer& developer, const Executor& executor) {
  return developer.camera.has_lens ? developed<true>(frame, developer, executor)
                                   : developed<false>(frame, developer, executor);
}

}  // namespace adasplats
