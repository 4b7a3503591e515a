// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/object_kind.h"

#include <array>
#include <string>

#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

/// The first match counts.
constexpr std::array<ObjectKind, 15> kKinds = {
    {{"regular_vehicle", "moving-car", "car", true},
     {"motorcycl", "moving-motorcyclist", "motorcycle", false},
     {"scooter", "moving-motorcyclist", "motorcycle", false},
     {"bicycl", "moving-bicyclist", "bicycle", false},
     {"cyclist", "moving-bicyclist", "bicyclist", false},
     {"pedestrian", "moving-person", "person", false},
     {"person", "moving-person", "person", false},
     {"truck", "moving-truck", "truck", true},
     {"trailer", "moving-truck", "truck", true},
     {"tram", "moving-on-rails", "on-rails", true},
     {"train", "moving-on-rails", "on-rails", true},
     {"bus", "moving-bus", "bus", true},
     {"van", "moving-car", "car", true},
     {"car", "moving-car", "car", true},
     {"vehicle", "moving-other-vehicle", "other-vehicle", true}}};

}  // namespace

ObjectKind object_kind_of(std::string_view label) {
  const std::string lower = lower_case(label);
  for (const ObjectKind& kind : kKinds)
    if (lower.find(kind.word) != std::string::npos) return kind;
  return {"", "moving-other-vehicle", "other-vehicle", false};
}

}  // namespace adasplats
