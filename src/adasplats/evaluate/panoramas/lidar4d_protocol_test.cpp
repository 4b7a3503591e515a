// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/panoramas/lidar4d_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr Vec3d kPlace_m{7000, 100, 2}, kOrigin_m{7000, 0, 0};

/// Scans from memory, named by their numbers.
class MemoryReader : public ScanReader {
 public:
  explicit MemoryReader(std::vector<KittiScan> scans) : scans_(std::move(scans)) {}
  KittiScan read(const std::filesystem::path& file) const override {
    return scans_[static_cast<std::size_t>(std::stoi(file.string()))];
  }

 private:
  std::vector<KittiScan> scans_;
};

KittiSequence sequence_of(std::vector<KittiScan> scans) {
  KittiSequence sequence;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    sequence.scans.emplace_back(std::to_string(i));
    sequence.trajectory.push_back({0.1 * static_cast<double>(i), {}});
    sequence.trajectory.back().world_from_sensor.translation = kPlace_m;
  }
  sequence.reader = std::make_shared<MemoryReader>(std::move(scans));
  return sequence;
}

/// A wall 10 m ahead of the sensor, 80 m wide and high, of uniform reflectance.
class Lidar4d : public ::testing::Test {
 protected:
  /// The measurements of all pixels on the wall, with ranges longer by `longer_m`.
  KittiScan scan(double longer_m, float intensity) const {
    KittiScan scan;
    const Panorama ones{std::vector<float>(layout_.pixels(), 1.0F), {}};
    for (const Vec3f direction : points_of(ones, layout_)) {
      if (!sees_wall(direction)) continue;
      const double range_m = 10 / static_cast<double>(direction.x) + longer_m;
      scan.positions.push_back(static_cast<float>(range_m) * direction);
      scan.intensities.push_back(intensity);
    }
    return scan;
  }

  static bool sees_wall(Vec3f direction) {
    return direction.x > 0 && std::hypot(direction.y, direction.z) < 4 * direction.x;
  }

  Lidar4dResult run(std::vector<KittiScan> scans) {
    const Executor executor(2);
    const auto tracer = make_cpu_tracer({disks_, nullptr}, executor);
    PrimitiveAttributes attributes;
    attributes.view = {disks_, nullptr};
    attributes.intensities = intensities_;
    ProgressSink quiet;
    return evaluate_lidar4d(*tracer, attributes, kOrigin_m, sequence_of(std::move(scans)), executor,
                            quiet);
  }

  PanoramaLayout layout_;
  std::vector<Disk> disks_ = {
      {vec_cast<float>(kPlace_m + Vec3d{10, 0, 0} - kOrigin_m), 40, {1, 0, 0}}};
  std::vector<float> intensities_ = {0.5F};
};

// Analytic: a perfect model, except for 25 cm in all ranges.
TEST_F(Lidar4d, KnownRangesGiveKnownErrors) {
  const Lidar4dResult exact = run({scan(0, 0.5F)});
  EXPECT_EQ(exact.scans, 1U);
  EXPECT_LT(exact.depth.rmse, 1e-4);
  EXPECT_NEAR(exact.depth.ssim, 1, 1e-6);
  EXPECT_EQ(exact.drop.accuracy, 1);
  EXPECT_EQ(exact.drop.rmse, 0);
  EXPECT_EQ(exact.drop.f_score, 1);
  EXPECT_LT(exact.chamfer_m2, 1e-8);
  EXPECT_EQ(exact.f_score_5cm, 1);
  ASSERT_TRUE(exact.intensity.has_value());
  EXPECT_LT(exact.intensity->rmse, 1e-6);

  const KittiScan longer = scan(0.25, 0.25F);
  const double share =
      static_cast<double>(longer.positions.size()) / static_cast<double>(layout_.pixels());
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 0.5);  // so that the median pixel has no return
  const Lidar4dResult off = run({longer});
  EXPECT_NEAR(off.depth.rmse, 0.25 * std::sqrt(share), 1e-4);
  EXPECT_LT(off.depth.medae, 1e-6);
  EXPECT_NEAR(off.depth.psnr_db, 20 * std::log10(80 / (0.25 * std::sqrt(share))), 1e-2);
  EXPECT_LT(off.depth.ssim, 1);
  EXPECT_NEAR(off.intensity->rmse, 0.25 * std::sqrt(share), 1e-4);
  EXPECT_EQ(off.drop.accuracy, 1);
  EXPECT_EQ(off.f_score_5cm, 0);
  EXPECT_GT(off.chamfer_m2, 0);
  EXPECT_LE(off.chamfer_m2, 2 * 0.0625 + 1e-6);
}

TEST_F(Lidar4d, ScansAreAveraged) {
  const Lidar4dResult one = run({scan(0, 0.5F)}), other = run({scan(0.25, 0.25F)});
  const Lidar4dResult both = run({scan(0, 0.5F), scan(0.25, 0.25F)});
  EXPECT_EQ(both.scans, 2U);
  EXPECT_NEAR(both.depth.rmse, 0.5 * (one.depth.rmse + other.depth.rmse), 1e-9);
  EXPECT_NEAR(both.chamfer_m2, 0.5 * (one.chamfer_m2 + other.chamfer_m2), 1e-9);
  EXPECT_NEAR(both.f_score_5cm, 0.5 * (one.f_score_5cm + other.f_score_5cm), 1e-9);
  EXPECT_NEAR(both.intensity->rmse, 0.5 * (one.intensity->rmse + other.intensity->rmse), 1e-9);
}

// Oracle: counts. Half of the measured points are outside the model.
TEST_F(Lidar4d, PredictsPixelsWithoutReturn) {
  KittiScan more = scan(0, 0.5F);
  const std::size_t seen = more.positions.size();
  for (std::size_t i = 0; i < seen; ++i) {
    const Vec3f p = more.positions[i];
    more.positions.push_back({-p.x, p.y, p.z});
    more.intensities.push_back(0.5F);
  }
  const Lidar4dResult result = run({more});
  const double recall = result.drop.f_score / (2 - result.drop.f_score);  // precision is 1
  EXPECT_NEAR(recall, 0.5, 0.01);  // mirrored points of one column are beyond the seam
  EXPECT_NEAR(1 - result.drop.accuracy, result.drop.rmse * result.drop.rmse, 1e-12);
}

TEST_F(Lidar4d, IntensitiesOfEightBitsAreScaled) {
  intensities_ = {100};
  const Lidar4dResult result = run({scan(0, 100)});
  EXPECT_EQ(result.intensity_scale, 255);
  EXPECT_LT(result.intensity->rmse, 1e-6);
  intensities_.clear();
  EXPECT_FALSE(run({scan(0, 100)}).intensity.has_value());
}

TEST_F(Lidar4d, NoPredictedAndNoMeasuredPoints) {
  disks_[0].center.x = -500;
  const Lidar4dResult nothing = run({scan(0, 0.5F)});
  EXPECT_TRUE(std::isnan(nothing.chamfer_m2));
  EXPECT_EQ(nothing.drop.f_score, 0);
  EXPECT_THROW(run({KittiScan()}), Error);
  EXPECT_THROW(run({}), Error);
}

}  // namespace
}  // namespace adasplats
