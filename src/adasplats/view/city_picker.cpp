// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/city_picker.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace adasplats {
namespace {

/// Where a ray enters a box, or nothing if it misses. Slabs of Kay and Kajiya 1986.
std::optional<float> entry(const Ray& ray, Vec3f low, Vec3f high) {
  float from = ray.t_min, to = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    // A parallel axis must not divide: 0 / 0 is NaN.
    if (ray.direction[axis] == 0) {
      if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) return std::nullopt;
      continue;
    }
    const float a = (low[axis] - ray.origin[axis]) / ray.direction[axis];
    const float b = (high[axis] - ray.origin[axis]) / ray.direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to ? std::optional(from) : std::nullopt;
}

}  // namespace

CityPicker::CityPicker(std::filesystem::path folder, CityManifest city)
    : folder_(std::move(folder)), city_(std::move(city)) {
  std::size_t first = 0;
  for (const CityTile& tile : city_.tiles) {
    first_splats_.push_back(first);
    first += tile.splats;
  }
}

std::optional<CityHit> CityPicker::nearest(const Ray& ray) {
  std::optional<CityHit> best;
  for (const auto& [range_m, k] : crossed(ray)) {
    if (best && best->range_m < range_m) break;
    const SplatModel& model = tile(k);
    for (std::size_t i = 0; i < model.size(); ++i) {
      const float t = intersect_disk(ray, model.disks[i]);
      const std::size_t splat = first_splats_[k] + i;
      if (!std::isfinite(t)) continue;
      // Of equal ranges the lowest index, like a tracer.
      if (best && (t > best->range_m || (t == best->range_m && splat > best->splat))) continue;
      best = {t, splat, model.disks[i], std::nullopt, std::nullopt};
      if (!model.classes.empty()) best->class_id = model.classes[i];
      if (!model.intensities.empty()) best->intensity = model.intensities[i];
    }
  }
  return best;
}

/// The first kMaxTiles crossed tiles, nearest first.
std::vector<CityPicker::Crossing> CityPicker::crossed(const Ray& ray) const {
  std::vector<Crossing> crossings;
  for (std::size_t k = 0; k < city_.tiles.size(); ++k) {
    const CityTile& tile = city_.tiles[k];
    if (tile.splats == 0) continue;
    const Vec3f low = vec_cast<float>(tile.low - city_.origin);
    const Vec3f high = vec_cast<float>(tile.high - city_.origin);
    const Vec3f size = max(max(low, -low), max(high, -high));
    const float margin_m = box_margin(std::max({size.x, size.y, size.z}));
    const Vec3f margin = {margin_m, margin_m, margin_m};
    if (const auto range_m = entry(ray, low - margin, high + margin))
      crossings.push_back({*range_m, k});
  }
  std::ranges::sort(crossings, {}, &Crossing::range_m);
  crossings.resize(std::min(crossings.size(), kMaxTiles));
  return crossings;
}

const SplatModel& CityPicker::tile(std::size_t k) {
  const auto found = std::ranges::find(kept_, k, &Kept::tile);
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().model;
  }
  std::size_t splats = city_.tiles[k].splats;
  for (auto kept = kept_.begin(); kept != kept_.end();) {
    splats += kept->model.size();
    kept = splats > kKeptSplats ? kept_.erase(kept) : std::next(kept);
  }
  kept_.push_front({k, load_city_tile(folder_, city_, k)});
  return kept_.front().model;
}

}  // namespace adasplats
