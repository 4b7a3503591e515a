// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace adasplats {

/// A sensor of the library: a file of the folder sensors/, embedded in the program.
struct LibraryLidar {
  std::string_view name;  ///< of the file, without .toml
  std::string_view toml;  ///< its content, including comments with the sources
};

/// All sensors, sorted by name. cmake/Sensors.cmake generates the definition.
std::span<const LibraryLidar> lidar_library();

}  // namespace adasplats
