// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace adasplats {

/// A sensor of the library: a file of the folder sensors/, built in.
struct LibraryLidar {
  std::string_view name;  ///< the file's, without .toml
  std::string_view toml;  ///< what the file holds, comments with the sources included
};

/// All of them, by name. Made by cmake/Sensors.cmake.
std::span<const LibraryLidar> lidar_library();

}  // namespace adasplats
