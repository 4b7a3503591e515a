// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/words.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Order of the points of a scan in the files of a data set.
enum class PointOrder : std::uint8_t {
  kitti,   ///< as the data set's own files: kitti_order(), of others driver_order()
  firing,  ///< as the sensor model lists its firings (firings_of())
};
inline constexpr std::pair<std::string_view, PointOrder> kPointOrders[] = {
    {"kitti", PointOrder::kitti}, {"firing", PointOrder::firing}};
inline Words<PointOrder> words_of(PointOrder) { return kPointOrders; }

/// The indices of the points of a scan in the order of KITTI's .bin files: ring by ring from the
/// top, each counter-clockwise from azimuth 0 (straight ahead), regardless of the sensor's
/// direction of rotation. KITTI's files have no ring numbers; readers find rings where azimuths
/// pass from below 0 to above ("scan unfolding", Triess et al. 2020, "Scan-based Semantic
/// Segmentation of LiDAR Point Clouds: An Experimental Study"). This recovers the rings of this
/// order if each has points on both sides of azimuth 0 and points are as measured (the ends of a
/// deskewed sweep can overlap behind). Returns of one firing keep their order. Scans of sensors
/// that do not rotate steadily, such as rosette scanners, keep the order of their firings. Needs
/// positions and rings, and return_indices if a firing can have several returns (std::logic_error
/// without rings).
std::vector<std::uint32_t> kitti_order(const ScanView& scan);

/// The scan with its points, and all their attributes, in that order: every point once.
Scan reordered(const ScanView& scan, std::span<const std::uint32_t> order);

}  // namespace adasplats
