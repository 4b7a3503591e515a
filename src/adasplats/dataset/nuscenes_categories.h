// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace adasplats {

/// The 32 categories of nuScenes-lidarseg (nuscenes_labels()) by index. Its devkit has colours for
/// these and rejects others.
std::span<const std::string_view> nuscenes_categories();

/// The index of the category of a class of a label scheme: the category itself, or one found from
/// the words of the class name ("moving-car" is vehicle.car); noise for unlabelled points,
/// static.other if no word matches.
std::uint8_t nuscenes_category(std::string_view class_name);

}  // namespace adasplats
