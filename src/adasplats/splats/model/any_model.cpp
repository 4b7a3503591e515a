// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/any_model.h"

#include <limits>

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

}  // namespace

AnyModel load_any_model(const std::filesystem::path& file) {
  if (is_mesh_file(file)) return load_mesh(file);
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
