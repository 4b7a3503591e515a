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

/// What rays are cast into: splats or triangles. What both have is asked for by the functions
/// below; what one alone has by std::get_if.
using AnyModel = std::variant<SplatModel, MeshModel>;

/// A mesh or a splat model, known by the content of the file. Errors: those of load_mesh and
/// load_model.
AnyModel load_any_model(const std::filesystem::path& file);

inline SceneView view_of(const AnyModel& place) {
  return std::visit([](const auto& model) { return model.view(); }, place);
}
inline Vec3d origin_of(const AnyModel& place) {
  return std::visit([](const auto& model) { return model.origin; }, place);
}
inline const Crs& crs_of(const AnyModel& place) {
  return std::visit([](const auto& model) -> const Crs& { return model.crs; }, place);
}
inline const std::string& label_scheme_of(const AnyModel& place) {
  return std::visit([](const auto& model) -> const std::string& { return model.label_scheme; },
                    place);
}
/// One a primitive; empty without.
std::span<const std::uint16_t> classes_of(const AnyModel& place);
/// Likewise.
std::span<const float> intensities_of(const AnyModel& place);
/// Box of all disks or triangles, world coordinates; a point where there are none.
std::pair<Vec3d, Vec3d> world_box_of(const AnyModel& place);
/// "splats" or "triangles".
std::string_view primitives_of(const AnyModel& place);

}  // namespace adasplats
