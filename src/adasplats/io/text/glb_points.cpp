// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/text/glb_points.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/record_writer.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kArrayBuffer = 34962;
constexpr int kPointsMode = 0;

/// Turns our x forward, y left, z up into glTF's z, x, y: by -120 degrees about (1, 1, 1).
constexpr std::string_view kNodeRotation = "[-0.5,-0.5,-0.5,0.5]";  // x y z w

/// Section 3.6.2.2, "Accessor Data Types".
int component_of(ColumnType type) {
  switch (type) {
    case ColumnType::u8: return 5121;
    case ColumnType::u16: return 5123;
    default: return 5126;
  }
}

std::string_view type_of(std::size_t components) {
  constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kTypes.at(components - 1);
}

/// The least and the greatest position, as accessors of positions state them.
std::string bounds_text(const GlbAttribute& positions, std::size_t points) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Vec3f low = {kFar, kFar, kFar}, high = {-kFar, -kFar, -kFar};
  for (std::size_t i = 0; i < points; ++i) {
    Vec3f p;
    for (int axis = 0; axis < 3; ++axis) {
      const ColumnView& column = positions.columns[static_cast<std::size_t>(axis)];
      std::memcpy(&p[axis], static_cast<const char*>(column.data) + i * column.stride_bytes,
                  sizeof(float));
    }
    low = min(low, p);
    high = max(high, p);
  }
  return R"(,"min":)" + json_vector(vec_cast<double>(low)) + R"(,"max":)" +
         json_vector(vec_cast<double>(high));
}

std::size_t bytes_of(const GlbAttribute& attribute) {
  std::size_t bytes = 0;
  for (const ColumnView& column : attribute.columns) bytes += type_bytes(column.type);
  return bytes;
}

/// Of an attribute in the file, with the padding up to a multiple of four (section 3.6.2.4).
std::size_t padded_bytes(const GlbAttribute& attribute, std::size_t points) {
  return (points * bytes_of(attribute) + 3) / 4 * 4;
}

/// The members of the document that describe the points. One buffer view per attribute: simple
/// readers know no interleaved ones.
std::string mesh_members(const GlbPoints& content, std::size_t points) {
  std::string names, accessors, views;
  std::size_t offset = 0;
  for (std::size_t k = 0; k < content.attributes.size(); ++k) {
    const GlbAttribute& attribute = content.attributes[k];
    const bool is_listed = !attribute.name.empty();
    const std::size_t components =
        attribute.components > 0 ? attribute.components : attribute.columns.size();
    const std::string comma = k > 0 ? "," : "";
    if (is_listed)
      names += (names.empty() ? "\"" : ",\"") + attribute.name + "\":" + std::to_string(k);
    accessors += comma + R"({"bufferView":)" + std::to_string(k) + R"(,"componentType":)" +
                 std::to_string(component_of(attribute.columns.front().type)) + R"(,"count":)" +
                 std::to_string(points) + R"(,"type":")" + std::string(type_of(components)) + "\"";
    if (attribute.normalized) accessors += R"(,"normalized":true)";
    if (k == 0) accessors += bounds_text(attribute, points);
    accessors += "}";
    views += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" +
             std::to_string(points * bytes_of(attribute));
    if (is_listed)
      views += R"(,"byteStride":)" + std::to_string(bytes_of(attribute)) + R"(,"target":)" +
               std::to_string(kArrayBuffer);
    views += "}";
    offset += padded_bytes(attribute, points);
  }
  return R"(,"meshes":[{"primitives":[{"mode":)" + std::to_string(kPointsMode) +
         R"(,"attributes":{)" + names + "}" + content.primitive + R"(}]}],"accessors":[)" +
         accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[{"byteLength":)" +
         std::to_string(offset) + "}]";
}

std::string document(const GlbPoints& content, const std::string& members) {
  std::string json = R"({"asset":{"version":"2.0","generator":"adasplats"},)";
  if (!content.extensions.empty()) {
    json += R"("extensionsUsed":[)";
    for (const std::string& name : content.extensions)
      json += (json.ends_with('[') ? "" : ",") + json_text(name);
    json += "],";
  }
  json += R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"points","rotation":)";
  json.append(kNodeRotation).append(R"(,"extras":{)").append(content.extras);
  json += members.empty() ? "}}]" : R"(},"mesh":0}])";
  return json + members + "}";
}

void append_words(std::string& bytes, std::initializer_list<std::size_t> words) {
  for (const std::size_t word : words) {
    const auto value = static_cast<std::uint32_t>(word);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));  // NOLINT
  }
}

}  // namespace

std::string json_vector(Vec3d v) {
  return "[" + exact_text(v.x) + "," + exact_text(v.y) + "," + exact_text(v.z) + "]";
}

std::string json_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    const bool is_plain = c >= ' ' && c <= '~';
    quoted += is_plain ? c : c == '\n' || c == '\t' || c == '\r' ? ' ' : '?';
  }
  return quoted + "\"";
}

std::vector<GlbColor> linear_colors(const std::vector<std::array<std::uint8_t, 3>>& srgb) {
  std::array<std::uint8_t, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double c = static_cast<double>(i) / 255;
    const double light = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    linear[i] = static_cast<std::uint8_t>(std::lround(255 * light));
  }
  std::vector<GlbColor> result;
  result.reserve(srgb.size());
  for (const auto& rgb : srgb)
    result.push_back({linear[rgb[0]], linear[rgb[1]], linear[rgb[2]], 255});
  return result;
}

std::string glb_start(std::string json, std::size_t binary_bytes) {
  constexpr std::size_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  constexpr std::size_t kVersion = 2, kHeaderBytes = 12, kChunkHeaderBytes = 8;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t binary = (binary_bytes + 3) / 4 * 4;
  std::string start = "glTF";
  append_words(start, {kVersion,
                       kHeaderBytes + kChunkHeaderBytes + json.size() +
                           (binary > 0 ? kChunkHeaderBytes + binary : 0),
                       json.size(), kJson});
  start += json;
  if (binary > 0) append_words(start, {binary, kBinary});
  return start;
}

void write_glb_points(const std::filesystem::path& path, std::size_t points,
                      const GlbPoints& content) {
  std::size_t binary = 0;
  for (const GlbAttribute& attribute : content.attributes)
    binary += padded_bytes(attribute, points);
  const std::string start = glb_start(
      document(content, points > 0 ? mesh_members(content, points) : std::string()), binary);
  if (start.size() + binary > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::data, path.string() + ": " + std::to_string(points) +
                                     " points are more than the 4 GiB of a .glb hold; write a PLY");
  AtomicFile file(path);
  file.write(start);
  for (const GlbAttribute& attribute : content.attributes) {
    write_records(file, points, attribute.columns);
    file.write(std::string(padded_bytes(attribute, points) - points * bytes_of(attribute), '\0'));
  }
  file.commit();
}

}  // namespace adasplats
