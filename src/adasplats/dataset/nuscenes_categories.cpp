// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/nuscenes_categories.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace adasplats {
namespace {

constexpr std::array<std::string_view, 32> kNuscenesCategories = {
    "noise",
    "animal",
    "human.pedestrian.adult",
    "human.pedestrian.child",
    "human.pedestrian.construction_worker",
    "human.pedestrian.personal_mobility",
    "human.pedestrian.police_officer",
    "human.pedestrian.stroller",
    "human.pedestrian.wheelchair",
    "movable_object.barrier",
    "movable_object.debris",
    "movable_object.pushable_pullable",
    "movable_object.trafficcone",
    "static_object.bicycle_rack",
    "vehicle.bicycle",
    "vehicle.bus.bendy",
    "vehicle.bus.rigid",
    "vehicle.car",
    "vehicle.construction",
    "vehicle.emergency.ambulance",
    "vehicle.emergency.police",
    "vehicle.motorcycle",
    "vehicle.trailer",
    "vehicle.truck",
    "flat.driveable_surface",
    "flat.other",
    "flat.sidewalk",
    "flat.terrain",
    "static.manmade",
    "static.other",
    "static.vegetation",
    "vehicle.ego",
};

using WordAndCategory = std::pair<std::string_view, std::string_view>;

/// The first word that a class's name holds decides. Riders belong to what they ride, as in
/// nuScenes.
constexpr WordAndCategory kNuscenesWords[] = {
    {"unlabel", "noise"},
    {"outlier", "noise"},
    {"sky", "noise"},
    {"rail-track", "flat.other"},
    {"other-object", "static.other"},
    {"other-structure", "static.manmade"},
    {"other-ground", "flat.other"},
    {"other-vehicle", "vehicle.trailer"},
    {"motorcycl", "vehicle.motorcycle"},
    {"bicycl", "vehicle.bicycle"},
    {"rider", "vehicle.bicycle"},
    {"bus", "vehicle.bus.rigid"},
    {"rails", "vehicle.bus.rigid"},
    {"tram", "vehicle.bus.rigid"},
    {"truck", "vehicle.truck"},
    {"car", "vehicle.car"},
    {"vehicle", "vehicle.car"},
    {"person", "human.pedestrian.adult"},
    {"pedestrian", "human.pedestrian.adult"},
    {"sidewalk", "flat.sidewalk"},
    {"road", "flat.driveable_surface"},
    {"lane", "flat.driveable_surface"},
    {"parking", "flat.driveable_surface"},
    {"terrain", "flat.terrain"},
    {"water", "flat.other"},
    {"ground", "flat.other"},
    {"vegetation", "static.vegetation"},
    {"trunk", "static.vegetation"},
    {"building", "static.manmade"},
    {"fence", "static.manmade"},
    {"wall", "static.manmade"},
    {"guard", "static.manmade"},
    {"bridge", "static.manmade"},
    {"pole", "static.manmade"},
    {"sign", "static.manmade"},
    {"traffic", "static.manmade"},
    {"structure", "static.manmade"},
};

std::uint8_t index_of_category(std::string_view name) {
  const auto found = std::ranges::find(kNuscenesCategories, name);
  if (found == kNuscenesCategories.end()) throw std::logic_error("nuscenes_category: no such name");
  return static_cast<std::uint8_t>(found - kNuscenesCategories.begin());
}

}  // namespace

std::span<const std::string_view> nuscenes_categories() { return kNuscenesCategories; }

std::uint8_t nuscenes_category(std::string_view class_name) {
  for (const auto& [word, category] : kNuscenesWords)
    if (class_name.find(word) != std::string_view::npos) return index_of_category(category);
  return index_of_category("static.other");
}

}  // namespace adasplats
