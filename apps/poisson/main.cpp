// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// usage: adasplats-poisson POINTS.ply MESH.ply DEPTH THREADS
// Screened Poisson reconstruction by Open3D. POINTS has x y z nx ny nz; the vertices of MESH have a
// `value`, the depth of the octree that their samples lie at. Run by `adasplats mesh`.

#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>

#include <array>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/ply/ply.h"

namespace {

using adasplats::Error;
using adasplats::ErrorKind;

int number_of(const char* text) {
  const std::optional<int> number = adasplats::parse_number<int>(text);
  if (!number || *number < 1)
    throw Error(ErrorKind::usage, "expected a number above 0, found " + adasplats::shown(text));
  return *number;
}

Eigen::Vector3d vector_at(const std::array<const adasplats::Column*, 3>& columns, std::size_t i) {
  return {columns[0]->as_double(i), columns[1]->as_double(i), columns[2]->as_double(i)};
}

open3d::geometry::PointCloud read_points(const char* path) {
  const adasplats::Table table = adasplats::read_ply(path);
  const auto column = [&](const char* name) {
    const adasplats::Column* const found = table.find(name);
    if (found == nullptr)
      throw adasplats::data_error({path, {}, {}}, std::string("no property ") + name);
    return found;
  };
  const std::array<const adasplats::Column*, 3> position = {column("x"), column("y"), column("z")};
  const std::array<const adasplats::Column*, 3> normal = {column("nx"), column("ny"), column("nz")};
  open3d::geometry::PointCloud cloud;
  cloud.points_.reserve(table.rows);
  cloud.normals_.reserve(table.rows);
  for (std::size_t i = 0; i < table.rows; ++i) {
    cloud.points_.push_back(vector_at(position, i));
    cloud.normals_.push_back(vector_at(normal, i));
  }
  return cloud;
}

void write_mesh(const char* path, const open3d::geometry::TriangleMesh& mesh,
                const std::vector<double>& depths) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles_.size());
  for (const Eigen::Vector3i& t : mesh.triangles_)
    for (const int corner : {t.x(), t.y(), t.z()})
      corners.push_back(static_cast<std::uint32_t>(corner));
  const double none = 0;
  const double* const first = mesh.vertices_.empty() ? &none : mesh.vertices_.front().data();
  constexpr std::size_t kStride = sizeof(Eigen::Vector3d);
  const std::size_t step = mesh.vertices_.empty() ? 0 : 1;
  const std::array<adasplats::ColumnView, 4> columns = {
      adasplats::ColumnView{"x", adasplats::ColumnType::f64, first, kStride},
      adasplats::ColumnView{"y", adasplats::ColumnType::f64, first + step, kStride},
      adasplats::ColumnView{"z", adasplats::ColumnType::f64, first + 2 * step, kStride},
      adasplats::ColumnView{"value", adasplats::ColumnType::f64, depths.data(), sizeof(double)}};
  adasplats::write_ply_mesh(path, mesh.vertices_.size(), columns, corners, {});
}

void run(char** arguments) {
  const auto depth = static_cast<std::size_t>(number_of(arguments[3]));
  const int threads = number_of(arguments[4]);
  const auto [mesh, depths] = open3d::geometry::TriangleMesh::CreateFromPointCloudPoisson(
      read_points(arguments[1]), depth, 0.0F, 1.1F, false, threads);
  write_mesh(arguments[2], *mesh, depths);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fputs("usage: adasplats-poisson POINTS.ply MESH.ply DEPTH THREADS\n", stderr);
    return adasplats::exit_code(ErrorKind::usage);
  }
  try {
    run(argv);
  } catch (const Error& error) {
    std::fprintf(stderr, "adasplats-poisson: error: %s\n", error.what());
    return adasplats::exit_code(error.kind());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adasplats-poisson: error: %s\n", error.what());
    return adasplats::exit_code(ErrorKind::software);
  }
  return 0;
}
