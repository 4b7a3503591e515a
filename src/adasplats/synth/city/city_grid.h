// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/city/city_land.h"
#include "adasplats/synth/world/world_plan.h"

// Private to synth/city/: the streets of a city and the land along them. Streets run east (u
// increases) and north (v increases) and cross at nodes; the grid is unbounded. Everything depends
// only on the seed and is drawn on demand.

namespace adasplats {

enum class CityAxis : std::uint8_t { east, north };

/// The section of a street between two crossings: `line` counts the streets of an axis, `block` the
/// sections along a street. East streets own a strip of kCityRow_m on both sides; north streets own
/// the area between two such strips, up to the middle of the blocks.
struct CityPieceId {
  CityAxis axis = CityAxis::east;
  int line = 0;
  int block = 0;
  auto operator<=>(const CityPieceId&) const = default;
};

/// For example "x3_y-1_north": grid position of its begin, and its axis.
std::string name_of(const CityPieceId& id);

/// A rectangle in the grid's plane, m.
struct CityRect {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  /// Distance from a position to the rectangle.
  double distance(double u, double v) const;
};

enum class BlockUse : std::uint8_t { built, park, square };

inline constexpr double kCityRow_m = 36;

class CityGrid {
 public:
  explicit CityGrid(std::uint64_t seed);

  std::uint64_t seed() const { return seed_; }
  const CityLand& land() const { return land_; }

  /// Position of node `i` along a street of `axis`: u of the i-th north street, or v of the i-th
  /// east street.
  double node(CityAxis axis, int i) const;
  /// Block of a street that contains the position `along`.
  int block_at(CityAxis axis, double along) const;
  CityRect rect(const CityPieceId& id) const;
  /// Use of the block east of north street i and north of east street j.
  BlockUse use(int i, int j) const;

  WorldKind kind(const CityPieceId& id) const;
  WorldStyle style(const CityPieceId& id) const;
  /// Lanes per direction; constant along a street.
  int lanes(CityAxis axis, int line) const;
  /// Distance from a street's axis to the center of a lane. Near a crossing it changes smoothly
  /// from one style to the next.
  double lane_center(CityAxis axis, int line, int lane, double along) const;

  /// The plan of a section; s is the distance from its begin. `bare`: only the street's profile,
  /// without plots and crossing streets.
  WorldPlan plan(const CityPieceId& id, bool bare = false) const;

  Random random(std::uint64_t purpose, std::int64_t a, std::int64_t b) const;

 private:
  std::uint64_t seed_;
  CityLand land_;
};

/// First keys of CityGrid::random, one per use.
enum class CityPurpose : std::uint64_t {
  node = 1,
  block,
  kind,
  style,
  lanes,
  piece,
  plots,
  crossing,
  furniture,
  drive,
  models,
  slots,
  density,
  walkers,
};

/// A number that identifies a street of an axis.
inline std::int64_t street_key(CityAxis axis, int line) {
  return 2 * static_cast<std::int64_t>(line) + (axis == CityAxis::north ? 1 : 0);
}

inline Random random_of(const CityGrid& grid, CityPurpose purpose, std::int64_t a, std::int64_t b) {
  return grid.random(static_cast<std::uint64_t>(purpose), a, b);
}

}  // namespace adasplats
