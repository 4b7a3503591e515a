// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/nuscenes_categories.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using WordAndCategory = std::pair<std::string_view, std::string_view>;

/// The first word found in the name of a class decides. Riders belong to their vehicle, as in
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
  const SemanticClass* const found = nuscenes_labels().find(name);
  if (found == nullptr) throw std::logic_error("nuscenes_category: unknown name");
  return static_cast<std::uint8_t>(found->id);
}

}  // namespace

std::span<const std::string_view> nuscenes_categories() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const SemanticClass& known : nuscenes_labels().classes())
      if (known.id != kNuscenesUnlabeled) all.push_back(known.name);
    return all;
  }();
  return names;
}

std::uint8_t nuscenes_category(std::string_view class_name) {
  const SemanticClass* const own = nuscenes_labels().find(class_name);
  if (own != nullptr && own->id != kNuscenesUnlabeled) return static_cast<std::uint8_t>(own->id);
  const std::string words = lower_case(class_name);
  for (const auto& [word, category] : kNuscenesWords)
    if (words.find(word) != std::string::npos) return index_of_category(category);
  return index_of_category("static.other");
}

}  // namespace adasplats
