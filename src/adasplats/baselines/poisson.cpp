// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/poisson.h"

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <unordered_map>
#include <vector>

#include "adasplats/core/child_process.h"
#include "adasplats/core/error.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed with this object.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& parent) {
    std::string pattern = (parent / ".adasplats-poisson-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw system_error(ErrorKind::cannot_create, pattern, "cannot create the folder", errno);
    path_ = pattern;
  }
  ~WorkFolder() {
    std::error_code ignored;  // a destructor must not throw
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void check(const PoissonOptions& options, std::size_t points) {
  check_settings(options);
  if (points == 0) throw Error(ErrorKind::data, "the input has no points to reconstruct from");
}

void write_points(const fs::path& path, std::span<const Vec3f> points,
                  std::span<const Vec3f> normals) {
  const auto column = [](const char* name, const float* first) {
    return ColumnView{name, ColumnType::f32, first, sizeof(Vec3f)};
  };
  const std::array<ColumnView, 6> columns = {
      column("x", &points[0].x),   column("y", &points[0].y),   column("z", &points[0].z),
      column("nx", &normals[0].x), column("ny", &normals[0].y), column("nz", &normals[0].z)};
  write_ply(path, points.size(), columns);
}

const Column& column_of(const MeshTable& table, const fs::path& path, std::string_view name) {
  const Column* const column = table.vertices.find(name);
  if (column == nullptr)
    throw data_error({path, {}, {}}, "the vertices have no property " + std::string(name));
  return *column;
}

/// Converts a mesh that a program wrote.
TriangleMesh to_mesh(const MeshTable& table, const fs::path& path) {
  const Column& x = column_of(table, path, "x");
  const Column& y = column_of(table, path, "y");
  const Column& z = column_of(table, path, "z");
  TriangleMesh mesh;
  mesh.vertices.reserve(table.vertices.rows);
  for (std::size_t i = 0; i < table.vertices.rows; ++i)
    mesh.vertices.push_back(vec_cast<float>(Vec3d{x.as_double(i), y.as_double(i), z.as_double(i)}));
  const std::vector<std::uint32_t>& corners = table.triangle_vertices;
  mesh.triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return mesh;
}

/// A number with a decimal point in every locale.
std::string text_of(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6f", value);
  std::replace(text.begin(), text.end(), ',', '.');
  return text.data();
}

/// The flags are those of PoissonRecon 18; boundary type 3 is Neumann's.
PoissonSurface by_poisson_recon(const PoissonOptions& options, const PoissonPrograms& programs,
                                const fs::path& folder, int threads, ProgressSink& progress) {
  const fs::path whole = folder / "whole.ply", trimmed_mesh = folder / "trimmed.ply";
  PoissonSurface surface;
  progress.begin_step("reconstruct", 0);
  surface.peak_memory_bytes = run_program(
      programs.reconstruct,
      {"--in", (folder / "points.ply").string(), "--out", whole.string(), "--depth",
       std::to_string(options.depth), "--bType", "3", "--samplesPerNode",
       text_of(options.samples_per_node.value_or(2)), "--density", "--tempDir", folder.string()},
      threads, folder / "log", progress);
  progress.begin_step("trim", 0);
  const std::uint64_t trim_bytes =
      run_program(programs.trim,
                  {"--in", whole.string(), "--out", trimmed_mesh.string(), "--trim",
                   text_of(options.trim_depth())},
                  threads, folder / "log", progress);
  surface.peak_memory_bytes = std::max(surface.peak_memory_bytes, trim_bytes);
  surface.mesh = to_mesh(read_ply_mesh(trimmed_mesh), trimmed_mesh);
  return surface;
}

PoissonSurface by_open3d(const PoissonOptions& options, const PoissonPrograms& programs,
                         const fs::path& folder, int threads, ProgressSink& progress) {
  const fs::path whole = folder / "whole.ply";
  PoissonSurface surface;
  progress.begin_step("reconstruct", 0);
  surface.peak_memory_bytes = run_program(programs.reconstruct,
                                          {(folder / "points.ply").string(), whole.string(),
                                           std::to_string(options.depth), std::to_string(threads)},
                                          threads, folder / "log", progress);
  progress.begin_step("trim", 0);
  const MeshTable table = read_ply_mesh(whole);
  const Column& depths = column_of(table, whole, "value");
  std::vector<float> values;
  values.reserve(table.vertices.rows);
  for (std::size_t i = 0; i < table.vertices.rows; ++i)
    values.push_back(static_cast<float>(depths.as_double(i)));
  surface.mesh = trimmed(to_mesh(table, whole), values, static_cast<float>(options.trim_depth()));
  return surface;
}

}  // namespace

PoissonPrograms find_poisson_programs(PoissonProvider wanted) {
  if (wanted != PoissonProvider::open3d) {
    const auto reconstruct = find_on_path("PoissonRecon"), trim = find_on_path("SurfaceTrimmer");
    if (reconstruct && trim) return {PoissonProvider::poisson_recon, *reconstruct, *trim};
  }
  if (wanted != PoissonProvider::poisson_recon) {
    if (const auto own = find_next_to_program("adasplats-poisson"))
      return {PoissonProvider::open3d, *own, {}};
  }
  throw Error(ErrorKind::unavailable,
              "screened Poisson needs an external program: put PoissonRecon and SurfaceTrimmer "
              "(github.com/mkazhdan/PoissonRecon) on PATH, or install libopen3d-dev and build "
              "adasplats again, which adds adasplats-poisson");
}

PoissonSurface poisson_surface(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                               const PoissonOptions& options, const PoissonPrograms& programs,
                               const fs::path& folder, int threads, ProgressSink& progress) {
  check(options, points.size());
  const WorkFolder work(folder);
  write_points(work.path() / "points.ply", points, normals);
  PoissonSurface surface =
      programs.provider == PoissonProvider::open3d
          ? by_open3d(options, programs, work.path(), threads, progress)
          : by_poisson_recon(options, programs, work.path(), threads, progress);
  progress.end_step();
  if (surface.mesh.triangles.empty())
    throw Error(ErrorKind::data, "the Poisson surface is empty after trimming at depth " +
                                     text_of(options.trim_depth()) +
                                     "; decrease trim or increase depth");
  return surface;
}

namespace {

class Trimmer {
 public:
  Trimmer(const TriangleMesh& mesh, std::span<const float> values, float min)
      : mesh_(mesh), values_(values), min_(min), new_index_(mesh.vertices.size(), kUnused) {}

  TriangleMesh run() {
    for (const auto& triangle : mesh_.triangles) add(triangle);
    return std::move(trimmed_);
  }

 private:
  static constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

  /// Adds a fan over the kept corners and the cuts of the edges, in the triangle's orientation.
  void add(const std::array<std::uint32_t, 3>& triangle) {
    std::array<std::uint32_t, 4> polygon{};
    std::size_t corners = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
      if (is_kept(from)) polygon[corners++] = kept(from);
      if (is_kept(from) != is_kept(to)) polygon[corners++] = cut(from, to);
    }
    for (std::size_t k = 2; k < corners; ++k)
      trimmed_.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }

  bool is_kept(std::uint32_t vertex) const { return values_[vertex] >= min_; }

  std::uint32_t added(Vec3f vertex) {
    trimmed_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(trimmed_.vertices.size() - 1);
  }

  std::uint32_t kept(std::uint32_t vertex) {
    if (new_index_[vertex] == kUnused) new_index_[vertex] = added(mesh_.vertices[vertex]);
    return new_index_[vertex];
  }

  /// The vertex where an edge has the bound's value; shared by both of its triangles.
  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [entry, is_new] = cuts_.try_emplace(std::uint64_t{low} << 32 | high, kUnused);
    if (is_new) {
      const float share = (min_ - values_[low]) / (values_[high] - values_[low]);
      entry->second =
          added(mesh_.vertices[low] + share * (mesh_.vertices[high] - mesh_.vertices[low]));
    }
    return entry->second;
  }

  const TriangleMesh& mesh_;
  std::span<const float> values_;
  float min_;
  std::vector<std::uint32_t> new_index_;
  std::unordered_map<std::uint64_t, std::uint32_t> cuts_;
  TriangleMesh trimmed_;
};

}  // namespace

TriangleMesh trimmed(const TriangleMesh& mesh, std::span<const float> values, float min) {
  if (values.size() != mesh.vertices.size())
    throw std::logic_error("trimmed: the numbers of vertices and values differ");
  return Trimmer(mesh, values, min).run();
}

std::uint64_t run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, int threads,
                          const std::filesystem::path& log, ProgressSink& progress) {
  ChildProgram child{{program.string()}, {"OMP_NUM_THREADS=" + std::to_string(threads)}, log};
  child.arguments.insert(child.arguments.end(), arguments.begin(), arguments.end());
  // By default its threads spin while they wait, which took 4 times as long on shared cores.
  if (std::getenv("OMP_WAIT_POLICY") == nullptr)
    child.environment.emplace_back("OMP_WAIT_POLICY=passive");
  const ChildResult result = run_child(child, progress);
  if (result.end == ChildEnd::done) return result.peak_memory_bytes;
  throw Error(ErrorKind::unavailable, program.string() + ": failed (exit code " +
                                          std::to_string(result.exit_code) +
                                          "): " + result.message);
}

}  // namespace adasplats
