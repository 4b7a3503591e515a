// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/range_image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/arrays/png.h"

namespace adasplats {
namespace {

constexpr double kStepsPerMetre = 256;

std::vector<std::uint16_t> levels_of(std::span<const float> ranges_m) {
  std::vector<std::uint16_t> levels;
  levels.reserve(ranges_m.size());
  for (const float range : ranges_m) {
    const double steps = std::nearbyint(kStepsPerMetre * static_cast<double>(range));
    // A return is never 0, even at close range.
    levels.push_back(range > 0 ? static_cast<std::uint16_t>(std::clamp(steps, 1.0, 65535.0))
                               : std::uint16_t{0});
  }
  return levels;
}

std::vector<std::uint8_t> pixels_of(const RangeImage& image, const LabelScheme* scheme) {
  constexpr std::array<std::uint8_t, 3> kNothing = {0, 0, 0};
  constexpr std::array<std::uint8_t, 3> kUnknown = {128, 128, 128};
  std::vector<std::uint8_t> pixels;
  pixels.reserve(3 * image.labels.size());
  for (std::size_t i = 0; i < image.labels.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(image.labels[i] & 0xffff);
    const SemanticClass* const known = scheme != nullptr ? scheme->find(id) : nullptr;
    const auto rgb = image.ranges_m[i] > 0 ? (known != nullptr ? known->rgb : kUnknown) : kNothing;
    pixels.insert(pixels.end(), rgb.begin(), rgb.end());
  }
  return pixels;
}

}  // namespace

ImageSize image_size_of(std::span<const Firing> firings) {
  ImageSize size;
  for (const Firing& firing : firings) {
    size.rings = std::max<std::size_t>(size.rings, firing.ring + std::size_t{1});
    size.columns = std::max<std::size_t>(size.columns, firing.column + std::size_t{1});
  }
  return size;
}

RangeImage range_image(const ScanView& scan, ImageSize size) {
  RangeImage image{size, std::vector<float>(size.rings * size.columns), {}};
  const bool has_labels = !scan.classes.empty() || !scan.instances.empty();
  if (has_labels) image.labels.resize(image.ranges_m.size());
  const std::vector<std::uint32_t> labels = packed_labels(scan);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.rings[i] >= size.rings || scan.columns[i] >= size.columns)
      throw std::logic_error("range_image: point outside the image");
    const std::size_t pixel = scan.rings[i] * size.columns + scan.columns[i];
    if (image.ranges_m[pixel] > 0) continue;
    image.ranges_m[pixel] = scan.ranges_m[i];
    if (has_labels) image.labels[pixel] = labels[i];
  }
  return image;
}

std::vector<EncodedFile> encode_range_image(const std::string& stem, const RangeImage& image,
                                            const LabelScheme* labels) {
  const std::vector<std::size_t> shape = {image.size.rings, image.size.columns};
  const auto width = static_cast<int>(image.size.columns);
  const auto height = static_cast<int>(image.size.rings);
  const bool has_pixels = !image.ranges_m.empty();
  std::vector<EncodedFile> files;
  const auto add_array = [&](const char* ending, ColumnType type, const void* values) {
    ByteBuffer file;
    put_npy(file, NpyArray{type, shape, values});
    files.push_back({stem + ending, file.take()});
  };
  add_array("_range.npy", ColumnType::f32, image.ranges_m.data());
  if (has_pixels)
    files.push_back({stem + "_range.png",
                     png16_bytes(width, height, levels_of(image.ranges_m), PngEffort::fast)});
  if (image.labels.empty()) return files;
  add_array("_label.npy", ColumnType::u32, image.labels.data());
  files.push_back(
      {stem + "_label.png", png_bytes(width, height, pixels_of(image, labels), PngEffort::fast)});
  return files;
}

void write_range_image(const std::filesystem::path& folder, const std::string& stem,
                       const RangeImage& image, const LabelScheme* labels) {
  write_encoded(folder, encode_range_image(stem, image, labels), FileWrites::atomic);
}

}  // namespace adasplats
