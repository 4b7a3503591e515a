// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/mesh_model.h"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/text/gltf.h"
#include "adasplats/io/text/obj.h"
#include "adasplats/splats/model/model_comments.h"

namespace adasplats {
namespace {

bool is_ply(const std::filesystem::path& path) {
  InputFile file(path);
  constexpr std::string_view kMagic = "ply";
  if (file.size_bytes() < kMagic.size()) return false;
  const std::span<const std::byte> bytes = file.peek(kMagic.size());
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), kMagic.size()) == kMagic;
}

/// World coordinates by vertex.
class VertexColumns {
 public:
  VertexColumns(const std::filesystem::path& path, const Table& vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view name = std::string_view("xyz").substr(axis, 1);
      columns_[axis] = vertices.find(name);
      if (columns_[axis] == nullptr)
        throw data_error({path, {}, {}}, "the vertices have no property " + std::string(name));
    }
  }
  Vec3d operator[](std::size_t i) const {
    return {columns_[0]->as_double(i), columns_[1]->as_double(i), columns_[2]->as_double(i)};
  }

 private:
  std::array<const Column*, 3> columns_{};
};

void set_vertices(MeshModel& model, const std::filesystem::path& path, const Table& vertices) {
  const VertexColumns world(path, vertices);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3d low = {kFar, kFar, kFar}, high = -low;
  for (std::size_t i = 0; i < vertices.rows; ++i) {
    const Vec3d vertex = world[i];
    if (!is_finite(vertex))
      throw data_error({path, {}, {}}, "vertex " + std::to_string(i) + " is not finite");
    low = min(low, vertex);
    high = max(high, vertex);
  }
  if (vertices.rows > 0) model.origin = choose_origin(low, high);
  model.mesh.vertices.reserve(vertices.rows);
  for (std::size_t i = 0; i < vertices.rows; ++i) {
    const Vec3f local = vec_cast<float>(world[i] - model.origin);
    if (!is_finite(local))
      throw data_error({path, {}, {}}, "vertex " + std::to_string(i) +
                                           " is too far from the others for single precision");
    model.mesh.vertices.push_back(local);
  }
}

std::vector<std::uint16_t> face_classes(const std::filesystem::path& path, const Table& faces) {
  std::vector<std::uint16_t> classes;
  const Column* const column = find_column(faces, PointColumn::classification);
  if (column == nullptr) return classes;
  classes.reserve(faces.rows);
  for (std::size_t i = 0; i < faces.rows; ++i) {
    const double id = column->as_double(i);
    if (!(id >= 0 && id <= 0xffff) || id != std::trunc(id))
      throw data_error({path, {}, {}}, "triangle " + std::to_string(i) + ", " + column->name +
                                           ": found " + std::to_string(id) +
                                           ", expected a whole number from 0 to 65535");
    classes.push_back(static_cast<std::uint16_t>(id));
  }
  return classes;
}

MeshModel to_model(const std::filesystem::path& path, MeshTable table) {
  require_version_1(table.vertices, kMeshComment, path);
  MeshModel model;
  set_vertices(model, path, table.vertices);
  model.label_scheme = comment_value(table.vertices, kLabelsComment);
  model.method = comment_value(table.vertices, kMethodComment);
  model.crs = std::move(table.vertices.crs);
  table.vertices = {};  // frees it early: meshes can be large
  model.mesh.classes = face_classes(path, table.faces);
  const std::vector<std::uint32_t>& corners = table.triangle_vertices;
  model.mesh.triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    model.mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return model;
}

}  // namespace

void save_mesh(const std::filesystem::path& path, const MeshModel& model) {
  const TriangleMesh& mesh = model.mesh;
  const bool far = !(model.origin == Vec3d{});
  std::vector<Vec3d> world;
  if (far) {
    world.reserve(mesh.vertices.size());
    for (const Vec3f vertex : mesh.vertices)
      world.push_back(model.origin + vec_cast<double>(vertex));
  }
  const Vec3f nothing{};
  const Vec3d nowhere{};
  const Vec3f* const v = mesh.vertices.empty() ? &nothing : mesh.vertices.data();
  const Vec3d* const w = world.empty() ? &nowhere : world.data();
  const auto axis = [&](const char* name, const float* local, const double* far_away) {
    return far ? ColumnView{name, ColumnType::f64, far_away, sizeof(Vec3d)}
               : ColumnView{name, ColumnType::f32, local, sizeof(Vec3f)};
  };
  const std::array<ColumnView, 3> vertex_columns = {
      axis("x", &v->x, &w->x), axis("y", &v->y, &w->y), axis("z", &v->z, &w->z)};
  std::vector<ColumnView> face_columns;
  if (!mesh.classes.empty())
    face_columns.push_back({"class", ColumnType::u16, mesh.classes.data(), sizeof(std::uint16_t)});
  std::vector<std::string> comments = {std::string(kMeshComment) + "1"};
  if (!model.method.empty()) comments.push_back(kMethodComment + model.method);
  if (!model.label_scheme.empty())
    comments.push_back(std::string(kLabelsComment) + model.label_scheme);
  for (std::string& comment : crs_comments(model.crs)) comments.push_back(std::move(comment));
  static_assert(sizeof(mesh.triangles[0]) == 3 * sizeof(std::uint32_t));
  const std::uint32_t* const corners =
      mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
  write_ply_mesh(path, mesh.vertices.size(), vertex_columns,
                 std::span(corners, 3 * mesh.triangles.size()), face_columns, comments);
}

MeshModel load_mesh(const std::filesystem::path& path) {
  if (is_ply(path)) return to_model(path, read_ply_mesh(path));
  if (is_gltf(path)) return to_model(path, read_gltf_mesh(path));
  if (is_obj(path)) return to_model(path, read_obj_mesh(path));
  throw data_error({path, {}, {}}, "not a mesh: neither PLY, OBJ nor glTF");
}

bool is_mesh_file(const std::filesystem::path& path) {
  if (is_ply(path)) return ply_has_faces(path);
  return is_gltf(path) ? !has_gltf_splats(path) : is_obj(path);
}

}  // namespace adasplats
