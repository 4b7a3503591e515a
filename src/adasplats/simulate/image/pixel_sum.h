// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/simulate/image/developing.h"
#include "adasplats/simulate/image/frame.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {

/// Sum of the samples of one pixel, row by row on every backend, because the order determines the
/// last bit of a sum of floats.
struct PixelSum {
  FramePixel pixel;
  std::uint16_t hits = 0;

  ADASPLATS_HD void add(const ShadingTables& tables, const CameraRays& camera, const Ray& ray,
                        const Hit& hit) {
    if (!hit.valid()) return;
    pixel.color = pixel.color + shade(tables, ray, hit);
    const float nearness = nearness_of(camera, ray, hit.t);
    ++hits;
    if (!(nearness > pixel.nearness)) return;
    pixel.nearness = nearness;
    const float radius_m =
        hit.primitive < tables.disk_count ? tables.disks[hit.primitive].radius : 0.0F;
    pixel.splat_px = camera.pixel_m > 0 ? radius_m / static_cast<float>(camera.pixel_m)
                                        : radius_m * nearness * static_cast<float>(camera.focal_px);
  }
};

}  // namespace adasplats
