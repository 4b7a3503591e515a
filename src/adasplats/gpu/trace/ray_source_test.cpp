// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/trace/ray_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace adasplats::gpu {
namespace {

TEST(RaySource, EverySampleOfAPictureIsOneRay) {
  for (const auto& [columns, rows] : {std::pair(8, 4), std::pair(16, 12), std::pair(64, 4)}) {
    std::vector<int> seen(static_cast<std::size_t>(columns * rows));
    for (std::uint64_t ray = 0; ray < seen.size(); ++ray) {
      const SamplePlace at = sample_of(ray, columns);
      ASSERT_TRUE(at.x >= 0 && at.x < columns && at.y >= 0 && at.y < rows);
      ++seen[static_cast<std::size_t>(at.y * columns + at.x)];
      EXPECT_EQ(ray_of_sample(at, columns), ray);
    }
    EXPECT_EQ(std::ranges::count(seen, 1), columns * rows);
  }
}

TEST(RaySource, AWarpsRaysAreOneTile) {
  for (std::uint64_t ray = 0; ray < 32; ++ray) {
    const SamplePlace at = sample_of(64 + ray, 32);  // the third tile of the first row
    EXPECT_TRUE(at.x >= 16 && at.x < 24 && at.y >= 0 && at.y < 4);
  }
}

TEST(RaySource, HitsOfScansGoToTheirFirings) {
  const std::vector<std::uint32_t> order = {2, 0, 1};
  RaySource source;
  source.kind = RaySource::Kind::scans;
  source.firing_count = 3;
  EXPECT_EQ(place_of_ray(source, 4), 4U);
  source.order = order.data();
  EXPECT_EQ(place_of_ray(source, 0), 2U);
  EXPECT_EQ(place_of_ray(source, 1), 0U);
  EXPECT_EQ(place_of_ray(source, 3 + 2), 3U + 1U);
  const std::uint64_t far = std::uint64_t{3} << 33;  // beyond 32 bits
  EXPECT_EQ(place_of_ray(source, far + 1), far);
  EXPECT_EQ(divide(far + 1, 3).whole, far / 3);
}

}  // namespace
}  // namespace adasplats::gpu
