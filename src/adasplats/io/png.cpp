// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/png.h"

#include <png.h>

#include <stdexcept>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/atomic_file.h"

namespace adasplats {

void write_png(const std::filesystem::path& path, int width, int height,
               std::span<const std::uint8_t> pixels) {
  if (width <= 0 || height <= 0 ||
      pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3)
    throw std::logic_error("write_png: pixels.size() is not width * height * 3");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  // What deflate adds to noise (5 bytes each 16 KiB) and the chunk frames (12 bytes each 8 KiB)
  // are below 1/64; libpng fails cleanly where that should ever not be enough.
  const std::size_t raw_bytes = pixels.size() + static_cast<std::size_t>(height);
  std::string encoded(raw_bytes + raw_bytes / 64 + 4096, '\0');
  png_alloc_size_t encoded_bytes = encoded.size();
  // libpng's simplified interface catches its own errors, so no longjmp crosses our frames.
  if (png_image_write_to_memory(&image, encoded.data(), &encoded_bytes, 0, pixels.data(), 0,
                                nullptr) == 0)
    throw Error(ErrorKind::software,
                path.string() + ": the image cannot be encoded: " + std::string(image.message));
  encoded.resize(encoded_bytes);
  write_file(path, encoded);
}

}  // namespace adasplats
