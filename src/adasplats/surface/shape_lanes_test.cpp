// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/shape_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

LocalShape shape_of(const std::vector<Vec3f>& points, std::uint32_t rank,
                    const std::vector<std::uint32_t>& neighbors) {
  float extent_m = 0;
  for (const std::uint32_t k : neighbors)
    extent_m = std::max(extent_m, extent(points[k] - points[rank]));
  const ExactMoments exact(static_cast<std::uint32_t>(neighbors.size()), extent_m);
  Moments moments;
  for (const std::uint32_t k : neighbors) moments.add(points[k] - points[rank], exact);
  return local_shape(moments);
}

TEST(ShapeLanes, HaveTheBitsOfSingleShapes) {
  constexpr std::uint32_t kPoints = 400;
  std::vector<Vec3f> points;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    Random random(1, 0, i);
    const double thickness = i % 3 == 0 ? 0.0 : 0.1;
    points.push_back(vec_cast<float>(
        Vec3d{random.normal(), 0.3 * random.normal(), thickness * random.normal()}));
  }
  ShapeLanes lanes;
  for (std::size_t group = 0; group < 60; ++group) {
    Random random(2, 0, group);
    const auto first = static_cast<std::uint32_t>(random.uniform(0, kPoints - 16));
    std::vector<std::vector<std::uint32_t>> ranks(1 + group % 16);
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      // None, one and two neighbours, too; a group of one point without extent.
      const auto size = static_cast<std::size_t>(random.uniform(0, group % 2 == 0 ? 5 : 60));
      for (std::size_t k = 0; k < size; ++k)
        ranks[i].push_back(static_cast<std::uint32_t>(random.uniform(0, kPoints)));
      if (group == 7) ranks[i].assign(3, first + static_cast<std::uint32_t>(i));
    }
    std::vector<NeighborList> lists;
    for (const auto& of_point : ranks)
      lists.push_back({nullptr, of_point.data(), static_cast<std::uint32_t>(of_point.size())});
    std::vector<LocalShape> shapes(16);
    lanes.find(points, first, lists, shapes);
    for (std::uint32_t i = 0; i < lists.size(); ++i) {
      const LocalShape expected = shape_of(points, first + i, ranks[i]);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(shapes[i].normal[axis]),
                  std::bit_cast<std::uint32_t>(expected.normal[axis]));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(shapes[i].lambda[axis]),
                  std::bit_cast<std::uint64_t>(expected.lambda[axis]));
      }
    }
  }
}

}  // namespace
}  // namespace adasplats
