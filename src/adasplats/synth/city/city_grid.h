// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/world/world_parts.h"
#include "adasplats/synth/world/world_plan.h"

// Private to synth/city/: the streets of a city and the land along them. Streets run east (u
// increases) and north (v increases) and cross at nodes; the grid is unbounded. Positions on its
// plane are (u, v) in m. Everything depends only on the seed and is drawn on demand.

namespace adasplats {

/// Bends the straight lines of the grid gently and gives them heights. Smooth and unbounded, so
/// that streets, blocks and sections join without seams.
class CityLand {
 public:
  explicit CityLand(std::uint64_t seed);

  /// World coordinates of a grid position; z is the height of the land.
  Vec3d at(double u, double v) const;

 private:
  struct Wave {
    double amplitude = 0, length_m = 1, phase = 0;
    double at(double t) const;
  };
  struct Hill {
    Wave wave;
    double east = 1, north = 0;  ///< direction of the slope
  };

  std::array<Wave, 2> shift_east_;   ///< of u as a function of v
  std::array<Wave, 2> shift_north_;  ///< of v as a function of u
  std::array<Hill, 3> hills_;
};

/// Maximum shift of the grid's lines, m.
inline constexpr double kMaxBend_m = 16;

enum class CityAxis : std::uint8_t { east, north };

/// The section of a street between two crossings: `line` counts the streets of an axis, `block` the
/// sections along a street. East streets own a strip of kCityRow_m on both sides; north streets own
/// the area between two such strips, up to the middle of the blocks.
struct CitySectionId {
  CityAxis axis = CityAxis::east;
  int line = 0;
  int block = 0;
  auto operator<=>(const CitySectionId&) const = default;
};

/// For example "x3_y-1_north": grid position of its begin, and its axis.
std::string name_of(const CitySectionId& id);

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
  CityRect rect(const CitySectionId& id) const;
  /// Use of the block east of north street i and north of east street j.
  BlockUse use(int i, int j) const;

  WorldKind kind(const CitySectionId& id) const;
  WorldStyle style(const CitySectionId& id) const;
  /// Lanes per direction; constant along a street.
  int lanes(CityAxis axis, int line) const;
  /// Distance from a street's axis to the center of a lane. Near a crossing it changes smoothly
  /// from one style to the next.
  double lane_center(CityAxis axis, int line, int lane, double along) const;

  /// The plan of a section; s is the distance from its begin. `bare`: only the street's profile,
  /// without plots and crossing streets.
  WorldPlan plan(const CitySectionId& id, bool bare = false) const;

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
  section,
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

/// The area that a crossing street occupies.
struct CityCrossing {
  double reach_m = 0;  ///< from the center of the crossing to the end of its sidewalk
};

/// The quarter of a crossing on one side of an east section, at its begin or end: appends the north
/// street with its sidewalk up to the edge of the section, and the road markings. `profile` is the
/// bare plan of the section.
CityCrossing add_crossing(const CityGrid& grid, const CitySectionId& id, const WorldPlan& profile,
                          int side, bool at_end, std::vector<Patch>& patches);
/// Traffic lights or signs at the corners of a section's crossings.
void add_crossing_furniture(const CityGrid& grid, const CitySectionId& id, const WorldPlan& plan,
                            MeshBuilder& builder);

/// Ground patches of parks and squares.
void add_open_ground(const CitySectionId& id, const WorldPlan& profile,
                     const std::vector<WorldPlot>& plots, std::vector<Patch>& patches);
/// Trees, benches, lamps, stalls and people in parks and squares. Instance ids start at `instance`;
/// returns the first unused one.
std::uint16_t add_open_spaces(const CityGrid& grid, const CitySectionId& id, const WorldPlan& plan,
                              std::uint16_t instance, MeshBuilder& builder);

}  // namespace adasplats
