// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/local_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

/// Offsets of points on a rough, tilted plane.
std::vector<Vec3f> some_offsets(std::uint64_t seed, std::size_t count) {
  std::vector<Vec3f> offsets;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, 0, i);
    const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3);
    offsets.push_back(vec_cast<float>(Vec3d{x, y, 0.7 * x - 0.2 * y + 0.01 * random.normal()}));
  }
  return offsets;
}

template <class T, class Value, class Add>
T summed(const std::vector<Value>& values, std::size_t lanes, const Add& add) {
  std::vector<T> parts(lanes);
  for (std::size_t i = 0; i < values.size(); ++i) add(parts[i % lanes], values[i]);
  T sum = parts[0];
  double* const to = reinterpret_cast<double*>(&sum);
  for (std::size_t lane = 1; lane < lanes; ++lane) {
    const double* const from = reinterpret_cast<const double*>(&parts[lane]);
    for (std::size_t i = 0; i < sizeof(T) / sizeof(double); ++i) to[i] += from[i];
  }
  return sum;
}

template <class T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

Moments moments_of(const std::vector<Vec3f>& offsets, std::size_t lanes) {
  float extent_m = 0;
  for (const Vec3f offset : offsets) extent_m = std::max(extent_m, extent(offset));
  const ExactMoments exact(static_cast<std::uint32_t>(offsets.size()), extent_m);
  return summed<Moments>(offsets, lanes, [&](Moments& m, Vec3f d) { m.add(d, exact); });
}

PlaneDistances distances_of(const std::vector<float>& distances, std::size_t lanes) {
  const ExactDistances exact(static_cast<std::uint32_t>(distances.size()),
                             *std::max_element(distances.begin(), distances.end()));
  return summed<PlaneDistances>(distances, lanes,
                                [&](PlaneDistances& sum, float d) { sum.add(d, exact); });
}

// Oracle: the same points in another order, added by as many lanes as a GPU does.
TEST(LocalShape, SumsAreTheSameInEveryOrder) {
  int alike = 0;  // plain sums: the data of this test decide
  for (const std::size_t count : {1, 3, 40, 120, 513}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      std::vector<Vec3f> offsets = some_offsets(seed, count);
      const Moments expected = moments_of(offsets, 1);
      const Vec3f normal = local_shape(expected).normal;
      std::vector<float> distances;
      for (const Vec3f offset : offsets) distances.push_back(distance_to_plane(offset, normal));
      const PlaneDistances expected_distances = distances_of(distances, 1);
      std::reverse(offsets.begin(), offsets.end());
      std::reverse(distances.begin(), distances.end());
      for (const std::size_t lanes : {1, 32}) {
        EXPECT_TRUE(same_bytes(moments_of(offsets, lanes), expected)) << count << " on " << lanes;
        EXPECT_TRUE(same_bytes(distances_of(distances, lanes), expected_distances));
      }
      const auto add = [](Moments& m, Vec3f d) { m.add(d); };
      const Moments one = summed<Moments>(offsets, 1, add);
      alike += same_bytes(one, summed<Moments>(offsets, 32, add)) ? 1 : 0;
    }
  }
  EXPECT_LT(alike, 60);  // of 100
}

// Oracle: the moments in plain double.
TEST(LocalShape, ExactSumsAreThoseOfDoubles) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<Vec3f> offsets = some_offsets(seed, 40);
    Moments plain;
    for (const Vec3f offset : offsets) plain.add(offset);
    const LocalShape a = local_shape(plain), b = local_shape(moments_of(offsets, 1));
    EXPECT_LT(length(cross(a.normal, b.normal)), 1e-6F);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.lambda[k], b.lambda[k], 1e-13);
  }
}

}  // namespace
}  // namespace adasplats
