// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrays/png.h"

#include <png.h>

#include <stdexcept>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

std::size_t values_of(int width, int height, std::size_t channels) {
  if (width <= 0 || height <= 0) return 0;
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels;
}

/// `bytes`: size of all pixels in `format`.
std::string encoded_image(int width, int height, png_uint_32 format, std::size_t bytes,
                          const void* pixels, PngEffort effort) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  if (effort == PngEffort::fast) image.flags = PNG_IMAGE_FLAG_FAST;
  // The overhead of deflate for noise (5 bytes for 16 KiB) and of chunks (12 bytes for 8 KiB) is
  // below 1/64; libpng fails cleanly if the buffer is too small.
  const std::size_t raw_bytes = bytes + static_cast<std::size_t>(height);
  std::string encoded(raw_bytes + raw_bytes / 64 + 4096, '\0');
  png_alloc_size_t encoded_bytes = encoded.size();
  // libpng's simplified interface catches its own errors, so no longjmp crosses our frames.
  if (png_image_write_to_memory(&image, encoded.data(), &encoded_bytes, 0, pixels, 0, nullptr) == 0)
    throw Error(ErrorKind::software,
                "an image cannot be encoded as PNG: " + std::string(image.message));
  encoded.resize(encoded_bytes);
  return encoded;
}

}  // namespace

std::string png_bytes(int width, int height, std::span<const std::uint8_t> pixels,
                      PngEffort effort) {
  if (pixels.empty() || pixels.size() != values_of(width, height, 3))
    throw std::logic_error("png_bytes: pixels.size() is not width * height * 3");
  return encoded_image(width, height, PNG_FORMAT_RGB, pixels.size_bytes(), pixels.data(), effort);
}

std::string png16_bytes(int width, int height, std::span<const std::uint16_t> levels,
                        PngEffort effort) {
  if (levels.empty() || levels.size() != values_of(width, height, 1))
    throw std::logic_error("png16_bytes: levels.size() is not width * height");
  // libpng's "linear" format is 16 bits a channel, stored as they are.
  return encoded_image(width, height, PNG_FORMAT_LINEAR_Y, levels.size_bytes(), levels.data(),
                       effort);
}

void write_png(const std::filesystem::path& path, int width, int height,
               std::span<const std::uint8_t> pixels) {
  write_file(path, png_bytes(width, height, pixels));
}

void write_png16(const std::filesystem::path& path, int width, int height,
                 std::span<const std::uint16_t> levels) {
  write_file(path, png16_bytes(width, height, levels));
}

}  // namespace adasplats
