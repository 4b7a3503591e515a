// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/segment/pyramid/pyramid.h"

namespace adasplats {
namespace {

constexpr float kColumn_m = 1;
constexpr int kReach = 4;  // columns in each direction

/// One number per column of a rectangle.
struct Columns {
  int width = 0, height = 0;
  std::vector<float> numbers;

  float& at(int x, int y) { return numbers[index(x, y)]; }
  float at(int x, int y) const { return numbers[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Combines each column with those around it, along x or y: body(sum, next).
template <class Body>
Columns spread(const Columns& columns, bool along_x, float start, Body&& body) {
  Columns result = columns;
  for (int y = 0; y < columns.height; ++y) {
    for (int x = 0; x < columns.width; ++x) {
      float sum = start;
      for (int d = -kReach; d <= kReach; ++d) {
        const int u = along_x ? x + d : x, v = along_x ? y : y + d;
        if (u < 0 || v < 0 || u >= columns.width || v >= columns.height) continue;
        sum = body(sum, columns.at(u, v));
      }
      result.at(x, y) = sum;
    }
  }
  return result;
}

template <class Body>
Columns spread(const Columns& columns, float start, const Body& body) {
  return spread(spread(columns, true, start, body), false, start, body);
}

}  // namespace

std::vector<float> heights_above_ground(std::span<const Vec3f> points) {
  std::vector<float> heights(points.size());
  if (points.empty()) return heights;
  const auto column = [](float value) { return static_cast<int>(std::floor(value / kColumn_m)); };
  int low_x = column(points[0].x), low_y = column(points[0].y), high_x = low_x, high_y = low_y;
  for (const Vec3f p : points) {
    low_x = std::min(low_x, column(p.x));
    high_x = std::max(high_x, column(p.x));
    low_y = std::min(low_y, column(p.y));
    high_y = std::max(high_y, column(p.y));
  }
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  Columns lowest{high_x - low_x + 1, high_y - low_y + 1, {}};
  lowest.numbers.assign(static_cast<std::size_t>(lowest.width) * lowest.height, kNothing);
  for (const Vec3f p : points) {
    float& own = lowest.at(column(p.x) - low_x, column(p.y) - low_y);
    own = std::min(own, p.z);
  }
  const Columns eroded = spread(lowest, kNothing, [](float a, float b) { return std::min(a, b); });
  Columns known = eroded, ground = eroded;
  for (std::size_t i = 0; i < eroded.numbers.size(); ++i) {
    known.numbers[i] = std::isfinite(eroded.numbers[i]) ? 1.0F : 0.0F;
    if (known.numbers[i] == 0) ground.numbers[i] = 0;
  }
  const auto plus = [](float a, float b) { return a + b; };
  known = spread(known, 0, plus);
  ground = spread(ground, 0, plus);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int x = column(points[i].x) - low_x, y = column(points[i].y) - low_y;
    heights[i] = points[i].z - ground.at(x, y) / known.at(x, y);
  }
  return heights;
}

}  // namespace adasplats
