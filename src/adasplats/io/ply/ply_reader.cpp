// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/ply/packed_ply.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/ply/ply_body.h"

namespace adasplats {
namespace {

const PlyProperty* find_corner_list(const PlyElement& faces) {
  for (const PlyProperty& property : faces.properties) {
    if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index"))
      return &property;
  }
  return nullptr;
}

/// The triangles of polygons, and the face of each.
struct Fans {
  std::vector<std::uint32_t> triangle_vertices;
  std::vector<std::size_t> face_of_triangle;
};

Fans fan_polygons(const InputFile& file, const PlyElementData& faces, std::size_t vertices) {
  Fans fans;
  std::size_t first = 0;
  for (std::size_t face = 0; face < faces.list_lengths.size(); ++face) {
    const std::size_t length = faces.list_lengths[face];
    const std::uint32_t* const corners = faces.list_values.data() + first;
    first += length;
    const std::string place = "face " + std::to_string(face);
    if (length < 3) {
      throw data_error({file.path(), {}, {}}, place + ": found " + std::to_string(length) +
                                                  " vertices, expected at least 3");
    }
    for (std::size_t k = 0; k < length; ++k) {
      if (corners[k] < vertices) continue;
      throw data_error({file.path(), {}, {}}, place + ": found vertex index " +
                                                  std::to_string(corners[k]) + ", the file has " +
                                                  std::to_string(vertices) + " vertices");
    }
    for (std::size_t k = 2; k < length; ++k) {
      fans.triangle_vertices.insert(fans.triangle_vertices.end(),
                                    {corners[0], corners[k - 1], corners[k]});
      fans.face_of_triangle.push_back(face);
    }
  }
  return fans;
}

/// The face's properties repeated for each of its triangles.
Table repeat_rows(const Table& faces, const std::vector<std::size_t>& face_of_triangle) {
  Table repeated;
  repeated.rows = face_of_triangle.size();
  for (const Column& column : faces.columns) {
    repeated.columns.push_back(std::visit(
        [&](const auto& values) {
          std::decay_t<decltype(values)> picked;
          picked.reserve(face_of_triangle.size());
          for (const std::size_t face : face_of_triangle) picked.push_back(values[face]);
          return Column{column.name, std::move(picked)};
        },
        column.values));
  }
  return repeated;
}

/// A polygon with many corners and properties would multiply them, so that a short file could take
/// any amount of memory.
void check_repeated_size(const InputFile& file, const PlyElement& element, std::size_t triangles) {
  constexpr std::uint64_t kLargestGrowth = 16;
  const std::uint64_t bytes = static_cast<std::uint64_t>(triangles) * element.min_record_bytes();
  if (bytes <= kLargestGrowth * std::max<std::uint64_t>(file.size_bytes(), 4096)) return;
  throw data_error({file.path(), {}, {}},
                   "the faces' properties, repeated for each of " + std::to_string(triangles) +
                       " triangles, would take more than 16 times the file's size");
}

bool has_random_access(const PlyHeader& header) {
  if (header.encoding == PlyEncoding::ascii || has_packed_gaussians(header)) return false;
  for (const PlyElement& element : header.elements) {
    if (element.has_lists()) return false;
    if (element.name == "vertex") return !element.properties.empty();
  }
  return false;
}

}  // namespace

Table read_ply(const std::filesystem::path& path, const std::optional<RecordSpan>& records) {
  InputFile file(path);
  LineReader lines(file);
  PlyHeader header = read_ply_header(lines);
  if (records && !has_random_access(header))
    throw std::logic_error("read_ply: records of a file without random access");
  PlyBody body(file, lines, header.encoding);
  const auto with_comments = [&](Table table) {
    table.crs = crs_of_comments(path, header.comments);
    table.comments = std::move(header.comments);
    return table;
  };
  if (has_packed_gaussians(header)) return with_comments(read_packed_gaussians(file, header, body));
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex")
      return with_comments(records ? body.read(element, *records) : body.read(element).scalars);
    body.skip(element);
  }
  throw lines.error_here("the header has no element 'vertex'");
}

std::optional<std::uint64_t> ply_records_at_random(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader lines(file);
  const PlyHeader header = read_ply_header(lines);
  if (!has_random_access(header)) return std::nullopt;
  return header.find("vertex")->count;
}

MeshTable read_ply_mesh(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader lines(file);
  PlyHeader header = read_ply_header(lines);
  const PlyElement* const face_element = header.find("face");
  if (header.find("vertex") == nullptr || face_element == nullptr)
    throw lines.error_here("the header lacks the element 'vertex' or 'face' of a mesh");
  const PlyProperty* const corners = find_corner_list(*face_element);
  if (corners == nullptr) {
    throw lines.error_here(
        "element face: no list 'vertex_indices' or 'vertex_index' in the header");
  }
  PlyBody body(file, lines, header.encoding);
  MeshTable mesh;
  PlyElementData faces;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      mesh.vertices = body.read(element).scalars;
    } else if (&element == face_element) {
      faces = body.read(element, corners);
    } else {
      body.skip(element);
    }
  }
  Fans fans = fan_polygons(file, faces, mesh.vertices.rows);
  check_repeated_size(file, *face_element, fans.face_of_triangle.size());
  mesh.faces = repeat_rows(faces.scalars, fans.face_of_triangle);
  mesh.triangle_vertices = std::move(fans.triangle_vertices);
  mesh.vertices.crs = crs_of_comments(path, header.comments);
  mesh.vertices.comments = std::move(header.comments);
  return mesh;
}

std::vector<std::string> read_ply_comments(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader lines(file);
  return read_ply_header(lines).comments;
}

Crs read_ply_crs(const std::filesystem::path& path) {
  return crs_of_comments(path, read_ply_comments(path));
}

bool ply_has_faces(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader lines(file);
  const PlyHeader header = read_ply_header(lines);
  const PlyElement* const faces = header.find("face");
  return faces != nullptr && faces->count > 0;
}

}  // namespace adasplats
