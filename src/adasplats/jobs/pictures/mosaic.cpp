// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/mosaic.h"

#include <algorithm>

namespace adasplats {

Image blank_image(int width, int height) {
  Image image{width, height, {}};
  image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  return image;
}

void paste(Image& picture, const Image& part, int left, int top) {
  const std::size_t row_bytes = static_cast<std::size_t>(part.width) * 3;
  for (int row = 0; row < part.height; ++row) {
    const auto from = part.pixels.begin() +
                      static_cast<std::ptrdiff_t>(row_bytes * static_cast<std::size_t>(row));
    const std::size_t to =
        (static_cast<std::size_t>(top + row) * static_cast<std::size_t>(picture.width) +
         static_cast<std::size_t>(left)) *
        3;
    std::copy(from, from + static_cast<std::ptrdiff_t>(row_bytes),
              picture.pixels.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

}  // namespace adasplats
