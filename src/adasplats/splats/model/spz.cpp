// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/spz.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/io/text/glb_points.h"
#include "adasplats/splats/model/gaussians.h"

namespace adasplats {
namespace {

struct SpzHeader {
  std::array<char, 4> magic = {'N', 'G', 'S', 'P'};
  std::uint32_t version = 3;
  std::uint32_t points = 0;
  std::uint8_t harmonics_degree = 0;
  std::uint8_t fractional_bits = 0;
  std::uint8_t flags = 0, reserved = 0;
};
static_assert(sizeof(SpzHeader) == 16);

char byte_of(double value) {
  return static_cast<char>(static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))));
}

void append_word(std::string& bytes, std::uint32_t word, int count) {
  for (int k = 0; k < count; ++k) bytes += static_cast<char>(word >> (8 * k) & 0xFF);
}

/// The most bits after the point, at most 12, with which 24 bits hold all positions.
int fractional_bits(std::span<const Disk> disks, Vec3f center) {
  constexpr int kMaxBits = 12;
  constexpr double kLimit = 0x1p23 - 1;
  double reach = 0;
  for (const Disk& disk : disks) {
    const Vec3f offset = disk.center - center;
    for (int axis = 0; axis < 3; ++axis)
      reach = std::max(reach, static_cast<double>(std::fabs(offset[axis])));
  }
  int bits = kMaxBits;
  while (bits > 0 && std::ldexp(reach, bits) > kLimit) --bits;
  return bits;
}

/// The index of the largest component in two bits, then the others in ten: sign and magnitude.
std::uint32_t packed_rotation(const Quaternion& q) {
  const std::array<double, 4> values = {q.x, q.y, q.z, q.w};
  std::size_t largest = 0;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (std::fabs(values[k]) > std::fabs(values[largest])) largest = k;
  auto packed = static_cast<std::uint32_t>(largest);
  constexpr double kSteps = 511 * std::numbers::sqrt2;  // no other exceeds sqrt(1/2)
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k == largest) continue;
    const std::uint32_t is_negative = (values[k] < 0) != (values[largest] < 0) ? 1 : 0;
    const auto size = static_cast<std::uint32_t>(std::lround(kSteps * std::fabs(values[k])));
    packed = packed << 10 | is_negative << 9 | std::min(size, std::uint32_t{511});
  }
  return packed;
}

std::string accessor(const char* type, std::size_t count, const std::string& more) {
  return R"({"type":")" + std::string(type) + R"(","count":)" + std::to_string(count) + more + "}";
}

/// The glTF document: its accessors describe what the SPZ in the only buffer contains.
std::string document(std::span<const Disk> disks, Vec3f center, std::size_t spz_bytes) {
  Vec3f low = disks.front().center - center, high = low;
  for (const Disk& disk : disks) {
    low = min(low, disk.center - center);
    high = max(high, disk.center - center);
  }
  const std::string floats = R"(,"componentType":5126)";
  const std::string bounds = R"(,"min":)" + json_vector(vec_cast<double>(low)) + R"(,"max":)" +
                             json_vector(vec_cast<double>(high));
  const std::string bytes = R"("byteLength":)" + std::to_string(spz_bytes);
  const std::string extensions =
      R"(["KHR_gaussian_splatting","KHR_gaussian_splatting_compression_spz_2"])";
  const auto text = [](float v) { return exact_text(static_cast<double>(v)); };
  const std::size_t count = disks.size();
  return R"({"asset":{"version":"2.0","generator":"adasplats"},"extensionsUsed":)" + extensions +
         R"(,"extensionsRequired":)" + extensions +
         R"(,"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)"
         R"("matrix":[1,0,0,0,0,0,-1,0,0,1,0,0,)" +
         text(center.x) + "," + text(center.z) + "," + text(-center.y) +
         R"(,1]}],"meshes":[{"primitives":[{"mode":0,"attributes":{"POSITION":0,"COLOR_0":1,)"
         R"("KHR_gaussian_splatting:ROTATION":2,"KHR_gaussian_splatting:SCALE":3},)"
         R"("extensions":{"KHR_gaussian_splatting":{"kernel":"ellipse",)"
         R"("colorSpace":"srgb_rec709_display","extensions":{)"
         R"("KHR_gaussian_splatting_compression_spz_2":{"bufferView":0}}}}}]}],"accessors":[)" +
         accessor("VEC3", count, floats + bounds) + "," +
         accessor("VEC4", count, R"(,"componentType":5121,"normalized":true)") + "," +
         accessor("VEC4", count, floats) + "," + accessor("VEC3", count, floats) +
         R"(],"bufferViews":[{"buffer":0,)" + bytes + R"(}],"buffers":[{)" + bytes + "}]}";
}

}  // namespace

std::string spz_of(std::span<const Disk> disks, std::span<const ColorBytes> colors, Vec3f center) {
  if (colors.size() != disks.size())
    throw std::logic_error("spz_of: the number of colours is not the number of disks");
  SpzHeader header;
  header.points = static_cast<std::uint32_t>(disks.size());
  const int bits = fractional_bits(disks, center);
  header.fractional_bits = static_cast<std::uint8_t>(bits);
  std::string content(sizeof(header), '\0');
  std::memcpy(content.data(), &header, sizeof(header));
  for (const Disk& disk : disks) {
    const Vec3d offset = vec_cast<double>(disk.center - center);
    for (int axis = 0; axis < 3; ++axis)
      append_word(content, static_cast<std::uint32_t>(std::lround(std::ldexp(offset[axis], bits))),
                  3);
  }
  content.append(disks.size(), static_cast<char>(0xFF));  // opacities
  for (const ColorBytes& color : colors)
    for (const std::uint8_t value : color)
      content += byte_of((0.15 * static_cast<double>(harmonic_of(value)) + 0.5) * 255);
  for (const Disk& disk : disks) {
    const double log_sigma = std::log(gaussian_sigma(disk, false));
    const char along = byte_of((log_sigma + 10) * 16);
    content += {along, along, byte_of((log_sigma + std::log(kGaussianThickness) + 10) * 16)};
  }
  for (const Disk& disk : disks)
    append_word(content, packed_rotation(rotation_from_z(vec_cast<double>(disk.normal))), 4);
  return gzipped(content);
}

std::string spz_glb(std::span<const Disk> disks, std::span<const ColorBytes> colors) {
  Vec3f low = disks.front().center, high = low;
  for (const Disk& disk : disks) {
    low = min(low, disk.center);
    high = max(high, disk.center);
  }
  const Vec3f center = 0.5F * (low + high);
  const std::string spz = spz_of(disks, colors, center);
  std::string glb = glb_start(document(disks, center, spz.size()), spz.size()) + spz;
  glb.resize((glb.size() + 3) / 4 * 4, '\0');
  return glb;
}

}  // namespace adasplats
