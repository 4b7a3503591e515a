// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/city/city_land.h"
#include "adasplats/synth/world/world_plan.h"

// Inside synth/city/: which streets a city has and what stands along them. Streets run east (u
// grows) and north (v grows) and cross at nodes; the grid has no end. All of it depends on the seed
// alone and is drawn where it is asked for.

namespace adasplats {

enum class CityAxis : std::uint8_t { east, north };

/// The part of a street between two crossings: `line` counts the streets of its axis, `block` the
/// parts along it. Streets to the east keep a strip of kCityRow_m on both sides for themselves;
/// those to the north have what is between two such strips, to the middle of the blocks.
struct CityPieceId {
  CityAxis axis = CityAxis::east;
  int line = 0;
  int block = 0;
  auto operator<=>(const CityPieceId&) const = default;
};

/// "x3_y-1_north": where it begins on the grid, and its axis.
std::string name_of(const CityPieceId& id);

/// A rectangle of the grid's plane, m.
struct CityRect {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  /// From a place to the nearest point of it.
  double distance(double u, double v) const;
};

enum class BlockUse : std::uint8_t { built, park, square };

inline constexpr double kCityRow_m = 36;

class CityGrid {
 public:
  explicit CityGrid(std::uint64_t seed);

  std::uint64_t seed() const { return seed_; }
  const CityLand& land() const { return land_; }

  /// Where node `i` of a street along `axis` is, along it: u of the i-th street to the north, v of
  /// the i-th to the east.
  double node(CityAxis axis, int i) const;
  /// The block of a street that a place along it is in.
  int block_at(CityAxis axis, double along) const;
  CityRect rect(const CityPieceId& id) const;
  /// The block east of north street i and north of east street j.
  BlockUse use(int i, int j) const;

  WorldKind kind(const CityPieceId& id) const;
  WorldStyle style(const CityPieceId& id) const;
  /// Lanes each way, of the whole street.
  int lanes(CityAxis axis, int line) const;
  /// From the axis of a street to the middle of a lane; goes over from one style to the next about
  /// the crossing between them.
  double lane_center(CityAxis axis, int line, int lane, double along) const;

  /// The plan of a piece: s runs along it from its beginning. `bare`: the profile of the street
  /// alone, without plots and what crosses.
  WorldPlan plan(const CityPieceId& id, bool bare = false) const;

  Random random(std::uint64_t purpose, std::int64_t a, std::int64_t b) const;

 private:
  std::uint64_t seed_;
  CityLand land_;
};

/// First words of CityGrid::random, one for each thing that draws.
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

/// A number that stands for a street of an axis.
inline std::int64_t street_key(CityAxis axis, int line) {
  return 2 * static_cast<std::int64_t>(line) + (axis == CityAxis::north ? 1 : 0);
}

inline Random random_of(const CityGrid& grid, CityPurpose purpose, std::int64_t a, std::int64_t b) {
  return grid.random(static_cast<std::uint64_t>(purpose), a, b);
}

}  // namespace adasplats
