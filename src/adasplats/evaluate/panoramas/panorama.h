// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Layout of a scan as an image: rows by elevation from the top, columns by azimuth, clockwise seen
/// from above, from the rear. The numbers are those of LiDAR4D (Zheng et al., CVPR 2024) for
/// KITTI-360, in its data/preprocess/generate_rangeview.py.
struct PanoramaLayout {
  std::uint32_t rows = 66;
  std::uint32_t columns = 1030;
  double top_rad = 2.0 * kDegree;    ///< elevation of the first row
  double span_rad = 26.9 * kDegree;  ///< from there to a row below the last one
  double max_range_m = 80;           ///< points at this range or beyond are left out

  std::size_t pixels() const { return std::size_t{rows} * columns; }
};

/// Pixels row by row.
struct Panorama {
  std::vector<float> ranges_m;     ///< from the origin of the scan's frame; 0: no return
  std::vector<float> intensities;  ///< in the unit of the points; 0 without return
};

/// Projects points (sensor frame, m) to the pixel with the nearest direction; the nearest point of
/// a pixel counts. Points outside, not finite or at the origin are left out, and, as in the code of
/// LiDAR4D, those within half a pixel of the seam at the rear, on its far side. `intensities`: one
/// per point, or none.
Panorama panorama_of(std::span<const Vec3f> points, std::span<const float> intensities,
                     const PanoramaLayout& layout);

/// The points of the pixels with a return, sensor frame, m.
std::vector<Vec3f> points_of(const Panorama& image, const PanoramaLayout& layout);

/// The sensor with one ray per pixel: one ring per row, all rays at once and from one point,
/// without noise.
LidarModel sensor_of(const PanoramaLayout& layout);

}  // namespace adasplats
