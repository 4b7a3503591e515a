// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/label_scheme.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace adasplats {

std::string_view name_of(SemanticGroup group) {
  switch (group) {
    case SemanticGroup::ground: return "ground";
    case SemanticGroup::surface: return "surface";
    case SemanticGroup::linear: return "linear";
    case SemanticGroup::non_surface: return "non-surface";
  }
  throw std::logic_error("name_of: no such semantic group");
}

LabelScheme::LabelScheme(std::string name, std::vector<SemanticClass> classes)
    : name_(std::move(name)), classes_(std::move(classes)) {
  std::ranges::sort(classes_, {}, &SemanticClass::id);
  const auto twin = std::ranges::adjacent_find(classes_, {}, &SemanticClass::id);
  if (twin != classes_.end())
    throw std::logic_error("LabelScheme: id " + std::to_string(twin->id) + " twice");
}

const SemanticClass* LabelScheme::find(std::uint16_t id) const {
  const auto found = std::ranges::lower_bound(classes_, id, {}, &SemanticClass::id);
  return found != classes_.end() && found->id == id ? &*found : nullptr;
}

const SemanticClass* LabelScheme::find(std::string_view class_name) const {
  const auto found = std::ranges::find(classes_, class_name, &SemanticClass::name);
  return found != classes_.end() ? &*found : nullptr;
}

// The groups follow paper section "Adaptive Splatting": "Ground: road and sidewalk; Surface:
// buildings and other similar classes that locally resemble a surface; Linear: poles, traffic
// signs, and similar objects; Non-surface: vegetation, fences, and similar objects".

const LabelScheme& semantickitti_labels() {
  using enum SemanticGroup;
  using enum Mobility;
  // Colours: semantic-kitti.yaml lists blue, green, red; here they are red, green, blue.
  static const LabelScheme scheme("semantickitti",
                                  {{0, "unlabeled", surface, fixed, {0, 0, 0}},
                                   {1, "outlier", non_surface, fixed, {255, 0, 0}},
                                   {10, "car", surface, movable, {100, 150, 245}},
                                   {11, "bicycle", non_surface, movable, {100, 230, 245}},
                                   {13, "bus", surface, movable, {100, 80, 250}},
                                   {15, "motorcycle", non_surface, movable, {30, 60, 150}},
                                   {16, "on-rails", surface, movable, {0, 0, 255}},
                                   {18, "truck", surface, movable, {80, 30, 180}},
                                   {20, "other-vehicle", surface, movable, {0, 0, 255}},
                                   {30, "person", non_surface, movable, {255, 30, 30}},
                                   {31, "bicyclist", non_surface, movable, {255, 40, 200}},
                                   {32, "motorcyclist", non_surface, movable, {150, 30, 90}},
                                   {40, "road", ground, fixed, {255, 0, 255}},
                                   {44, "parking", ground, fixed, {255, 150, 255}},
                                   {48, "sidewalk", ground, fixed, {75, 0, 75}},
                                   {49, "other-ground", ground, fixed, {175, 0, 75}},
                                   {50, "building", surface, fixed, {255, 200, 0}},
                                   {51, "fence", non_surface, fixed, {255, 120, 50}},
                                   {52, "other-structure", surface, fixed, {255, 150, 0}},
                                   {60, "lane-marking", ground, fixed, {150, 255, 170}},
                                   {70, "vegetation", non_surface, fixed, {0, 175, 0}},
                                   {71, "trunk", linear, fixed, {135, 60, 0}},
                                   {72, "terrain", ground, fixed, {150, 240, 80}},
                                   {80, "pole", linear, fixed, {255, 240, 150}},
                                   {81, "traffic-sign", linear, fixed, {255, 0, 0}},
                                   {99, "other-object", surface, fixed, {50, 255, 255}},
                                   {252, "moving-car", surface, moving, {100, 150, 245}},
                                   {253, "moving-bicyclist", non_surface, moving, {255, 40, 200}},
                                   {254, "moving-person", non_surface, moving, {255, 30, 30}},
                                   {255, "moving-motorcyclist", non_surface, moving, {150, 30, 90}},
                                   {256, "moving-on-rails", surface, moving, {0, 0, 255}},
                                   {257, "moving-bus", surface, moving, {100, 80, 250}},
                                   {258, "moving-truck", surface, moving, {80, 30, 180}},
                                   {259, "moving-other-vehicle", surface, moving, {0, 0, 255}}});
  return scheme;
}

const LabelScheme& paris_carla_3d_labels() {
  using enum SemanticGroup;
  using enum Mobility;
  // Colours: CARLA's semantic segmentation camera.
  static const LabelScheme scheme("paris-carla-3d",
                                  {{0, "unlabeled", surface, fixed, {0, 0, 0}},
                                   {1, "building", surface, fixed, {70, 70, 70}},
                                   {2, "fence", non_surface, fixed, {100, 40, 40}},
                                   {3, "other", surface, fixed, {55, 90, 80}},
                                   {4, "pedestrian", non_surface, movable, {220, 20, 60}},
                                   {5, "pole", linear, fixed, {153, 153, 153}},
                                   {6, "road-line", ground, fixed, {157, 234, 50}},
                                   {7, "road", ground, fixed, {128, 64, 128}},
                                   {8, "sidewalk", ground, fixed, {244, 35, 232}},
                                   {9, "vegetation", non_surface, fixed, {107, 142, 35}},
                                   {10, "vehicles", surface, movable, {0, 0, 142}},
                                   {11, "wall", surface, fixed, {102, 102, 156}},
                                   {12, "traffic-sign", linear, fixed, {220, 220, 0}},
                                   {13, "sky", surface, fixed, {70, 130, 180}},
                                   {14, "ground", ground, fixed, {81, 0, 81}},
                                   {15, "bridge", surface, fixed, {150, 100, 100}},
                                   {16, "rail-track", ground, fixed, {230, 150, 140}},
                                   {17, "guard-rail", non_surface, fixed, {180, 165, 180}},
                                   {18, "traffic-light", linear, fixed, {250, 170, 30}},
                                   {19, "static", surface, fixed, {110, 190, 160}},
                                   {20, "dynamic", surface, movable, {170, 120, 50}},
                                   {21, "water", ground, fixed, {45, 60, 150}},
                                   {22, "terrain", ground, fixed, {145, 170, 100}}});
  return scheme;
}

}  // namespace adasplats
