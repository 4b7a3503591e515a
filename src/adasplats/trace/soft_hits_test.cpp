// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/soft_hits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/scene/soft_disk.h"
#include "adasplats/trace/soft_tracer.h"
#include "adasplats/trace/tracer.h"
#include "adasplats/trace/wide_kernel.h"

namespace adasplats {
namespace {

/// What one ray meets: the distance and the opacity there.
struct Meeting {
  float t;
  float opacity;
};

/// The most likely hit; `primitive` is the index into `met`, in whose order they are offered.
Hit most_likely(const std::vector<Meeting>& met) {
  SoftHits hits;
  for (std::uint32_t i = 0; i < met.size(); ++i) hits.offer({met[i].t, i}, met[i].opacity);
  return hits.most_likely();
}

// Oracle: probabilities, worked out by hand.
TEST(SoftHits, RaysEndWhereTheyMostLikelyStop) {
  EXPECT_EQ(most_likely({{5, 0.9F}, {9, 0.9F}}), (Hit{5, 0}));
  EXPECT_EQ(most_likely({{5, 0.3F}, {9, 0.9F}}), (Hit{9, 1}));  // 0.3 and 0.63
  EXPECT_EQ(most_likely({{5, 0.5F}, {9, 0.9F}}), (Hit{5, 0}));  // 0.5 and 0.45
  EXPECT_EQ(most_likely({{5, 0.6F}}), (Hit{5, 0}));
  EXPECT_FALSE(most_likely({{5, 0.4F}}).valid());  // 0.6 pass
  EXPECT_FALSE(most_likely({}).valid());
}

TEST(SoftHits, HitsOfOneSurfaceCountTogether) {
  // 0.4 of the rays stop at 5 m, 0.24 at 5.1 m and 0.324 at 9 m.
  const Hit hit = most_likely({{5, 0.4F}, {5.1F, 0.4F}, {9, 0.9F}});
  EXPECT_EQ(hit.primitive, 0U);
  EXPECT_NEAR(hit.t, 5 + 0.1 * 0.24 / 0.64, 1e-5);
  // At 5.2 m they are another surface.
  EXPECT_EQ(most_likely({{5, 0.2F}, {5.2F, 0.3F}, {9, 0.9F}}), (Hit{9, 2}));
}

/// From the definition, in double precision: the hits up to the one that few rays pass, and every
/// surface that begins with one of them.
double most_likely_distance(std::vector<Meeting> met) {
  std::ranges::sort(met, {}, &Meeting::t);
  std::vector<double> weights;
  double passes = 1;
  for (const Meeting& at : met) {
    weights.push_back(passes * static_cast<double>(at.opacity));
    passes *= 1 - static_cast<double>(at.opacity);
    if (passes < static_cast<double>(SoftHits::kFewPass)) break;
  }
  met.resize(weights.size());
  double most = passes, distance = HUGE_VAL;
  for (std::size_t i = 0; i < met.size(); ++i) {
    double weight = 0, sum = 0;
    for (std::size_t k = i; k < met.size() && met[k].t <= met[i].t + SoftHits::kSurface_m; ++k) {
      weight += weights[k];
      sum += weights[k] * static_cast<double>(met[k].t);
    }
    if (weight > most) {
      most = weight;
      distance = sum / weight;
    }
  }
  return distance;
}

std::vector<Meeting> random_meetings(std::uint64_t seed, std::size_t count, double max_opacity) {
  Random random(seed, 0, count);
  std::vector<Meeting> met;
  for (std::size_t i = 0; i < count; ++i)
    met.push_back({static_cast<float>(random.uniform(1, 3)),
                   static_cast<float>(random.uniform(0, max_opacity))});
  return met;
}

TEST(SoftHits, AreThoseOfTheDefinition) {
  int misses = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const auto met = random_meetings(seed, seed % (SoftHits::kMost + 1), 0.9);
    const double expected = most_likely_distance(met);
    const Hit found = most_likely(met);
    ASSERT_EQ(found.valid(), expected < HUGE_VAL) << seed;
    misses += found.valid() ? 0 : 1;
    if (!found.valid()) continue;
    ASSERT_NEAR(static_cast<double>(found.t), expected, 1e-5) << seed;
  }
  EXPECT_GT(misses, 50);
}

// Oracle: the hits in ascending order, which is that of a list without bounds.
TEST(SoftHits, DoNotDependOnTheOrder) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    std::vector<Meeting> met = random_meetings(seed, 1 + seed % 40, seed % 3 == 0 ? 0.1 : 0.9);
    std::ranges::sort(met, {}, &Meeting::t);
    const Hit expected = most_likely(met);
    SoftHits backward;
    for (std::size_t i = met.size(); i-- > 0;)
      backward.offer({met[i].t, static_cast<std::uint32_t>(i)}, met[i].opacity);
    ASSERT_EQ(backward.most_likely(), expected) << seed;
    SoftHits ascending;
    for (std::uint32_t i = 0; i < met.size(); ++i)
      if (!ascending.append({met[i].t, i}, met[i].opacity)) break;
    ASSERT_EQ(ascending.most_likely(), expected) << seed;
    // A traversal does not offer what is out of reach.
    SoftHits mixed;
    for (std::size_t k = 0; k < met.size(); ++k) {
      const std::size_t i = k * 41 % met.size();
      if (met[i].t <= mixed.reach(HUGE_VALF))
        mixed.offer({met[i].t, static_cast<std::uint32_t>(i)}, met[i].opacity);
    }
    ASSERT_EQ(mixed.most_likely(), expected) << seed;
  }
}

// Oracle: brute force over all disks.
TEST(SoftTracer, FindsTheMostLikelyHitsOfAScene) {
  const Executor executor(2);
  std::vector<Disk> disks;
  std::vector<float> opacities;
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Random random(3, 0, i);
    const auto any = [&] { return static_cast<float>(random.uniform(-5, 5)); };
    disks.push_back({{any(), any(), any()},
                     static_cast<float>(random.uniform(0.1, 1)),
                     normalized(Vec3f{any(), any(), 6})});
    opacities.push_back(static_cast<float>(random.uniform()));
    rays.push_back({{any(), any(), -9}, 0, normalized(Vec3f{any(), any(), 20})});
  }
  for (int i = 0; i < 1600; ++i) {  // similar ones, which are traced together
    const auto row = static_cast<float>(i / 160), column = static_cast<float>(i % 160);
    rays.push_back({{0, 0, -9}, 0, normalized(Vec3f{0.03F * (column - 80), 0.4F * (row - 5), 9})});
  }
  const SceneView scene = {disks, nullptr, opacities};
  std::vector<std::unique_ptr<Tracer>> tracers;
  tracers.push_back(make_soft_tracer(make_embree_tracer(scene, executor), scene));
  for (const detail::WideVersion& version : detail::wide_versions())
    tracers.push_back(detail::make_wide_tracer(scene, version, executor));
  std::vector<std::vector<Hit>> hits(tracers.size(), std::vector<Hit>(rays.size()));
  for (std::size_t k = 0; k < tracers.size(); ++k) tracers[k]->nearest(rays, hits[k], executor);
  std::size_t behind_the_first = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SoftHits expected;
    Hit first;
    for (std::uint32_t k = 0; k < disks.size(); ++k) {
      const Hit hit = {intersect_disk(rays[i], disks[k]), k};
      if (!(hit.t < HUGE_VALF)) continue;
      first = std::min(first, hit);
      expected.offer(hit, opacity_of_hit(rays[i], hit.t, disks[k], opacities[k]));
    }
    const Hit likely = expected.most_likely();
    for (const auto& found : hits) ASSERT_EQ(found[i], likely) << i;
    behind_the_first += likely.valid() && likely.t > first.t + 1 ? 1 : 0;
  }
  EXPECT_GT(behind_the_first, 300U);
}

}  // namespace
}  // namespace adasplats
