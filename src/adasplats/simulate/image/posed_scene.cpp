// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/posed_scene.h"

#include <limits>
#include <optional>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {
namespace {

/// Whether an object is in pictures of this time.
bool is_shown(const WorldObject& object, double time_s) {
  if (object.only_scan || !object.present) return false;
  return !object.only_during ||
         (object.trajectory.front().time_s <= time_s && object.trajectory.back().time_s >= time_s);
}

ImageScene scene_of(const AnyModel& model) {
  ImageScene scene;
  scene.view = view_of(model);
  scene.origin = origin_of(model);
  scene.attributes.classes = classes_of(model);
  scene.attributes.intensities = intensities_of(model);
  if (const SplatModel* const splats = std::get_if<SplatModel>(&model)) {
    scene.groups = splats->groups;
    scene.colors = splats->colors;
  }
  return scene;
}

}  // namespace

/// The scene or an object, and where it is.
struct PosedScene::Piece {
  ImageScene own;
  RigidTransform local_from_own;  ///< local: relative to the posed scene's origin
  double scale = 1;
  std::optional<std::uint16_t> class_id;
  bool is_place = false;

  Vec3f local(Vec3f p) const {
    if (is_place) return p;  // exactly
    return vec_cast<float>(local_from_own * (scale * (own.origin + vec_cast<double>(p))));
  }
};

template <class T>
void PosedScene::Values<T>::add(std::span<const T> of, std::size_t first, std::size_t count,
                                T missing) {
  if (of.empty()) {
    all.insert(all.end(), count, missing);
    return;
  }
  const std::span<const T> part = of.subspan(first, count);
  all.insert(all.end(), part.begin(), part.end());
  any = true;
}

void PosedScene::add_values(const Piece& piece, std::size_t first, std::size_t count) {
  constexpr std::uint8_t kGrey = 184;
  if (piece.class_id) {
    classes_.all.insert(classes_.all.end(), count, *piece.class_id);
    classes_.any = true;
  } else {
    classes_.add(piece.own.attributes.classes, first, count, 0);
  }
  intensities_.add(piece.own.attributes.intensities, first, count,
                   std::numeric_limits<float>::quiet_NaN());
  groups_.add(piece.own.groups, first, count, SemanticGroup::surface);
  colors_.add(piece.own.colors, first, count, {kGrey, kGrey, kGrey});
}

void PosedScene::add_disks(const Piece& piece, bool soft) {
  const SceneView& own = piece.own.view;
  const Mat3d& turn = piece.local_from_own.rotation;
  for (Disk disk : own.disks) {
    disk.center = piece.local(disk.center);
    disk.radius *= static_cast<float>(piece.scale);
    if (!piece.is_place) disk.normal = vec_cast<float>(turn * vec_cast<double>(disk.normal));
    disks_.push_back(disk);
  }
  if (soft) {
    opacities_.insert(opacities_.end(), own.opacities.begin(), own.opacities.end());
    opacities_.resize(disks_.size(), 1.0F);
  }
  add_values(piece, 0, own.disk_count());
}

void PosedScene::add_triangles(const Piece& piece) {
  const TriangleMesh* const own = piece.own.view.mesh;
  if (own == nullptr) return;
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Vec3f& vertex : own->vertices) mesh_.vertices.push_back(piece.local(vertex));
  for (const auto& corners : own->triangles)
    mesh_.triangles.push_back({corners[0] + first, corners[1] + first, corners[2] + first});
  add_values(piece, piece.own.view.disk_count(), own->triangles.size());
}

PosedScene::PosedScene(const ImageScene& place, const World& world, double time_s)
    : labels_(place.labels), origin_(place.origin) {
  std::vector<Piece> pieces(1);
  pieces.front().own = place;
  pieces.front().is_place = true;
  for (std::size_t i = 0; i < world.object_count(); ++i) {
    const WorldObject& object = world.object(i);
    if (!is_shown(object, time_s)) continue;
    Piece& piece = pieces.emplace_back();
    piece.own = scene_of(world.geometry(object.geometry));
    piece.local_from_own = interpolate(object.trajectory, time_s);
    piece.local_from_own.translation = piece.local_from_own.translation - origin_;
    piece.scale = object.scale;
    piece.class_id = object.class_id;
  }
  for (const Piece& piece : pieces) add_disks(piece, !place.view.opacities.empty());
  for (const Piece& piece : pieces) add_triangles(piece);
}

ImageScene PosedScene::scene() const {
  ImageScene scene;
  scene.view = {disks_, mesh_.triangles.empty() ? nullptr : &mesh_, opacities_};
  scene.attributes.classes = classes_.view();
  scene.attributes.intensities = intensities_.view();
  scene.attributes.view = scene.view;
  scene.groups = groups_.view();
  scene.colors = colors_.view();
  scene.labels = labels_;
  scene.origin = origin_;
  return scene;
}

}  // namespace adasplats
