// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace adasplats {

/// The 32 categories of nuScenes-lidarseg (nuscenes_labels()) by their indices, which its devkit
/// has colours for; others it refuses.
std::span<const std::string_view> nuscenes_categories();

/// The index of the category that a class of a label scheme is, by the words of its name
/// ("moving-car" is vehicle.car), or the very one: noise for what has no label, static.other where
/// no word fits.
std::uint8_t nuscenes_category(std::string_view class_name);

}  // namespace adasplats
