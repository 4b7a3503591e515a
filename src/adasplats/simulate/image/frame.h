// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// Result of the samples of a pixel, before it is developed (developing.h).
struct FramePixel {
  Vec3f color;  ///< sum over the samples that hit something, 0..1 each
  /// Of the nearest hit; kNothingNear if no sample hit. Pinhole: 1 / depth along the view, 1/m;
  /// parallel rays: -depth, m. Either is linear in the picture over a plane. Lens: 1 / range, 1/m,
  /// which nearly is and has a value for every direction.
  float nearness = -std::numeric_limits<float>::infinity();
  float splat_px = 0;  ///< radius of a splat in the picture, otherwise 0
};
inline constexpr float kNothingNear = -std::numeric_limits<float>::infinity();

/// The pixels of a picture before they are developed, rows from the top: the members of FramePixel
/// as separate arrays, since most of the development reads only nearness. Pointers are memory of
/// the device that reads them.
struct FrameView {
  const Vec3f* colors = nullptr;
  const float* nearness = nullptr;
  const float* splat_px = nullptr;
  const std::uint16_t* hits = nullptr;  ///< samples of the pixel that hit something
  std::int32_t width = 0, height = 0;
};

/// Owns the data of a FrameView.
struct Frame {
  Frame(int columns, int rows)
      : width(columns),
        height(rows),
        colors(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)),
        nearness(colors.size(), kNothingNear),
        splat_px(colors.size(), 0.0F),
        hits(colors.size(), 0) {}

  FrameView view() const {
    return {colors.data(), nearness.data(), splat_px.data(), hits.data(), width, height};
  }
  void set(std::size_t i, const FramePixel& pixel, std::uint16_t samples_hit) {
    colors[i] = pixel.color;
    nearness[i] = pixel.nearness;
    splat_px[i] = pixel.splat_px;
    hits[i] = samples_hit;
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }

  int width, height;
  std::vector<Vec3f> colors;
  std::vector<float> nearness, splat_px;
  std::vector<std::uint16_t> hits;
};

struct Developer;

/// Develops a frame into a picture: develop_pixel() for every pixel. The bytes do not depend on the
/// number of threads.
Image develop(const Frame& frame, const Developer& developer, const Executor& executor);

}  // namespace adasplats
