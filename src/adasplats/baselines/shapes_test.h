// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests: points of known surfaces, and measures of meshes.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "adasplats/scene/scene.h"

namespace adasplats {

struct OrientedPoints {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;

  void add(const OrientedPoints& other) {
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  }
};

/// A square of the plane at height z around zero, `side` x `side` points; normals (0, 0, sign).
inline OrientedPoints square(float half_m, int side, float z = 0, float sign = 1) {
  OrientedPoints points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const auto at = [&](int k) {
        return half_m * (2.0F * static_cast<float>(k) / static_cast<float>(side - 1) - 1.0F);
      };
      points.positions.push_back({at(i), at(j), z});
      points.normals.push_back({0, 0, sign});
    }
  return points;
}

/// Points spread evenly on a sphere (Fibonacci), with outward normals.
inline OrientedPoints sphere(Vec3f center, float radius_m, int count) {
  constexpr double kGoldenAngle = 2.399963229728653;
  OrientedPoints points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count;
    const double r = std::sqrt(1 - z * z);
    const Vec3f n =
        vec_cast<float>(Vec3d{r * std::cos(kGoldenAngle * i), r * std::sin(kGoldenAngle * i), z});
    points.positions.push_back(center + radius_m * n);
    points.normals.push_back(n);
  }
  return points;
}

/// Twice the area times the unit normal.
inline Vec3d cross_of(const Triangle& t) {
  return cross(vec_cast<double>(t.b - t.a), vec_cast<double>(t.c - t.a));
}

inline double area_m2(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    area += 0.5 * length(cross_of(mesh.triangle(i)));
  return area;
}

/// By the divergence theorem; positive for a closed surface whose faces look outward.
inline double volume_m3(const TriangleMesh& mesh) {
  double volume = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    volume += dot(vec_cast<double>(t.a), cross(vec_cast<double>(t.b), vec_cast<double>(t.c))) / 6;
  }
  return volume;
}

/// Whether every edge belongs to two faces that run along it in opposite directions.
inline bool is_closed(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, reversed;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      reversed.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  const bool once = std::adjacent_find(edges.begin(), edges.end()) == edges.end();
  return once && edges == reversed;
}

}  // namespace adasplats
