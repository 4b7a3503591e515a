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

/// How a scan is laid out as an image: rows by elevation from the top, columns by azimuth,
/// clockwise seen from above, from the rear. The numbers are those that LiDAR4D (Zheng et al., CVPR
/// 2024) has for KITTI-360, in its data/preprocess/generate_rangeview.py.
struct PanoramaLayout {
  std::uint32_t rows = 66;
  std::uint32_t columns = 1030;
  double top_rad = 2.0 * kDegree;    ///< elevation of the first row
  double span_rad = 26.9 * kDegree;  ///< from there to where a row below the last would be
  double max_range_m = 80;           ///< points at this range or beyond are left out

  std::size_t pixels() const { return std::size_t{rows} * columns; }
};

/// Pixels row by row.
struct Panorama {
  std::vector<float> ranges_m;     ///< from the origin of the scan's frame; 0: no return
  std::vector<float> intensities;  ///< in the unit of the points; 0 without return
};

/// Lays out points (sensor frame, m): each in the pixel whose direction is nearest, the nearest
/// point of a pixel counts. Points outside, not finite or at the origin are left out, and, as in
/// the code of LiDAR4D, those within half a pixel of the rear's seam on its far side.
/// `intensities`: one a point, or none.
Panorama panorama_of(std::span<const Vec3f> points, std::span<const float> intensities,
                     const PanoramaLayout& layout);

/// The points that the pixels with a return stand for, sensor frame, m.
std::vector<Vec3f> points_of(const Panorama& image, const PanoramaLayout& layout);

/// The sensor whose rays are the pixels: a ring a row, all at once, all from one point, without
/// noise.
LidarModel sensor_of(const PanoramaLayout& layout);

}  // namespace adasplats
