// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace adasplats {

/// Effort of compression: filters for photographs, or none, which takes a quarter of the time and
/// for range images and classes no more bytes.
enum class PngEffort : bool { small, fast };

/// The bytes of the images below.
std::string png_bytes(int width, int height, std::span<const std::uint8_t> pixels,
                      PngEffort effort = PngEffort::small);
std::string png16_bytes(int width, int height, std::span<const std::uint16_t> levels,
                        PngEffort effort = PngEffort::small);

/// Writes an 8-bit RGB image, rows from the top, `pixels` of width * height * 3 bytes.
void write_png(const std::filesystem::path& path, int width, int height,
               std::span<const std::uint8_t> pixels);

/// Writes a 16-bit grey image, rows from the top, `levels` of width * height.
void write_png16(const std::filesystem::path& path, int width, int height,
                 std::span<const std::uint16_t> levels);

}  // namespace adasplats
