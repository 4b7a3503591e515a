// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/panoramas/image_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "adasplats/evaluate/beam_accuracy_internal.h"

namespace adasplats {
namespace {

constexpr double kMinValue = 1e-6;  // LiDAR4D's metrics raise zeros to this
constexpr std::size_t kWindow = 7;

std::vector<double> clamped(std::span<const float> image, double max_value) {
  std::vector<double> result(image.begin(), image.end());
  for (double& value : result) value = std::clamp(value, kMinValue, max_value);
  return result;
}

struct Window {
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0;  ///< sums over its pixels
};

Window window_at(const std::vector<double>& a, const std::vector<double>& b, std::size_t first,
                 std::size_t columns) {
  Window sums;
  for (std::size_t row = 0; row < kWindow; ++row) {
    for (std::size_t at = first + row * columns; at < first + row * columns + kWindow; ++at) {
      sums.x += a[at];
      sums.y += b[at];
      sums.xx += a[at] * a[at];
      sums.yy += b[at] * b[at];
      sums.xy += a[at] * b[at];
    }
  }
  return sums;
}

/// Wang et al., eq. 13.
double similarity(const Window& sums, double value_range) {
  constexpr double kPixels = kWindow * kWindow, kToSample = kPixels / (kPixels - 1);
  const double c1 = (0.01 * value_range) * (0.01 * value_range);
  const double c2 = (0.03 * value_range) * (0.03 * value_range);
  const double x = sums.x / kPixels, y = sums.y / kPixels;
  const double xx = kToSample * (sums.xx / kPixels - x * x);
  const double yy = kToSample * (sums.yy / kPixels - y * y);
  const double xy = kToSample * (sums.xy / kPixels - x * y);
  return (2 * x * y + c1) * (2 * xy + c2) / ((x * x + y * y + c1) * (xx + yy + c2));
}

double mean_similarity(const std::vector<double>& a, const std::vector<double>& b,
                       std::size_t columns) {
  const std::size_t rows = a.size() / columns;
  const auto [min, max] = std::minmax_element(b.begin(), b.end());
  double sum = 0;
  for (std::size_t row = 0; row + kWindow <= rows; ++row)
    for (std::size_t column = 0; column + kWindow <= columns; ++column)
      sum += similarity(window_at(a, b, row * columns + column, columns), *max - *min);
  return sum / static_cast<double>((rows - kWindow + 1) * (columns - kWindow + 1));
}

}  // namespace

ImageError image_error(std::span<const float> predicted, std::span<const float> truth,
                       std::uint32_t columns, double max_value) {
  if (predicted.size() != truth.size() || columns < kWindow || truth.size() % columns != 0 ||
      truth.size() / columns < kWindow)
    throw std::logic_error("image_error: sizes do not fit");
  const std::vector<double> a = clamped(predicted, max_value), b = clamped(truth, max_value);
  std::vector<float> sizes(a.size());
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += (a[i] - b[i]) * (a[i] - b[i]);
    sizes[i] = static_cast<float>(std::fabs(a[i] - b[i]));
  }
  const double mean_square = squares / static_cast<double>(a.size());
  return {std::sqrt(mean_square), median_of(sizes), mean_similarity(a, b, columns),
          10 * std::log10(max_value * max_value / mean_square)};
}

DropError drop_error(std::span<const float> predicted_m, std::span<const float> truth_m) {
  if (predicted_m.size() != truth_m.size() || truth_m.empty())
    throw std::logic_error("drop_error: sizes do not fit");
  std::size_t wrong = 0, both = 0, either = 0;
  for (std::size_t i = 0; i < truth_m.size(); ++i) {
    const bool predicted = predicted_m[i] > 0, is = truth_m[i] > 0;
    wrong += predicted != is ? 1 : 0;
    both += predicted && is ? 1 : 0;
    either += (predicted ? 1 : 0) + (is ? 1 : 0);
  }
  const double share = static_cast<double>(wrong) / static_cast<double>(truth_m.size());
  const double f_score =
      both == 0 ? 0 : 2 * static_cast<double>(both) / static_cast<double>(either);
  return {std::sqrt(share), 1 - share, f_score};
}

}  // namespace adasplats
