// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/picked.h"

#include <nlohmann/json.hpp>
#include <span>

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

constexpr float kLongestPick_m = 1e5F;

void add_attributes(Json& json, const ViewScene& scene, std::uint32_t primitive) {
  const PrimitiveAttributes& attributes = scene.model->attributes();
  if (primitive < attributes.classes.size()) {
    const std::uint16_t id = attributes.classes[primitive];
    const SemanticClass* const known = scene.labels ? scene.labels->find(id) : nullptr;
    json["class"] = id;
    if (known != nullptr) json["class_name"] = known->name;
  }
  if (primitive < attributes.intensities.size())
    json["intensity"] = attributes.intensities[primitive];
}

void add_triangle(Json& json, const TriangleMesh& mesh, std::size_t number) {
  const Triangle triangle = mesh.triangle(number);
  const Vec3f across = cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const Vec3f normal = length(across) > 0 ? normalized(across) : Vec3f{0, 0, 1};
  json["normal"] = {normal.x, normal.y, normal.z};
}

void add_geometry(Json& json, const SceneView& view, std::uint32_t primitive) {
  if (primitive >= view.disks.size()) {
    if (primitive < view.primitive_count())
      add_triangle(json, *view.mesh, primitive - view.disk_count());
    return;
  }
  const Disk& disk = view.disks[primitive];
  json["normal"] = {disk.normal.x, disk.normal.y, disk.normal.z};
  json["radius_m"] = disk.radius;
}

}  // namespace

std::string picked_message(const ViewScene& scene, const PickMessage& pick,
                           const Executor& executor) {
  const Vec3d direction = (1 / length(pick.direction)) * pick.direction;
  const Ray ray = {vec_cast<float>(pick.origin - scene.model->origin()), 0,
                   vec_cast<float>(direction), kLongestPick_m};
  Hit hit;
  scene.model->tracer().nearest(std::span(&ray, 1), std::span(&hit, 1), executor);
  Json json = {{"type", "picked"}, {"id", pick.id}, {"hit", hit.valid()}};
  if (hit.valid()) {
    const Vec3d at = pick.origin + static_cast<double>(hit.t) * direction - scene.origin;
    json["range_m"] = hit.t;
    json["primitive"] = hit.primitive;
    json["position"] = {at.x, at.y, at.z};
    add_geometry(json, scene.model->view(), hit.primitive);
    add_attributes(json, scene, hit.primitive);
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace adasplats
