// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "adasplats/dataset/tree_boxes.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// lidar/NN.pkl.gz of PandaSet: x, y, z, i, t, d of the points; `order` lists their indices.
std::string pandaset_points(const ScanView& scan, std::span<const std::uint32_t> order);

/// annotations/semseg/NN.pkl.gz: their classes.
std::string pandaset_classes(const ScanView& scan, std::span<const std::uint32_t> order);

/// annotations/cuboids/NN.pkl.gz.
std::string pandaset_cuboids(std::span<const TreeBox> boxes);

}  // namespace adasplats
