// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/any_model.h"

#include <limits>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/point_format.h"

namespace adasplats {
namespace {

std::pair<Vec3d, Vec3d> world_box(const SplatModel& splats) {
  const auto [low, high] = bounds(splats);
  return {splats.origin + vec_cast<double>(low), splats.origin + vec_cast<double>(high)};
}

std::pair<Vec3d, Vec3d> world_box(const MeshModel& model) {
  if (model.size() == 0) return {};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::pair<Vec3d, Vec3d> box = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const auto& corners : model.mesh.triangles) {
    for (const std::uint32_t corner : corners) {
      const Vec3d world = model.origin + vec_cast<double>(model.mesh.vertices[corner]);
      box = {min(box.first, world), max(box.second, world)};
    }
  }
  return box;
}

/// Throws for a folder (no_input).
void require_no_folder(const std::filesystem::path& path) {
  std::error_code ignored;  // loading reports what cannot be examined
  if (std::filesystem::is_directory(path, ignored))
    throw Error(ErrorKind::no_input,
                path.string() +
                    ": is a folder, but not a city; 'adasplats model' builds a model "
                    "from a folder of scans");
}

/// Throws for a file of points or text (data).
void require_no_points(const std::filesystem::path& file) {
  const PointFormat* format = format_of_extension(file);
  if (format == nullptr || format->means == ExtensionMeaning::geometry) return;
  const bool is_text = format->means == ExtensionMeaning::text;
  throw Error(ErrorKind::data,
              file.string() + ": is a " +
                  (is_text ? "text file" : "point cloud (" + std::string(format->name) + ")") +
                  ", not a model; 'adasplats model' builds one from points");
}

}  // namespace

AnyModel load_any_model(const std::filesystem::path& file) {
  require_no_folder(file);
  if (is_mesh_file(file)) return load_mesh(file);
  require_no_points(file);
  return load_model(file);
}

std::span<const std::uint16_t> classes_of(const AnyModel& model) {
  if (const auto* mesh = std::get_if<MeshModel>(&model)) return mesh->mesh.classes;
  return std::get<SplatModel>(model).classes;
}

std::span<const float> intensities_of(const AnyModel& model) {
  if (const auto* splats = std::get_if<SplatModel>(&model)) return splats->intensities;
  return {};
}

std::pair<Vec3d, Vec3d> world_box_of(const AnyModel& model) {
  return std::visit([](const auto& own) { return world_box(own); }, model);
}

std::string_view primitives_of(const AnyModel& model) {
  return std::holds_alternative<MeshModel>(model) ? "triangles" : "splats";
}

}  // namespace adasplats
