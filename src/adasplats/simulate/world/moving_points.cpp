// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/world/moving_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/symmetric_eigen.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

using Indices = std::vector<std::uint32_t>;

void check(double value, const char* name) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(ErrorKind::usage, std::string(name) + " of moving splats is " +
                                      std::to_string(value) + ", expected more than 0");
}

/// Moving points of the scan, by class and instance; each list ascends.
std::map<std::uint32_t, Indices> moving_objects(const KittiScan& scan, const LabelScheme& scheme) {
  std::map<std::uint32_t, Indices> objects;
  for (std::uint32_t i = 0; i < scan.classes.size(); ++i) {
    const SemanticClass* const found = scheme.find(scan.classes[i]);
    if (found == nullptr || found->mobility != Mobility::moving) continue;
    const Vec3f p = scan.positions[i];
    if (!is_finite(p) || !(dot(p, p) > 0)) continue;
    const std::uint32_t instance = scan.instances.empty() ? 0U : scan.instances[i];
    objects[std::uint32_t{scan.classes[i]} << 16 | instance].push_back(i);
  }
  return objects;
}

/// Whether the points of a neighbourhood define a surface: at least three, not collinear. A width
/// below a twentieth of the length is the noise of a single ring.
bool is_flat(const Moments& moments, const LocalShape& shape) {
  constexpr double kMinWidth = 0.05;
  return moments.count >= 3 && shape.lambda[1] > kMinWidth * kMinWidth * shape.lambda[0];
}

/// Normals of the points of one object, oriented towards the sensor, which is at the origin.
std::vector<Vec3f> object_normals(std::span<const Vec3f> points, const MovingSplatOptions& options,
                                  const Executor& executor) {
  std::vector<Vec3f> normals(points.size());
  const PointIndex index(points, executor);
  const auto reach_m = static_cast<float>(options.reach_m);
  const NeighborLimit limit = {std::max(1U, options.neighbors), reach_m * reach_m};
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return limit; },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        const Vec3f point = points[index.index_of(rank)];
        // Sums in the order of distance and rank, because the list is unordered.
        std::vector<std::uint64_t> keys;
        for (std::uint32_t k = 0; k < neighbors.size; ++k) keys.push_back(neighbors.key(k));
        std::sort(keys.begin(), keys.end());
        Moments moments;
        for (const std::uint64_t key : keys)
          moments.add(points[index.index_of(static_cast<std::uint32_t>(key))] - point);
        const LocalShape shape = local_shape(moments);
        const Vec3f to_sensor = normalized(-point);
        normals[index.index_of(rank)] =
            is_flat(moments, shape) ? oriented(shape.normal, to_sensor) : to_sensor;
      });
  return normals;
}

/// Measured intensities corrected for range and incidence.
float reflectance_of(float intensity, Vec3f point, Vec3f normal,
                     const IntensityResponse* response) {
  if (response == nullptr || response->empty()) return intensity;
  const float range_m = length(point);
  const float gain = response->gain(range_m, std::fabs(dot(point, normal)) / range_m);
  return gain > 0 ? intensity / gain : intensity;
}

}  // namespace

MovingSplats moving_splats(const KittiScan& scan, const LabelScheme& scheme,
                           const MovingSplatOptions& options, const Executor& executor) {
  check(options.radius_m, "the radius");
  check(options.reach_m, "the reach");
  std::vector<std::pair<std::uint32_t, Vec3f>> splats;  // point and normal
  for (const auto& [label, indices] : moving_objects(scan, scheme)) {
    std::vector<Vec3f> points;
    for (const std::uint32_t i : indices) points.push_back(scan.positions[i]);
    const std::vector<Vec3f> normals = object_normals(points, options, executor);
    for (std::size_t k = 0; k < indices.size(); ++k) splats.emplace_back(indices[k], normals[k]);
  }
  std::ranges::sort(splats, {}, &std::pair<std::uint32_t, Vec3f>::first);

  MovingSplats result;
  result.splats.label_scheme = scheme.name();
  result.splats.method = "moving points";
  for (const auto& [i, normal] : splats) {
    result.splats.disks.push_back(
        {scan.positions[i], static_cast<float>(options.radius_m), normal});
    result.splats.classes.push_back(scan.classes[i]);
    if (!scan.intensities.empty())
      result.splats.intensities.push_back(
          reflectance_of(scan.intensities[i], scan.positions[i], normal, options.response));
    result.instances.push_back(scan.instances.empty() ? std::uint16_t{0} : scan.instances[i]);
  }
  return result;
}

}  // namespace adasplats
