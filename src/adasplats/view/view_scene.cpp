// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/view_scene.h"

#include <algorithm>

#include "adasplats/view/street_pose.h"

namespace adasplats {
namespace {

/// Positions relative to another origin; `storage` holds them where they differ.
std::span<const Vec3f> relative_to_origin(std::span<const Vec3f> positions, Vec3d from, Vec3d to,
                                          std::vector<Vec3f>& storage) {
  const Vec3d shift = from - to;
  if (shift.x == 0 && shift.y == 0 && shift.z == 0) return positions;
  storage.reserve(positions.size());
  for (const Vec3f& p : positions) storage.push_back(vec_cast<float>(vec_cast<double>(p) + shift));
  return storage;
}

/// Number of samples of a layer for finding a street.
constexpr std::size_t kMaxSamples = 400'000;

bool has_nonzero_class(std::span<const std::uint16_t> classes) {
  return std::ranges::any_of(classes, [](std::uint16_t id) { return id != 0; });
}

/// Whether intensities differ; a constant one carries no information.
bool has_varying_intensity(std::span<const float> intensities) {
  return std::ranges::any_of(intensities,
                             [&](float value) { return value != intensities.front(); });
}

/// A corner of every n-th triangle.
std::vector<Vec3f> samples_of(const MeshTree& tree) {
  const std::size_t step = 1 + tree.input_size() / kMaxSamples;
  std::vector<Vec3f> samples;
  for (std::size_t n = 0; n < tree.nodes().size(); ++n)
    for (std::size_t i = 0; i < tree.elements(n).size(); i += step)
      samples.push_back(tree.elements(n)[i].corners[0]);
  return samples;
}

/// Positions of every n-th element of the leaves, as sent to the page.
std::vector<Vec3f> samples_of(const ViewLayer& layer) {
  if (layer.city) return layer.city->samples(kMaxSamples);
  if (layer.mesh) return samples_of(*layer.mesh);
  const LevelTree& tree = layer.tree;
  const std::size_t step = 1 + tree.input_size() / kMaxSamples;
  std::vector<Vec3f> samples;
  std::size_t number = 0;
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    const LevelNode& node = tree.nodes()[n];
    if (node.child_count > 0) continue;
    for (const LevelElement& element : tree.elements(n)) {
      if (number++ % step != 0) continue;
      Vec3f at;
      for (int axis = 0; axis < 3; ++axis)
        at[axis] = node.low[axis] + (node.high[axis] - node.low[axis]) *
                                        static_cast<float>(element.position[axis]) / 65535;
      samples.push_back(at);
    }
  }
  return samples;
}

}  // namespace

std::span<const LevelNode> nodes_of(const ViewLayer& layer) {
  if (layer.city) return layer.city->nodes();
  return layer.mesh ? layer.mesh->nodes() : layer.tree.nodes();
}

std::string node_bytes(const ViewLayer& layer, std::size_t node) {
  if (layer.city) return layer.city->node_bytes(node);
  // As characters, for the body of a reply.
  const auto text_of = [](std::span<const std::byte> bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  if (layer.mesh) return text_of(std::as_bytes(layer.mesh->elements(node)));
  return text_of(std::as_bytes(layer.tree.elements(node))) +
         text_of(std::as_bytes(layer.tree.colors(node)));
}

ByteRange intensity_range_of(const ViewLayer& layer) {
  return layer.city ? layer.city->facts().intensity_range : layer.tree.intensity_range();
}

ViewLayer city_layer(std::string name, std::shared_ptr<const CityLevels> levels) {
  const LevelFacts& facts = levels->facts();
  return {std::move(name),
          true,
          facts.has_classes,
          facts.has_intensities,
          false,
          LevelTree({}, {}, Executor(1)),
          {},
          {},
          std::move(levels)};
}

std::size_t size_of(const ViewLayer& layer) {
  if (layer.city) return layer.city->facts().splats;
  return layer.mesh ? layer.mesh->input_size() : layer.tree.input_size();
}

ViewLayer splat_layer(std::string name, const SplatModel& model, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor) {
  constexpr float kHidden_m = 1e-3F;  // radius of disks that are hardly opaque anywhere
  std::vector<Disk> storage;
  LevelInput input{.disks = model.disks,
                   .positions = {},
                   .classes = model.classes,
                   .intensities = model.intensities,
                   .errors_m = errors_m,
                   .colors = model.colors};
  const Vec3d shift = model.origin - origin;
  if (!model.opacities.empty() || shift.x != 0 || shift.y != 0 || shift.z != 0) {
    storage = opaque_disks(model);
    for (Disk& disk : storage) {
      disk.center = vec_cast<float>(vec_cast<double>(disk.center) + shift);
      if (disk.radius == 0) disk.radius = kHidden_m;
    }
    input.disks = storage;
  }
  return {std::move(name),
          true,
          has_nonzero_class(model.classes),
          has_varying_intensity(model.intensities),
          !errors_m.empty(),
          LevelTree(input, {}, executor),
          {},
          {}};
}

ViewLayer mesh_layer(std::string name, const MeshModel& model, std::span<const float> intensities,
                     Vec3d origin) {
  return {std::move(name),
          false,
          has_nonzero_class(model.mesh.classes),
          has_varying_intensity(intensities),
          false,
          LevelTree({}, {}, Executor(1)),
          MeshTree(model.mesh, intensities, model.origin - origin),
          {}};
}

ViewLayer model_layer(std::string name, const AnyModel& model, Vec3d origin,
                      const Executor& executor) {
  if (const auto* const splats = std::get_if<SplatModel>(&model))
    return splat_layer(std::move(name), *splats, {}, origin, executor);
  return mesh_layer(std::move(name), std::get<MeshModel>(model), intensities_of(model), origin);
}

ViewLayer point_layer(std::string name, const PointCloud& cloud, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor) {
  std::vector<Vec3f> storage;
  std::vector<ColorBytes> colors = file_colors(cloud);
  if (!has_several(colors)) colors.clear();
  const LevelInput input{
      .disks = {},
      .positions = relative_to_origin(cloud.positions, cloud.origin, origin, storage),
      .classes = cloud.classes,
      .intensities = cloud.intensities,
      .errors_m = errors_m,
      .colors = colors};
  return {std::move(name),
          false,
          has_nonzero_class(cloud.classes),
          has_varying_intensity(cloud.intensities),
          !errors_m.empty(),
          LevelTree(input, {}, executor),
          {},
          {}};
}

void add_world(ViewScene& scene, const Executor& executor) {
  const World* const world = scene.model == nullptr ? nullptr : scene.model->world();
  if (world == nullptr) return;
  std::vector<std::size_t> number_of(world->geometry_count(), world->geometry_count());
  for (std::size_t i = 0; i < world->object_count(); ++i) {
    const WorldObject& object = world->object(i);
    if (object.only_scan) continue;
    std::size_t& number = number_of[object.geometry];
    if (number == world->geometry_count()) {
      const AnyModel& geometry = world->geometry(object.geometry);
      number = scene.geometries.size();
      scene.geometries.push_back(model_layer(object.name, geometry, {}, executor));
    }
    scene.objects.push_back({object.name, i, number});
  }
}

RigidTransform start_pose_of(const ViewScene& scene, double mount_height_m,
                             const Executor& executor) {
  for (const ViewSequence& sequence : scene.sequences)
    if (!sequence.scans.trajectory.empty())
      return sequence.scans.trajectory.front().world_from_sensor;
  for (const auto& [name, poses] : scene.trajectories)
    if (!poses.empty()) return poses.front().world_from_sensor;
  if (!scene.layers.empty()) {
    if (auto pose = street_pose(samples_of(scene.layers.front()), mount_height_m)) {
      pose->translation = pose->translation + scene.origin;
      return *pose;
    }
  }
  const auto [low, high] = scene.middle_box;
  RigidTransform pose;
  pose.translation = 0.5 * (low + high);
  pose.translation.z = low.z + mount_height_m;
  if (scene.model == nullptr) return pose;
  // A ray straight down hits the ground or a roof.
  const Vec3d above = {pose.translation.x, pose.translation.y, high.z + 1};
  const Ray ray = {vec_cast<float>(above - scene.model->origin()),
                   0,
                   {0, 0, -1},
                   static_cast<float>(2 * (high.z - low.z) + 100)};
  Hit hit;
  scene.model->tracer().nearest(std::span(&ray, 1), std::span(&hit, 1), executor);
  if (hit.valid()) pose.translation.z = above.z - static_cast<double>(hit.t) + mount_height_m;
  return pose;
}

}  // namespace adasplats
