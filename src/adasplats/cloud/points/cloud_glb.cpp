// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/cloud_glb.h"

#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/record_writer.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// Section 3.6.2.2, "Accessor Data Types".
constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;
constexpr int kArrayBuffer = 34962;
constexpr int kPointsMode = 0;

/// Turns our x forward, y left, z up into glTF's z, x, y: by -120 degrees about (1, 1, 1).
constexpr std::string_view kNodeRotation = "[-0.5,-0.5,-0.5,0.5]";  // x y z w

using Rgba = std::array<std::uint8_t, 4>;

/// One attribute of the points: its accessor, and where its values are.
struct Attribute {
  std::string_view name, type;
  int component;
  std::string rest;  ///< of the accessor
  std::vector<ColumnView> columns;
};

std::string vector_text(Vec3d v) {
  return "[" + exact_text(v.x) + "," + exact_text(v.y) + "," + exact_text(v.z) + "]";
}

std::string bounds_text(const PointCloud& cloud) {
  Vec3f low = cloud.positions.front(), high = low;
  for (const Vec3f p : cloud.positions) {
    low = min(low, p);
    high = max(high, p);
  }
  return R"(,"min":)" + vector_text(vec_cast<double>(low)) + R"(,"max":)" +
         vector_text(vec_cast<double>(high));
}

/// sRGB (IEC 61966-2-1) as linear light.
std::vector<Rgba> linear_colors(std::span<const std::array<std::uint8_t, 3>> colors) {
  std::array<std::uint8_t, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double c = static_cast<double>(i) / 255;
    const double light = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    linear[i] = static_cast<std::uint8_t>(std::lround(255 * light));
  }
  std::vector<Rgba> result;
  result.reserve(colors.size());
  for (const auto& rgb : colors)
    result.push_back({linear[rgb[0]], linear[rgb[1]], linear[rgb[2]], 255});
  return result;
}

/// Every attribute begins at a multiple of four bytes (section 3.6.2.4).
std::vector<Attribute> attributes_of(const PointCloud& cloud, const std::vector<Rgba>& colors,
                                     const std::vector<float>& intensities) {
  const Vec3f& p = cloud.positions.front();
  const Rgba& c = colors.front();
  const auto f32 = [](const float& v) {
    return ColumnView{"", ColumnType::f32, &v, sizeof(Vec3f)};
  };
  const auto u8 = [](const std::uint8_t& v) {
    return ColumnView{"", ColumnType::u8, &v, sizeof(Rgba)};
  };
  std::vector<Attribute> attributes = {
      {"POSITION", "VEC3", kFloat, bounds_text(cloud), {f32(p.x), f32(p.y), f32(p.z)}},
      {"COLOR_0",
       "VEC4",
       kUnsignedByte,
       R"(,"normalized":true)",
       {u8(c[0]), u8(c[1]), u8(c[2]), u8(c[3])}}};
  if (!intensities.empty())
    attributes.push_back({"_INTENSITY",
                          "SCALAR",
                          kFloat,
                          "",
                          {{"", ColumnType::f32, intensities.data(), sizeof(float)}}});
  static const std::uint16_t kPadding = 0;
  if (!cloud.classes.empty())
    attributes.push_back({"_CLASS",
                          "SCALAR",
                          kUnsignedShort,
                          "",
                          {{"", ColumnType::u16, cloud.classes.data(), sizeof(std::uint16_t)},
                           {"", ColumnType::u16, &kPadding, 0}}});
  return attributes;
}

std::size_t bytes_of(const Attribute& attribute) {
  std::size_t bytes = 0;
  for (const ColumnView& column : attribute.columns) bytes += type_bytes(column.type);
  return bytes;
}

/// The members of the document that describe the points.
std::string mesh_members(const std::vector<Attribute>& attributes, std::size_t points,
                         std::size_t stride) {
  std::string names, accessors;
  std::size_t offset = 0;
  for (std::size_t k = 0; k < attributes.size(); ++k) {
    const Attribute& attribute = attributes[k];
    const std::string comma = k > 0 ? "," : "";
    names += comma + "\"" + std::string(attribute.name) + "\":" + std::to_string(k);
    accessors += comma + R"({"bufferView":0,"byteOffset":)" + std::to_string(offset) +
                 R"(,"componentType":)" + std::to_string(attribute.component) + R"(,"count":)" +
                 std::to_string(points) + R"(,"type":")" + std::string(attribute.type) + "\"" +
                 attribute.rest + "}";
    offset += bytes_of(attribute);
  }
  const std::string bytes = std::to_string(points * stride);
  return R"(,"meshes":[{"primitives":[{"mode":)" + std::to_string(kPointsMode) +
         R"(,"attributes":{)" + names + R"(}}]}],"accessors":[)" + accessors +
         R"(],"bufferViews":[{"buffer":0,"byteLength":)" + bytes + R"(,"byteStride":)" +
         std::to_string(stride) + R"(,"target":)" + std::to_string(kArrayBuffer) +
         R"(}],"buffers":[{"byteLength":)" + bytes + "}]";
}

/// A text in quotes; bytes that are no ASCII come from files of any encoding, and become '?'.
std::string json_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    const bool is_plain = c >= ' ' && c <= '~';
    quoted += is_plain ? c : c == '\n' || c == '\t' || c == '\r' ? ' ' : '?';
  }
  return quoted + "\"";
}

/// The JSON with blanks behind it up to a multiple of four bytes.
std::string document(const PointCloud& cloud, const std::string& members) {
  std::string json =
      R"({"asset":{"version":"2.0","generator":"adasplats"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"name":"points","rotation":)";
  json.append(kNodeRotation).append(R"(,"extras":{"origin":)").append(vector_text(cloud.origin));
  if (!cloud.crs.empty()) json += R"(,"crs":)" + json_text(cloud.crs.name());
  if (!cloud.crs.wkt.empty()) json += R"(,"crs_wkt":)" + json_text(cloud.crs.wkt);
  json += members.empty() ? "}}]" : R"(},"mesh":0}])";
  json += members + "}";
  while (json.size() % 4 != 0) json += ' ';
  return json;
}

void put_words(AtomicFile& file, std::initializer_list<std::size_t> words) {
  for (const std::size_t word : words) {
    const auto value = static_cast<std::uint32_t>(word);
    file.write(&value, sizeof(value));
  }
}

void write_glb(const std::filesystem::path& path, const std::string& json, std::size_t points,
               std::size_t stride, const std::vector<ColumnView>& columns) {
  constexpr std::size_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  constexpr std::size_t kVersion = 2, kHeaderBytes = 12, kChunkHeaderBytes = 8;
  const std::size_t binary = points * stride;
  const std::size_t total = kHeaderBytes + kChunkHeaderBytes + json.size() +
                            (binary > 0 ? kChunkHeaderBytes + binary : 0);
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::data, path.string() + ": " + std::to_string(points) +
                                     " points are more than the 4 GiB of a .glb hold; write a PLY");
  AtomicFile file(path);
  file.write("glTF");
  put_words(file, {kVersion, total, json.size(), kJson});
  file.write(json);
  if (binary > 0) {
    put_words(file, {binary, kBinary});
    write_records(file, points, columns);
  }
  file.commit();
}

}  // namespace

void save_cloud_glb(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const std::array<std::uint8_t, 3>> colors) {
  if (colors.size() != cloud.size())
    throw std::logic_error("save_cloud_glb: not one colour a point");
  if (cloud.empty()) {
    write_glb(path, document(cloud, ""), 0, 0, {});
    return;
  }
  const std::vector<Rgba> linear = linear_colors(colors);
  std::vector<float> intensities = cloud.intensities;  // glTF allows no NaN
  for (float& value : intensities) value = std::isfinite(value) ? value : 0.0F;
  const std::vector<Attribute> attributes = attributes_of(cloud, linear, intensities);
  std::size_t stride = 0;
  std::vector<ColumnView> columns;
  for (const Attribute& attribute : attributes) {
    stride += bytes_of(attribute);
    columns.insert(columns.end(), attribute.columns.begin(), attribute.columns.end());
  }
  const std::string json = document(cloud, mesh_members(attributes, cloud.size(), stride));
  write_glb(path, json, cloud.size(), stride, columns);
}

}  // namespace adasplats
