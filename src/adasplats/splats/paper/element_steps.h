// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/paper/generation.h"
#include "adasplats/splats/paper/grow.h"
#include "adasplats/surface/base_neighborhoods.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {

// The work of the steps of the paper's methods for one element, in the order of the steps. Each
// reads and writes only data of element `i`, so any loop may run it (for_each of a backend).

/// The group of a point's class.
struct FindGroup {
  const std::uint16_t* classes;
  const SemanticGroup* table;  ///< ClassTables::groups
  SemanticGroup* groups;

  ADASPLATS_HD void operator()(std::size_t i) const { groups[i] = table[classes[i]]; }
};

/// Flags points that are not noise.
struct FlagKept {
  const std::uint32_t* votes;
  const std::uint32_t* memberships;
  double removing_share;
  std::uint8_t* flags;

  ADASPLATS_HD void operator()(std::size_t i) const {
    flags[i] = is_noise(votes[i], memberships[i], removing_share) ? 0 : 1;
  }
};

/// The group of a point's descriptors.
struct FindGroupOfShape {
  const ShapeKind* kinds;
  SemanticGroup* groups;

  ADASPLATS_HD void operator()(std::size_t i) const { groups[i] = group_of(kinds[i]); }
};

/// A point with the attributes for growing; its normal is oriented towards the sensor, else it has
/// a canonical sign. Pointers to attributes that the cloud lacks are null.
struct MakeSurfacePoint {
  const Vec3f* positions;
  const Vec3f* sensors;
  const OriginKind* kinds;
  const std::uint16_t* classes;
  const Vec3f* normals;
  const SemanticGroup* groups;
  SurfacePoint* points;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const bool known = sensors != nullptr && (kinds == nullptr || is_known(kinds[i]));
    const Vec3f normal =
        !known ? with_canonical_sign(normals[i]) : oriented(normals[i], sensors[i] - positions[i]);
    points[i] = {positions[i], classes == nullptr ? 0U : classes[i], normal,
                 groups == nullptr ? 0U : static_cast<std::uint32_t>(groups[i])};
  }
};

/// The splat of a selected seed.
struct MakeSplat {
  const std::uint32_t* seeds;
  const SurfacePoint* points;
  const float* radii;
  const float* shifts;
  Disk* disks;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const std::uint32_t seed = seeds[i];
    disks[i] = GrownSplat{radii[seed], shifts[seed]}.disk(points[seed]);
  }
};

/// Runs MakeSurfacePoint on every point of a cloud.
template <class Backend>
auto surface_points(const Backend& backend, const typename Backend::Cloud& cloud,
                    const typename Backend::template Array<Vec3f>& normals,
                    const typename Backend::template Array<SemanticGroup>& groups) {
  auto points = backend.template array<SurfacePoint>(cloud.size());
  backend.for_each(cloud.size(), "orient normals",
                   MakeSurfacePoint{cloud.positions.data(), data_or_null(cloud.sensor_positions),
                                    data_or_null(cloud.origin_kinds), data_or_null(cloud.classes),
                                    normals.data(), data_or_null(groups), points.data()});
  return points;
}

}  // namespace adasplats
