// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Surfaces from points by Open3D, for comparison:
//   bench_open3d POINTS.ply [--neighbors N]
// Normals from N neighbours (default: 30), then ball pivoting with radii of 1, 2 and 4 mean
// distances between neighbours, as its documentation advises. Prints seconds and the triangles as
// JSON.
#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/stopwatch.h"
#include "common.h"

namespace {

using namespace adasplats;

nlohmann::ordered_json measure(const bench::Arguments& arguments) {
  const Executor executor;
  ProgressSink progress;
  const std::vector<std::filesystem::path> inputs = {arguments.input(0)};
  const PointCloud loaded = load_cloud(inputs, {}, executor, progress).first;
  open3d::geometry::PointCloud cloud;
  cloud.points_.reserve(loaded.size());
  for (const Vec3f& p : loaded.positions) cloud.points_.emplace_back(p.x, p.y, p.z);
  nlohmann::ordered_json json;
  json["points"] = cloud.points_.size();
  Stopwatch watch;
  cloud.EstimateNormals(
      open3d::geometry::KDTreeSearchParamKNN(arguments.number("--neighbors", 30)));
  json["normals_s"] = watch.seconds();
  const std::vector<double> distances = cloud.ComputeNearestNeighborDistance();
  const double mean_m = std::accumulate(distances.begin(), distances.end(), 0.0) /
                        static_cast<double>(distances.size());
  watch = {};
  const auto mesh = open3d::geometry::TriangleMesh::CreateFromPointCloudBallPivoting(
      cloud, {mean_m, 2 * mean_m, 4 * mean_m});
  json["ball_pivoting_s"] = watch.seconds();
  json["triangles"] = mesh->triangles_.size();
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  return bench::exit_code_of("bench_open3d", [&] {
    const bench::Arguments arguments(argc, argv, "bench_open3d POINTS.ply [--neighbors N]", 1, 1);
    std::printf("%s\n", measure(arguments).dump().c_str());
  });
}
