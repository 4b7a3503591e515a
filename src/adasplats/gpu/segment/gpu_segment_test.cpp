// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/segment/network/run_network.h"

namespace adasplats {
namespace {

/// Uneven ground, walls, poles and bushes, with intensities.
PointCloud small_place() {
  PointCloud cloud;
  Random random(3, 0, 0);
  const auto add = [&](double x, double y, double z) {
    cloud.positions.push_back(
        {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    cloud.intensities.push_back(static_cast<float>(random.uniform(0, 1)));
  };
  for (int i = 0; i < 60'000; ++i) {
    const double x = random.uniform(-30, 30), y = random.uniform(-30, 30);
    add(x, y, 0.3 * std::sin(x / 5) + random.uniform(0, 0.03));
  }
  for (int i = 0; i < 20'000; ++i) add(random.uniform(-30, 30), 12, random.uniform(0, 8));
  for (int i = 0; i < 2'000; ++i) add(-5 + random.uniform(0, 0.2), 3, random.uniform(0, 6));
  for (int i = 0; i < 10'000; ++i)
    add(8 + random.normal(), -7 + random.normal(), 2 + 0.7 * random.normal());
  return cloud;
}

bool can_multiply() {
  try {
    require_products();
    return true;
  } catch (const Error&) {
    return false;
  }
}

class NetworkOnGpu : public testing::Test {
 protected:
  void SetUp() override {
    const GpuSearch search = find_gpus();
    if (search.devices.empty()) GTEST_SKIP() << search.reason;
    if (!can_multiply()) GTEST_SKIP() << "built without OpenBLAS";
  }

  Segmentation on_cpu(const SegmentOptions& options) const {
    return segment_cloud(cloud_, network_, options, executor_);
  }
  Segmentation on_gpu(const SegmentOptions& options) const {
    return segment_cloud(cloud_, network_, options, *make_cuda_segment_engine(0), executor_);
  }

  Executor executor_;
  PointCloud cloud_ = small_place();
  Network network_ = default_network();
};

// The guarantee of docs/segmentation.md: the same class if the two best logits of the CPU differ by
// at least 1e-2, and probabilities within 1e-3.
TEST_F(NetworkOnGpu, AgreesWithTheCpu) {
  SegmentOptions options;
  options.tile_m = 20;
  options.confidences = options.probabilities = true;
  const Segmentation expected = on_cpu(options), found = on_gpu(options);
  EXPECT_EQ(found.cells, expected.cells);
  EXPECT_EQ(found.tiles, expected.tiles);
  ASSERT_EQ(found.classes.size(), expected.classes.size());
  const std::size_t classes = network_.classes.size();
  float apart = 0;
  for (std::size_t i = 0; i < expected.probabilities.size(); ++i)
    apart = std::max(apart, std::fabs(expected.probabilities[i] - found.probabilities[i]));
  EXPECT_LE(apart, 1e-3F);
  for (std::size_t i = 0; i < expected.classes.size(); ++i) {
    if (expected.classes[i] == found.classes[i]) continue;
    const float* const own = expected.probabilities.data() + i * classes;
    EXPECT_LE(std::log(own[expected.classes[i]] / own[found.classes[i]]), 1e-2F) << i;
  }
}

TEST_F(NetworkOnGpu, IsReproducible) {
  const SegmentOptions options;
  EXPECT_EQ(on_gpu(options).classes, on_gpu(options).classes);
}

TEST_F(NetworkOnGpu, AcceptsFewPointsNoIntensitiesAndPartsOfClouds) {
  SegmentOptions options;
  options.intensity = false;
  options.wanted = 1000;
  EXPECT_EQ(on_gpu(options).classes, on_cpu(options).classes);
  cloud_ = {};
  cloud_.positions = {{1, 2, 3}};
  EXPECT_EQ(on_gpu({}).classes, on_cpu({}).classes);
  cloud_ = {};
  EXPECT_TRUE(on_gpu({}).classes.empty());
}

}  // namespace
}  // namespace adasplats
