// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/text/obj.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

/// Statements that an OBJ file may begin with.
constexpr std::array<std::string_view, 12> kFirstStatements = {
    "v", "vn", "vt", "vp", "f", "l", "o", "g", "s", "mtllib", "usemtl", "cstype"};

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& path) : file_(path), lines_(file_) {}

  MeshTable read() {
    while (const std::optional<std::string_view> line = next_statement()) {
      BlankTokens tokens(*line);
      const std::string_view keyword = tokens.next();
      if (keyword == "v") add_vertex(tokens);
      if (keyword == "f") add_face(tokens);
    }
    if (vertices() == 0) throw lines_.error_here("the file has no vertices ('v')");
    check_largest_corner();
    return finish();
  }

 private:
  std::size_t vertices() const { return coordinates_[0].size(); }

  /// The next line, including lines joined by a backslash.
  std::optional<std::string_view> next_statement() {
    std::optional<std::string_view> line = lines_.next_filled();
    if (!line || !ends_with_backslash(*line)) return line;
    joined_.clear();
    while (line && ends_with_backslash(*line)) {
      joined_ += line->substr(0, line->find_last_of('\\'));
      joined_ += ' ';
      line = lines_.next();
    }
    if (line) joined_ += *line;
    return joined_;
  }

  static bool ends_with_backslash(std::string_view line) {
    return BlankTokens(line).rest().ends_with('\\');
  }

  void add_vertex(BlankTokens tokens) {
    for (std::size_t axis = 0; axis < coordinates_.size(); ++axis) {
      const std::string_view token = tokens.next();
      const std::optional<double> value = parse_number<double>(token);
      if (!value || !std::isfinite(*value)) {
        throw lines_.error_here("vertex " + std::to_string(coordinates_[axis].size() + 1) + ", " +
                                std::string(1, "xyz"[axis]) + ": expected a finite number, found " +
                                shown(token));
      }
      coordinates_[axis].push_back(*value);
    }
  }

  void add_face(BlankTokens tokens) {
    std::size_t corners = 0;
    std::uint32_t first = 0, last = 0;
    for (std::string_view token = tokens.next(); !token.empty() && !token.starts_with('#');
         token = tokens.next()) {
      const std::uint32_t corner = vertex_of(token);
      if (corners == 0) first = corner;
      if (corners >= 2) triangles_.insert(triangles_.end(), {first, last, corner});
      last = corner;
      ++corners;
    }
    if (corners < 3) {
      throw lines_.error_here("a face has at least 3 corners, found " + std::to_string(corners));
    }
  }

  /// Index from 0 of the vertex that a corner such as "12/3/4" or "-1" names.
  std::uint32_t vertex_of(std::string_view corner) {
    const std::string_view text = corner.substr(0, corner.find('/'));
    const std::optional<std::int64_t> number = parse_number<std::int64_t>(text);
    if (!number || *number == 0) {
      throw lines_.error_here("corner " + shown(corner) +
                              ": expected the number of a vertex, from 1, or from -1 backwards");
    }
    const auto known = static_cast<std::int64_t>(vertices());
    if (*number < -known || *number > std::numeric_limits<std::uint32_t>::max()) {
      throw lines_.error_here("corner " + shown(corner) + ": only " + std::to_string(known) +
                              " vertices so far");
    }
    const std::int64_t index = *number < 0 ? known + *number : *number - 1;
    // A vertex may come after the faces that use it: checked at the end.
    if (index >= largest_corner_) {
      largest_corner_ = index;
      largest_corner_line_ = lines_.line();
    }
    return static_cast<std::uint32_t>(index);
  }

  void check_largest_corner() const {
    if (largest_corner_ < static_cast<std::int64_t>(vertices())) return;
    throw data_error({file_.path(), {}, largest_corner_line_},
                     "vertex " + std::to_string(largest_corner_ + 1) + ": the file has " +
                         std::to_string(vertices()) + " vertices");
  }

  MeshTable finish() {
    MeshTable mesh;
    mesh.vertices.rows = vertices();
    for (std::size_t axis = 0; axis < coordinates_.size(); ++axis) {
      mesh.vertices.columns.push_back({std::string(1, "xyz"[axis]), std::move(coordinates_[axis])});
    }
    mesh.faces.rows = triangles_.size() / 3;
    mesh.triangle_vertices = std::move(triangles_);
    return mesh;
  }

  InputFile file_;
  LineReader lines_;
  std::string joined_;
  std::array<std::vector<double>, 3> coordinates_;
  std::vector<std::uint32_t> triangles_;
  std::int64_t largest_corner_ = -1;
  std::uint64_t largest_corner_line_ = 0;
};

bool is_text(std::span<const std::byte> bytes) {
  return std::none_of(bytes.begin(), bytes.end(), [](std::byte b) {
    const auto c = std::to_integer<unsigned char>(b);
    return c < 32 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
}

}  // namespace

MeshTable read_obj_mesh(const std::filesystem::path& path) { return ObjReader(path).read(); }

bool is_obj(const std::filesystem::path& path) {
  constexpr std::uint64_t kLookedAt = 4096;
  InputFile file(path);
  const auto looked_at = static_cast<std::size_t>(std::min(kLookedAt, file.size_bytes()));
  if (!is_text(file.peek(looked_at).subspan(0, looked_at))) return false;
  LineReader lines(file);
  while (const std::optional<std::string_view> line = lines.next_filled()) {
    const std::string_view first = BlankTokens(*line).next();
    if (first.starts_with('#')) continue;
    return std::find(kFirstStatements.begin(), kFirstStatements.end(), first) !=
           kFirstStatements.end();
  }
  return false;
}

}  // namespace adasplats
