// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/recognize_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "adasplats/cloud/sequence/cone_fit.h"

namespace adasplats {
namespace {

constexpr std::size_t kFewestPoints = 500;
constexpr std::size_t kFewestCones = 8;  // fewer fit too much

// How far a fit may leave the mounts that are searched.
constexpr double kBeyond_m = 0.5;
constexpr double kBeyond_rad = 0.75 * kDegree;

std::vector<Vec3d> usable_points(std::span<const Vec3d> points) {
  std::vector<Vec3d> kept;
  for (const Vec3d& point : points) {
    const double range_m = length(point);  // of NaN neither is true
    if (range_m > kNearestOnCones_m && range_m < kFarthestOnCones_m) kept.push_back(point);
  }
  return kept;
}

std::vector<ConeTable> usable_tables(std::span<const SensorCones> candidates) {
  std::vector<ConeTable> tables;
  for (const SensorCones& cones : candidates)
    if (cones.cones.size() >= kFewestCones) tables.emplace_back(cones);
  return tables;
}

/// Whether a table and a mount may be those of the points, however near these are to the cones.
bool is_plausible(const ConeFit& fit) {
  const Vec3d origin = fit.mount.translation;
  const double aside_m = std::max(std::abs(origin.x), std::abs(origin.y));
  const double tilt_rad = std::acos(std::clamp(axis_of(fit.mount).z, -1.0, 1.0));
  return aside_m < kMaxAside_m + kBeyond_m && origin.z > kLowest_m - kBeyond_m &&
         origin.z < kHighest_m + kBeyond_m && tilt_rad < kMaxTilt_rad + kBeyond_rad &&
         fit.score.outside < 0.05 &&    // reflections and rain
         fit.score.empty < 0.15 &&      // lasers fail; of a sensor with half as many half are
         fit.score.filled > 1.0 / 3 &&  // the upper half may look at the sky
         fit.score.largest < 1.0 / 3;   // a plane seen from within is one cone
}

/// Chance gives 1, wrong tables with the best of mounts 0.8 and more (KITTI, PandaSet, all tables
/// of the library), the right ones 0.03 to 0.45.
bool is_clear(const ConeFit& fit) { return is_plausible(fit) && fit.score.ratio() < 0.5; }

/// Units of one make differ by less than a quarter of a gap.
bool same_kind(const ConeTable& a, const ConeTable& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double gap_rad = std::min(a.gap_above(i), a.gap_below(i));
    if (std::abs(a[i].elevation_rad - b[i].elevation_rad) > 0.25 * gap_rad) return false;
  }
  return true;
}

std::vector<ConeFit> fits_near(std::span<const Vec3d> points, std::span<const ConeTable> tables,
                               const RigidTransform& mount, const Executor& executor) {
  std::vector<ConeFit> fits(tables.size());
  executor.for_chunks(tables.size(), 1, [&](std::size_t i, std::size_t) {
    fits[i] = fit_near(points, tables[i], mount);
  });
  return fits;
}

/// The clear fit that is nearest to its cones.
std::optional<std::size_t> best_of(std::span<const ConeFit> fits) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (is_clear(fits[i]) && (!best || fits[i].score.ratio() < fits[*best].score.ratio())) best = i;
  return best;
}

/// Nothing where a sensor of another kind is nearer to the best than to chance.
std::optional<Recognition> unrivalled(std::span<const ConeTable> tables,
                                      std::span<const ConeFit> fits, std::size_t best) {
  const ConeScore& score = fits[best].score;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (is_plausible(fits[i]) && fits[i].score.ratio() < 0.5 * (1 + score.ratio()) &&
        !same_kind(tables[best], tables[i]))
      return std::nullopt;
  return Recognition{tables[best].sensor(), fits[best].mount, score.residual_rad, score.chance_rad,
                     score.share};
}

}  // namespace

double Recognition::confidence() const {
  return chance_rad > 0 ? std::clamp(1 - residual_rad / chance_rad, 0.0, 1.0) : 0.0;
}

std::optional<Recognition> recognize_sensor(std::span<const Vec3d> points,
                                            std::span<const SensorCones> candidates,
                                            const Executor& executor) {
  const std::vector<Vec3d> good = usable_points(points);
  if (good.size() < kFewestPoints) return std::nullopt;
  const std::vector<ConeTable> tables = usable_tables(candidates);
  // Points in the sensor's own frame need no search.
  const std::vector<ConeFit> here = fits_near(good, tables, {}, executor);
  if (const auto best = best_of(here)) return unrivalled(tables, here, *best);
  for (const ConeTable& table : tables) {
    const ConeFit fit = searched_fit(good, table, executor);
    if (!is_clear(fit)) continue;
    const std::vector<ConeFit> there = fits_near(good, tables, fit.mount, executor);
    if (const auto best = best_of(there)) return unrivalled(tables, there, *best);
  }
  return std::nullopt;
}

std::optional<Recognition> recognize_in_place(std::span<const Vec3d> points,
                                              std::span<const SensorCones> candidates,
                                              const Executor& executor) {
  const std::vector<Vec3d> good = usable_points(points);
  if (good.size() < kFewestPoints) return std::nullopt;
  const std::vector<ConeTable> tables = usable_tables(candidates);
  const std::vector<ConeFit> fits = fits_near(good, tables, {}, executor);
  const auto best = best_of(fits);
  return best ? unrivalled(tables, fits, *best) : std::nullopt;
}

double residual_near(std::span<const Vec3d> points, const SensorCones& sensor,
                     const RigidTransform& vehicle_from_sensor) {
  const std::vector<Vec3d> good = usable_points(points);
  if (good.size() < kFewestPoints || sensor.cones.size() < kFewestCones) return 0;
  return fit_near(good, ConeTable(sensor), vehicle_from_sensor).score.residual_rad;
}

}  // namespace adasplats
