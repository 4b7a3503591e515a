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

/// In which order a file of a data set's tree has the points of a scan.
enum class PointOrder : std::uint8_t {
  kitti,   ///< as the data set's own files: kitti_order(), of others driver_order()
  firing,  ///< as the sensor model lists its firings (firings_of())
};
inline constexpr std::pair<std::string_view, PointOrder> kPointOrders[] = {
    {"kitti", PointOrder::kitti}, {"firing", PointOrder::firing}};
inline Words<PointOrder> words_of(PointOrder) { return kPointOrders; }

/// The points of a scan, by their numbers, as KITTI's .bin files have them: ring by ring from the
/// top, each counter-clockwise from azimuth 0 (straight ahead), whichever way the sensor turns.
/// KITTI's files hold no rings; readers find them where azimuths pass from below 0 to above ("scan
/// unfolding", Triess et al. 2020, "Scan-based Semantic Segmentation of LiDAR Point Clouds: An
/// Experimental Study"). That gives the rings of this order, where each has points on both sides of
/// azimuth 0 and points are as measured (deskewed ones of the ends of a sweep can overlap behind).
/// Returns of one firing stay in their order. Scans of sensors that do not turn steadily, as those
/// with rosettes, stay in the order of their firings. Needs positions and rings, and
/// return_indices where a firing can return twice (std::logic_error without rings).
std::vector<std::uint32_t> kitti_order(const ScanView& scan);

/// The scan with its points in that order: every point once, with all its attributes.
Scan reordered(const ScanView& scan, std::span<const std::uint32_t> order);

}  // namespace adasplats
