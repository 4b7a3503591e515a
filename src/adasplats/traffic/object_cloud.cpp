// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/object_cloud.h"

#include "adasplats/neighbors/point_index.h"

namespace adasplats {
namespace {

Vec3f mirrored(Vec3f v) { return {v.x, -v.y, v.z}; }

}  // namespace

PointCloud cloud_of(const RecordedObject& object) {
  PointCloud cloud;
  std::uint32_t number = 0;
  for (const ObjectScan& scan : object.scans) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      cloud.positions.push_back(vec_cast<float>(scan.points[i]));
      cloud.sensor_positions.push_back(vec_cast<float>(scan.origins[i]));
      cloud.scan_indices.push_back(number);
    }
    for (const PassingBeam& beam : scan.passing)
      cloud.empty_beams.push_back(
          {vec_cast<float>(beam.origin), vec_cast<float>(beam.direction), number, false});
    cloud.intensities.insert(cloud.intensities.end(), scan.intensities.begin(),
                             scan.intensities.end());
    ++number;
  }
  if (cloud.intensities.size() != cloud.size()) cloud.intensities.clear();
  return cloud;
}

std::size_t add_mirrored(PointCloud& cloud, float apart_m, const Executor& executor) {
  const PointIndex index(cloud.positions, executor);
  std::vector<Vec3f> images;
  for (const Vec3f& position : cloud.positions) images.push_back(mirrored(position));
  const std::vector<Neighbor> nearest = index.nearest(images, executor);
  const std::size_t measured = cloud.size();
  for (std::size_t i = 0; i < measured; ++i) {
    if (!(nearest[i].squared_distance > apart_m * apart_m)) continue;
    cloud.positions.push_back(images[i]);
    cloud.sensor_positions.push_back(mirrored(cloud.sensor_positions[i]));
    cloud.scan_indices.push_back(cloud.scan_indices[i]);
    if (!cloud.intensities.empty()) cloud.intensities.push_back(cloud.intensities[i]);
  }
  return cloud.size() - measured;
}

}  // namespace adasplats
