// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/presence.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

constexpr std::size_t kRaysAtOnce = std::size_t{1} << 18;

void check(const PointCloud& cloud, const PresenceOptions& options) {
  if (!(options.within_m > 0 && std::isfinite(options.within_m))) {
    throw Error(ErrorKind::usage, "the distance from a point must be greater than 0");
  }
  if (!(options.min_range_m >= 0 && options.min_range_m < options.max_range_m)) {
    throw Error(ErrorKind::usage, "ranges must be 0 <= minimum < maximum");
  }
  if (!cloud.has_beams()) {
    throw Error(ErrorKind::data, cloud.sensor_positions.empty()
                                     ? "no sensor positions, which the rays of the points start at"
                                     : "the sensor positions are guessed, so the rays of the "
                                       "points are unknown");
  }
}

/// Points with a beam within the ranges, in the cloud's order.
std::vector<std::uint32_t> points_in_range(const PointCloud& cloud,
                                           const PresenceOptions& options) {
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_beam(cloud.origin_kind(i))) continue;
    const double range_m =
        static_cast<double>(length(cloud.positions[i] - cloud.sensor_positions[i]));
    if (range_m >= options.min_range_m && range_m <= options.max_range_m) {
      chosen.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return chosen;
}

/// The part of the ray around the point.
Ray ray_at(const PointCloud& cloud, std::uint32_t point, Vec3f scene_from_cloud, double within_m) {
  const Vec3f along = cloud.positions[point] - cloud.sensor_positions[point];
  const float range_m = length(along);
  const auto margin_m = static_cast<float>(within_m);
  Ray ray;
  ray.origin = cloud.sensor_positions[point] + scene_from_cloud;
  ray.direction = along / range_m;
  ray.t_min = std::max(0.0F, range_m - margin_m);
  ray.t_max = range_m + margin_m;
  return ray;
}

void add(Presence& sum, bool present) {
  ++sum.points;
  if (present) ++sum.present;
}

const SemanticClass& class_of(const LabelScheme& labels, std::uint16_t id) {
  const SemanticClass* found = labels.find(id);
  if (found == nullptr) {
    throw Error(ErrorKind::data, "class " + std::to_string(id) + " is not in the label scheme '" +
                                     labels.name() + "'");
  }
  return *found;
}

}  // namespace

double Presence::share() const {
  if (points == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(present) / static_cast<double>(points);
}

PresenceResult presence(const Tracer& tracer, Vec3d scene_origin, const PointCloud& cloud,
                        const LabelScheme* labels, const PresenceOptions& options,
                        const Executor& executor) {
  check(cloud, options);
  const std::vector<std::uint32_t> points = points_in_range(cloud, options);
  if (points.empty()) throw Error(ErrorKind::data, "no points within the ranges");
  const bool labelled = labels != nullptr && !cloud.classes.empty();
  const Vec3f scene_from_cloud = vec_cast<float>(cloud.origin - scene_origin);

  PresenceResult result;
  std::map<std::uint16_t, Presence> by_class;
  const ProgressPass pass(executor, 2 * points.size());  // making rays, then casting them
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  for (std::size_t first = 0; first < points.size(); first += kRaysAtOnce) {
    rays.resize(std::min(kRaysAtOnce, points.size() - first));
    hits.assign(rays.size(), Hit{});
    executor.for_chunks(rays.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        rays[k] = ray_at(cloud, points[first + k], scene_from_cloud, options.within_m);
      }
    });
    tracer.nearest(rays, hits, executor);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const bool present = hits[k].valid();
      add(result.all, present);
      if (labelled) add(by_class[cloud.classes[points[first + k]]], present);
    }
  }
  if (!labelled) {
    result.still = result.all;
    return result;
  }
  for (const auto& [id, sum] : by_class) {
    const SemanticClass& semantic_class = class_of(*labels, id);
    Presence& kind = semantic_class.mobility == Mobility::moving ? result.moving : result.still;
    kind.points += sum.points;
    kind.present += sum.present;
    result.by_class.emplace_back(semantic_class.name, sum);
  }
  return result;
}

}  // namespace adasplats
