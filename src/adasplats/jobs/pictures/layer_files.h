// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/simulate/image/layers.h"

namespace adasplats {

/// The layers of a list such as "depth,class"; none for "". Errors: usage.
std::vector<ImageLayer> layers_of(const std::string& list);

/// The files of a picture's layers: PICTURE.LAYER.npy, and PICTURE.LAYER.png for those that a
/// 16-bit PNG holds (depth, range, class). `picture`: the picture's file.
std::vector<std::filesystem::path> layer_files(const std::filesystem::path& picture,
                                               const std::vector<ImageLayer>& layers);

/// Writes them. Returns how many depths and ranges the PNG do not hold (Millimetres::clipped).
std::uint64_t write_layers(const std::filesystem::path& picture, const LayerImages& images);

}  // namespace adasplats
