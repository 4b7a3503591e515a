// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

/// A scene that rays can be cast into: splats or triangles. The functions below read what both
/// have; std::get_if gives access to the rest.
using AnyModel = std::variant<SplatModel, MeshModel>;

/// Loads a mesh or a splat model; the file's content decides which. Errors: no_input (a folder),
/// data (a file of points or text), those of load_mesh and load_model.
AnyModel load_any_model(const std::filesystem::path& file);

inline SceneView view_of(const AnyModel& model) {
  return std::visit([](const auto& own) { return own.view(); }, model);
}
inline Vec3d origin_of(const AnyModel& model) {
  return std::visit([](const auto& own) { return own.origin; }, model);
}
inline const Crs& crs_of(const AnyModel& model) {
  return std::visit([](const auto& own) -> const Crs& { return own.crs; }, model);
}
inline const std::string& label_scheme_of(const AnyModel& model) {
  return std::visit([](const auto& own) -> const std::string& { return own.label_scheme; }, model);
}
/// One per primitive; empty if the model has none.
std::span<const std::uint16_t> classes_of(const AnyModel& model);
/// One per primitive; empty if the model has none.
std::span<const float> intensities_of(const AnyModel& model);
/// Bounding box of all disks or triangles in world coordinates, m; a point for an empty model.
std::pair<Vec3d, Vec3d> world_box_of(const AnyModel& model);
/// "splats" or "triangles".
std::string_view primitives_of(const AnyModel& model);

}  // namespace adasplats
