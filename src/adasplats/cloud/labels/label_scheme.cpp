// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/label_scheme.h"

#include <algorithm>
#include <array>
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

// Groups as above; colours are our own, alike for like classes.

const LabelScheme& pandaset_labels() {
  using enum SemanticGroup;
  using enum Mobility;
  static const LabelScheme scheme(
      "pandaset", {{0, "unlabeled", surface, fixed, {0, 0, 0}},
                   {1, "Smoke", non_surface, fixed, {120, 120, 120}},
                   {2, "Exhaust", non_surface, fixed, {130, 120, 110}},
                   {3, "Spray or rain", non_surface, fixed, {110, 130, 150}},
                   {4, "Reflection", non_surface, fixed, {200, 200, 220}},
                   {5, "Vegetation", non_surface, fixed, {0, 175, 0}},
                   {6, "Ground", ground, fixed, {150, 240, 80}},
                   {7, "Road", ground, fixed, {255, 0, 255}},
                   {8, "Lane Line Marking", ground, fixed, {150, 255, 170}},
                   {9, "Stop Line Marking", ground, fixed, {130, 235, 170}},
                   {10, "Other Road Marking", ground, fixed, {110, 215, 170}},
                   {11, "Sidewalk", ground, fixed, {75, 0, 75}},
                   {12, "Driveway", ground, fixed, {255, 150, 255}},
                   {13, "Car", surface, movable, {100, 150, 245}},
                   {14, "Pickup Truck", surface, movable, {90, 120, 230}},
                   {15, "Medium-sized Truck", surface, movable, {80, 60, 200}},
                   {16, "Semi-truck", surface, movable, {80, 30, 180}},
                   {17, "Towed Object", surface, movable, {60, 60, 160}},
                   {18, "Motorcycle", non_surface, movable, {30, 60, 150}},
                   {19, "Other Vehicle - Construction Vehicle", surface, movable, {0, 40, 230}},
                   {20, "Other Vehicle - Uncommon", surface, movable, {0, 0, 255}},
                   {21, "Other Vehicle - Pedicab", surface, movable, {40, 40, 255}},
                   {22, "Emergency Vehicle", surface, movable, {0, 90, 255}},
                   {23, "Bus", surface, movable, {100, 80, 250}},
                   {24, "Personal Mobility Device", non_surface, movable, {150, 30, 90}},
                   {25, "Motorized Scooter", non_surface, movable, {60, 90, 180}},
                   {26, "Bicycle", non_surface, movable, {100, 230, 245}},
                   {27, "Train", surface, movable, {0, 0, 205}},
                   {28, "Trolley", surface, movable, {20, 0, 205}},
                   {29, "Tram / Subway", surface, movable, {40, 0, 205}},
                   {30, "Pedestrian", non_surface, movable, {255, 30, 30}},
                   {31, "Pedestrian with Object", non_surface, movable, {255, 60, 60}},
                   {32, "Animals - Bird", non_surface, movable, {230, 90, 140}},
                   {33, "Animals - Other", non_surface, movable, {230, 60, 140}},
                   {34, "Pylons", linear, fixed, {255, 140, 0}},
                   {35, "Road Barriers", non_surface, fixed, {255, 120, 50}},
                   {36, "Signs", linear, fixed, {255, 0, 0}},
                   {37, "Cones", linear, fixed, {255, 160, 0}},
                   {38, "Construction Signs", linear, fixed, {255, 60, 0}},
                   {39, "Temporary Construction Barriers", non_surface, fixed, {235, 120, 50}},
                   {40, "Rolling Containers", surface, movable, {120, 90, 60}},
                   {41, "Building", surface, fixed, {255, 200, 0}},
                   {42, "Other Static Object", surface, fixed, {50, 255, 255}}});
  return scheme;
}

const LabelScheme& nuscenes_labels() {
  using enum SemanticGroup;
  using enum Mobility;
  static const LabelScheme scheme(
      "nuscenes", {{0, "noise", non_surface, fixed, {0, 0, 0}, true},
                   {1, "animal", non_surface, movable, {230, 60, 140}},
                   {2, "human.pedestrian.adult", non_surface, movable, {255, 30, 30}},
                   {3, "human.pedestrian.child", non_surface, movable, {255, 60, 60}},
                   {4, "human.pedestrian.construction_worker", non_surface, movable, {255, 90, 30}},
                   {5, "human.pedestrian.personal_mobility", non_surface, movable, {150, 30, 90}},
                   {6, "human.pedestrian.police_officer", non_surface, movable, {220, 30, 90}},
                   {7, "human.pedestrian.stroller", non_surface, movable, {220, 90, 90}},
                   {8, "human.pedestrian.wheelchair", non_surface, movable, {200, 60, 120}},
                   {9, "movable_object.barrier", non_surface, fixed, {255, 120, 50}},
                   {10, "movable_object.debris", non_surface, fixed, {160, 110, 70}},
                   {11, "movable_object.pushable_pullable", surface, movable, {120, 90, 60}},
                   {12, "movable_object.trafficcone", linear, fixed, {255, 160, 0}},
                   {13, "static_object.bicycle_rack", non_surface, fixed, {190, 120, 50}},
                   {14, "vehicle.bicycle", non_surface, movable, {100, 230, 245}},
                   {15, "vehicle.bus.bendy", surface, movable, {120, 80, 250}},
                   {16, "vehicle.bus.rigid", surface, movable, {100, 80, 250}},
                   {17, "vehicle.car", surface, movable, {100, 150, 245}},
                   {18, "vehicle.construction", surface, movable, {0, 40, 230}},
                   {19, "vehicle.emergency.ambulance", surface, movable, {0, 90, 255}},
                   {20, "vehicle.emergency.police", surface, movable, {0, 120, 255}},
                   {21, "vehicle.motorcycle", non_surface, movable, {30, 60, 150}},
                   {22, "vehicle.trailer", surface, movable, {60, 60, 160}},
                   {23, "vehicle.truck", surface, movable, {80, 30, 180}},
                   {24, "flat.driveable_surface", ground, fixed, {255, 0, 255}},
                   {25, "flat.other", ground, fixed, {175, 0, 75}},
                   {26, "flat.sidewalk", ground, fixed, {75, 0, 75}},
                   {27, "flat.terrain", ground, fixed, {150, 240, 80}},
                   {28, "static.manmade", surface, fixed, {255, 200, 0}},
                   {29, "static.other", surface, fixed, {50, 255, 255}},
                   {30, "static.vegetation", non_surface, fixed, {0, 175, 0}},
                   {31, "vehicle.ego", surface, movable, {90, 90, 90}},
                   {kNuscenesUnlabeled, "unlabeled", surface, fixed, {0, 0, 0}}});
  return scheme;
}

namespace {

std::vector<SemanticClass> asprs_classes() {
  using enum SemanticGroup;
  using enum Mobility;
  std::vector<SemanticClass> classes = {
      {0, "never classified", surface, fixed, {0, 0, 0}},
      {1, "unclassified", surface, fixed, {170, 170, 170}},
      {2, "ground", ground, fixed, {150, 240, 80}},
      {3, "low vegetation", non_surface, fixed, {0, 205, 0}},
      {4, "medium vegetation", non_surface, fixed, {0, 175, 0}},
      {5, "high vegetation", non_surface, fixed, {0, 135, 0}},
      {6, "building", surface, fixed, {255, 200, 0}},
      {7, "low noise", non_surface, fixed, {255, 0, 0}, true},
      {8, "model key point", ground, fixed, {190, 240, 140}},
      {9, "water", ground, fixed, {60, 140, 255}},
      {10, "rail", ground, fixed, {175, 0, 75}},
      {11, "road surface", ground, fixed, {255, 0, 255}},
      {12, "overlap", surface, fixed, {120, 120, 150}},
      {13, "wire guard", linear, fixed, {255, 220, 120}},
      {14, "wire conductor", linear, fixed, {255, 240, 150}},
      {15, "transmission tower", linear, fixed, {255, 150, 0}},
      {16, "wire connector", linear, fixed, {255, 180, 90}},
      {17, "bridge deck", ground, fixed, {255, 150, 255}},
      {18, "high noise", non_surface, fixed, {200, 0, 0}, true},
      {19, "overhead structure", surface, fixed, {220, 160, 90}},
      {20, "ignored ground", ground, fixed, {130, 180, 90}},
      {21, "snow", ground, fixed, {240, 240, 255}},
      {22, "temporal exclusion", non_surface, fixed, {90, 90, 90}}};
  constexpr std::uint16_t kFirstOfUsers = 64, kLast = 255;
  for (auto id = static_cast<std::uint16_t>(classes.size()); id <= kLast; ++id) {
    const auto shade = [id](unsigned factor) {
      return static_cast<std::uint8_t>(60 + id * factor % 180);
    };
    classes.push_back({id,
                       (id < kFirstOfUsers ? "reserved " : "user class ") + std::to_string(id),
                       surface,
                       fixed,
                       {shade(37), shade(73), shade(119)}});
  }
  return classes;
}

}  // namespace

const LabelScheme& asprs_labels() {
  static const LabelScheme scheme("asprs", asprs_classes());
  return scheme;
}

std::span<const LabelScheme* const> known_label_schemes() {
  static const std::array schemes = {&semantickitti_labels(), &paris_carla_3d_labels(),
                                     &pandaset_labels(), &nuscenes_labels(), &asprs_labels()};
  return schemes;
}

}  // namespace adasplats
