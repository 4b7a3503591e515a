// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/epsg_units.h"

#include <span>

#include "adasplats/io/base/epsg_unit_table.h"

namespace adasplats {
namespace {

std::optional<std::uint16_t> unit_of(std::uint16_t system, std::span<const EpsgUnitRange> ranges) {
  constexpr std::uint16_t kOtherBlocks = 20000;  // UTM zones and others, which are complete
  if (system > kNewestEpsgSystem && system < kOtherBlocks) return std::nullopt;
  for (const EpsgUnitRange& range : ranges)
    if (system >= range.first && system <= range.last) return range.unit;
  return kEpsgMetre;
}

}  // namespace

std::optional<std::string> foreign_length_of(std::uint16_t unit) {
  constexpr std::uint16_t kFirst = 9000, kLast = 9099;  // lengths, except the chain of 9301
  constexpr std::uint16_t kTruncatedChain = 9301;
  const bool is_length = (unit >= kFirst && unit <= kLast) || unit == kTruncatedChain;
  if (unit == kEpsgMetre || !is_length) return std::nullopt;
  switch (unit) {
    case 9002: return "feet (0.3048 m)";
    case 9003: return "US survey feet (1200/3937 m)";
    case 9036: return "kilometres";
    default: return "the unit EPSG " + std::to_string(unit);
  }
}

std::optional<std::uint16_t> unit_of_projected_system(std::uint16_t system) {
  return unit_of(system, kProjectedUnits);
}

std::optional<std::uint16_t> unit_of_vertical_system(std::uint16_t system) {
  return unit_of(system, kVerticalUnits);
}

}  // namespace adasplats
