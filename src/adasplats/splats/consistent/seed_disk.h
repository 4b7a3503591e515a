// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "adasplats/cloud/points/origin_kind.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {

/// Points and the sensor position of each; `sensors` is null without sensor positions. Without
/// `kinds` all sensor positions were measured.
struct MeasuredPoints {
  const Vec3f* positions = nullptr;
  const Vec3f* sensors = nullptr;
  const OriginKind* kinds = nullptr;

  ADASPLATS_HD OriginKind kind(std::uint32_t i) const {
    if (sensors == nullptr) return OriginKind::none;
    return kinds == nullptr ? OriginKind::measured : kinds[i];
  }
};

/// Whether rays show free space around a cell: any of its points has a beam.
ADASPLATS_HD inline bool has_beam(const MeasuredPoints& points,
                                  std::span<const std::uint32_t> members) {
  for (const std::uint32_t i : members) {
    if (is_beam(points.kind(i))) return true;
  }
  return false;
}

/// Mean distance of a cell's points with a beam to their sensors, added in their order.
ADASPLATS_HD inline double mean_range_m(const MeasuredPoints& points,
                                        std::span<const std::uint32_t> members) {
  double sum = 0;
  std::uint32_t beams = 0;
  for (const std::uint32_t i : members) {
    if (!is_beam(points.kind(i))) continue;
    sum += static_cast<double>(length(points.positions[i] - points.sensors[i]));
    ++beams;
  }
  return sum / static_cast<double>(beams);
}

/// Unit for the spacing of a cell: its distance to the sensor if it has a beam, else 1 m. 0 if
/// having a beam differs from `with_beam`.
ADASPLATS_HD inline float spacing_unit_m(const MeasuredPoints& points,
                                         std::span<const std::uint32_t> members, bool with_beam) {
  if (has_beam(points, members) != with_beam) return 0;
  return with_beam ? static_cast<float>(mean_range_m(points, members)) : 1.0F;
}

/// Median spacings of the cells with and without a beam, in their units.
struct TypicalSpacing {
  double with_beam = 0;
  double without = 0;
  double limited = 0;  ///< share of the cells farther from their planes than the maximum shift

  /// Cells are too far apart for planes through their neighbours, as in clouds from the air over
  /// trees. Of vehicle drives and street scans at most 12 % of the cells are limited (one scan of
  /// 32 beams), of clouds from the air over trees at least 57 %.
  ADASPLATS_HD bool is_sparse() const { return limited > 0.25; }

  ADASPLATS_HD double of(bool beam) const { return beam ? with_beam : without; }
};

/// Maximum radius of the seed of a cell.
ADASPLATS_HD inline double largest_seed_m(const MeasuredPoints& points,
                                          std::span<const std::uint32_t> members,
                                          const TypicalSpacing& typical,
                                          const ConsistentOptions& options) {
  const bool beam = has_beam(points, members);
  // No such cells before the split: they come from splitting cells of the other kind.
  if (typical.of(beam) == 0) return options.cell_m;
  return options.largest_seed(beam) * typical.of(beam) *
         static_cast<double>(spacing_unit_m(points, members, beam));
}

/// A cell's normal oriented towards the sensors; without sensors, with a canonical sign.
ADASPLATS_HD inline Vec3f seed_normal(Vec3f normal, const MeasuredPoints& points,
                                      std::span<const std::uint32_t> members) {
  Vec3d to_sensors;
  bool any_known = false;
  for (const std::uint32_t k : members) {
    if (!is_known(points.kind(k))) continue;
    any_known = true;
    to_sensors = to_sensors + vec_cast<double>(points.sensors[k] - points.positions[k]);
  }
  if (!any_known) return with_canonical_sign(normal);
  return dot(vec_cast<double>(normal), to_sensors) < 0 ? -normal : normal;
}

/// The spacing of the cells, limited by the spacing of beams; 0 for an isolated cell. A single ring
/// on a road is a line of cells, where the 7th neighbour is the fourth to one side: at most five
/// cell sides away.
ADASPLATS_HD inline float seed_radius(double spacing_m, double largest_m,
                                      const ConsistentOptions& options) {
  const double wanted_m = options.seed_spacing * spacing_m;
  constexpr double kSidesInLine = 5;
  if (!(wanted_m > 0)) return 0;
  if (wanted_m > options.isolated * largest_m && spacing_m > kSidesInLine * options.cell_m)
    return 0;
  return static_cast<float>(
      std::clamp(wanted_m, options.min_radius_m, std::max(options.min_radius_m, largest_m)));
}

}  // namespace adasplats
