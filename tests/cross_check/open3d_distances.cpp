// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// Distances between two clouds by Open3D, for cross_check.py: the mean distance of the points of
// SIMULATED to ORIGINAL, the mean of the squares, and the shares within each bound.
//   open3d_distances SIMULATED ORIGINAL BOUND...

#include <open3d/geometry/PointCloud.h>
#include <open3d/io/PointCloudIO.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv) {
  if (argc < 3) return 64;
  open3d::geometry::PointCloud simulated, original;
  if (!open3d::io::ReadPointCloud(argv[1], simulated) ||
      !open3d::io::ReadPointCloud(argv[2], original))
    return 66;
  const std::vector<double> distances_m = simulated.ComputePointCloudDistance(original);
  double sum = 0, squares = 0;
  for (const double d : distances_m) {
    sum += d;
    squares += d * d;
  }
  const double points = static_cast<double>(distances_m.size());
  std::printf("%.17g %.17g", sum / points, squares / points);
  for (int i = 3; i < argc; ++i) {
    const double bound_m = std::atof(argv[i]);
    const auto within = std::count_if(distances_m.begin(), distances_m.end(),
                                      [&](double d) { return d < bound_m; });
    std::printf(" %.17g", static_cast<double>(within) / points);
  }
  std::printf("\n");
  return 0;
}
