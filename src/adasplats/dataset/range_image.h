// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Rows are rings, columns are azimuth steps of the sensor.
struct ImageSize {
  std::size_t rings = 0;
  std::size_t columns = 0;
};

/// The size that holds all firings.
ImageSize image_size_of(std::span<const Firing> firings);

/// A scan as a range image: pixel (ring, column) at ring * columns + column, with the first
/// reported return.
struct RangeImage {
  ImageSize size;
  std::vector<float> ranges_m;        ///< 0: no return
  std::vector<std::uint32_t> labels;  ///< instance << 16 | class; empty if the scan has none
};

/// Throws std::logic_error for a point outside the image.
RangeImage range_image(const ScanView& scan, ImageSize size);

/// Writes into `folder`, all of shape rings x columns: STEM_range.npy (float32, m, 0: no return),
/// STEM_range.png (16-bit grey, 256 steps a metre as in KITTI's depth maps, 0: no return, 65535:
/// 256 m and beyond) and with classes STEM_label.npy (uint32, instance << 16 | class) and
/// STEM_label.png in the colours of `labels` (black: no return; grey: unknown class). An image
/// without pixels has only the .npy files.
void write_range_image(const std::filesystem::path& folder, const std::string& stem,
                       const RangeImage& image, const LabelScheme* labels);

/// The same as bytes.
std::vector<EncodedFile> encode_range_image(const std::string& stem, const RangeImage& image,
                                            const LabelScheme* labels);

}  // namespace adasplats
