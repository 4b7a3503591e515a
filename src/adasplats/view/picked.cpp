// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/picked.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <span>

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

constexpr float kMaxPick_m = 1e5F;

void add_class(Json& json, const ViewScene& scene, std::uint16_t id) {
  const SemanticClass* const known = scene.labels ? scene.labels->find(id) : nullptr;
  json["class"] = id;
  if (known != nullptr) json["class_name"] = known->name;
}

void add_attributes(Json& json, const ViewScene& scene, std::uint32_t primitive) {
  const PrimitiveAttributes& attributes = scene.model->attributes();
  if (primitive < attributes.classes.size()) add_class(json, scene, attributes.classes[primitive]);
  if (primitive < attributes.intensities.size())
    json["intensity"] = attributes.intensities[primitive];
}

void add_triangle(Json& json, const TriangleMesh& mesh, std::size_t number) {
  const Triangle triangle = mesh.triangle(number);
  const Vec3f across = cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const Vec3f normal = length(across) > 0 ? normalized(across) : Vec3f{0, 0, 1};
  json["normal"] = {normal.x, normal.y, normal.z};
}

void add_disk(Json& json, const Disk& disk) {
  json["normal"] = {disk.normal.x, disk.normal.y, disk.normal.z};
  json["radius_m"] = disk.radius;
}

void add_geometry(Json& json, const SceneView& view, std::uint32_t primitive) {
  if (primitive >= view.disks.size()) {
    if (primitive < view.primitive_count())
      add_triangle(json, *view.mesh, primitive - view.disk_count());
    return;
  }
  add_disk(json, view.disks[primitive]);
}

/// Adds the hit in a model in memory; false: no hit.
bool add_hit_of_model(Json& json, const ViewScene& scene, const Ray& ray,
                      const Executor& executor) {
  Hit hit;
  scene.model->tracer().nearest(std::span(&ray, 1), std::span(&hit, 1), executor);
  if (!hit.valid()) return false;
  json["range_m"] = hit.t;
  json["primitive"] = hit.primitive;
  add_geometry(json, scene.model->view(), hit.primitive);
  add_attributes(json, scene, hit.primitive);
  return true;
}

/// Adds the hit in a city on disk; false: no hit.
bool add_hit_of_city(Json& json, const ViewScene& scene, const Ray& ray) {
  const std::optional<CityHit> hit = scene.picker->nearest(ray);
  if (!hit) return false;
  json["range_m"] = hit->range_m;
  json["primitive"] = hit->splat;
  add_disk(json, hit->disk);
  if (hit->class_id) add_class(json, scene, *hit->class_id);
  if (hit->intensity) json["intensity"] = *hit->intensity;
  return true;
}

}  // namespace

std::string picked_message(const ViewScene& scene, const PickMessage& pick,
                           const Executor& executor) {
  const Vec3d direction = (1 / length(pick.direction)) * pick.direction;
  const Ray ray = {vec_cast<float>(pick.origin - scene.place->origin()), 0,
                   vec_cast<float>(direction), kMaxPick_m};
  Json json = {{"type", "picked"}, {"id", pick.id}, {"hit", false}};
  const bool hit = scene.model != nullptr ? add_hit_of_model(json, scene, ray, executor)
                                          : add_hit_of_city(json, scene, ray);
  if (hit) {
    json["hit"] = true;
    const Vec3d at = pick.origin + json["range_m"].get<double>() * direction - scene.origin;
    json["position"] = {at.x, at.y, at.z};
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace adasplats
