// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/panoramas/image_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace adasplats {
namespace {

constexpr std::uint32_t kRows = 9, kImageColumns = 11;

/// Whole numbers without order.
std::vector<float> pattern(int factor, int modulus) {
  std::vector<float> image;
  for (int i = 0; i < static_cast<int>(kRows * kImageColumns); ++i)
    image.push_back(static_cast<float>(i * factor % modulus));
  return image;
}

/// SSIM of one window by its definition: means first, then sample covariances.
double window_similarity(const std::vector<double>& a, const std::vector<double>& b, double range) {
  const auto count = static_cast<double>(a.size());
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) mean_a += a[i] / count, mean_b += b[i] / count;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a) / (count - 1);
    bb += (b[i] - mean_b) * (b[i] - mean_b) / (count - 1);
    ab += (a[i] - mean_a) * (b[i] - mean_b) / (count - 1);
  }
  const double c1 = 1e-4 * range * range, c2 = 9e-4 * range * range;
  return (2 * mean_a * mean_b + c1) * (2 * ab + c2) /
         ((mean_a * mean_a + mean_b * mean_b + c1) * (aa + bb + c2));
}

// Oracle: brute force by the definitions.
TEST(ImageError, AgreesWithTheDefinitions) {
  std::vector<float> predicted = pattern(37, 101), truth = pattern(53, 89);
  const ImageError error = image_error(predicted, truth, kImageColumns, 80);
  std::vector<double> a(predicted.begin(), predicted.end()), b(truth.begin(), truth.end());
  for (std::vector<double>* image : {&a, &b})
    for (double& value : *image) value = std::clamp(value, 1e-6, 80.0);
  double squares = 0;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += (a[i] - b[i]) * (a[i] - b[i]);
    sizes.push_back(std::fabs(a[i] - b[i]));
  }
  std::sort(sizes.begin(), sizes.end());
  EXPECT_NEAR(error.rmse, std::sqrt(squares / 99), 1e-9);
  EXPECT_NEAR(error.medae, sizes[49], 1e-6);  // the middle of 99
  EXPECT_NEAR(error.psnr_db, 10 * std::log10(6400 / (squares / 99)), 1e-9);
  const double range =
      *std::max_element(b.begin(), b.end()) - *std::min_element(b.begin(), b.end());
  double sum = 0;
  for (std::size_t row = 0; row <= 2; ++row) {
    for (std::size_t column = 0; column <= 4; ++column) {
      std::vector<double> x, y;
      for (std::size_t i = 0; i < 49; ++i) {
        x.push_back(a[(row + i / 7) * kImageColumns + column + i % 7]);
        y.push_back(b[(row + i / 7) * kImageColumns + column + i % 7]);
      }
      sum += window_similarity(x, y, range);
    }
  }
  EXPECT_NEAR(error.ssim, sum / 15, 1e-9);
}

TEST(ImageError, EqualImages) {
  const std::vector<float> image = pattern(37, 79);
  const ImageError error = image_error(image, image, kImageColumns, 80);
  EXPECT_EQ(error.rmse, 0);
  EXPECT_EQ(error.medae, 0);
  EXPECT_NEAR(error.ssim, 1, 1e-12);
  EXPECT_TRUE(std::isinf(error.psnr_db));
}

// Analytic: all pixels 0.5 off; contrasts and structure agree, so SSIM is that of the means.
TEST(ImageError, AConstantDifference) {
  std::vector<float> truth = pattern(37, 79);
  for (float& value : truth) value = value / 100 + 0.1F;
  std::vector<float> predicted = truth;
  for (float& value : predicted) value += 0.0625F;
  const ImageError error = image_error(predicted, truth, kImageColumns, 1);
  EXPECT_NEAR(error.rmse, 0.0625, 1e-6);
  EXPECT_NEAR(error.medae, 0.0625, 1e-6);
  EXPECT_NEAR(error.psnr_db, 20 * std::log10(16.0), 1e-4);
  EXPECT_LT(error.ssim, 1);
  EXPECT_GT(error.ssim, 0.9);
}

// Oracle: counted by hand. Three of six pixels have a return, two of them are predicted, and one
// more wrongly.
TEST(DropError, CountsByHand) {
  const DropError error =
      drop_error(std::vector<float>{1, 0, 5, 7, 0, 0}, std::vector<float>{2, 0, 5, 0, 9, 0});
  EXPECT_NEAR(error.accuracy, 4.0 / 6, 1e-12);
  EXPECT_NEAR(error.rmse, std::sqrt(2.0 / 6), 1e-12);
  EXPECT_NEAR(error.f_score, 2.0 / 3, 1e-12);  // precision and recall are 2 of 3
}

TEST(DropError, NothingRightAndSizesThatDoNotFit) {
  EXPECT_EQ(drop_error(std::vector<float>{1, 0}, std::vector<float>{0, 1}).f_score, 0);
  EXPECT_EQ(drop_error(std::vector<float>{0}, std::vector<float>{0}).accuracy, 1);
  EXPECT_THROW(drop_error({}, {}), std::logic_error);
  EXPECT_THROW(image_error(std::vector<float>(48), std::vector<float>(48), 8, 1), std::logic_error);
}

}  // namespace
}  // namespace adasplats
