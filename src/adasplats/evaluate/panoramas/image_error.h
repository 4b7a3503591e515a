// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace adasplats {

/// Difference of two images, in their unit unless stated otherwise.
struct ImageError {
  double rmse = 0;
  double medae = 0;    ///< median of |difference|; of an even number the mean of the middle two
  double ssim = 0;     ///< structural similarity, 1 at most
  double psnr_db = 0;  ///< infinite for equal images
};

/// Compares all pixels, both images (row by row) clamped to 1e-6 .. `max_value`, as LiDAR4D's
/// utils/metrics.py does. PSNR is against `max_value`. SSIM (Wang et al. 2004) with the defaults of
/// scikit-image: the mean over all whole windows of 7 x 7 with sample covariances, K1 = 0.01, K2 =
/// 0.03 of the range of values of `truth`. Throws std::logic_error if sizes differ or an image is
/// smaller than a window.
ImageError image_error(std::span<const float> predicted, std::span<const float> truth,
                       std::uint32_t columns, double max_value);

/// How well the pixels with a return are predicted.
struct DropError {
  double rmse = 0;  ///< of 1 for a return, 0 for none
  double accuracy = 0;
  double f_score = 0;  ///< of pixels with a return; 0 if none is right
};

/// From the ranges of two images of the same size, not empty; 0: no return.
DropError drop_error(std::span<const float> predicted_m, std::span<const float> truth_m);

}  // namespace adasplats
