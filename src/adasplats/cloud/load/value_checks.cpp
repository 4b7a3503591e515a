// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/value_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace adasplats {
namespace {

constexpr std::size_t kMaxSamples = 4096, kMinSamples = 100;

/// Up to kMaxSamples finite values, spread over `count` without a period that rows of a raster
/// have.
template <class Value>
std::vector<double> sampled(std::size_t count, Value&& value) {
  std::vector<double> samples;
  constexpr std::uint64_t kSpread = 2654435761;  // a prime
  for (std::size_t i = 0; i < std::min(count, kMaxSamples); ++i) {
    const double v =
        value(count <= kMaxSamples ? i : static_cast<std::size_t>(i * kSpread % count));
    if (std::isfinite(v)) samples.push_back(v);
  }
  return samples;
}

std::string text_of(double value) {
  std::array<char, 32> buffer;
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

struct AxisSteps {
  double step_m = 0;  ///< 0: no common step
  bool is_float32 = false;
};

/// The step of which (almost) all distances between neighbouring values are multiples.
AxisSteps common_step_of(std::vector<double> values) {
  constexpr double kMinShare = 0.95, kTolerance = 0.1, kEqual_m = 1e-6;
  std::ranges::sort(values);
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] > kEqual_m) gaps.push_back(values[i] - values[i - 1]);
  if (gaps.size() < 3) return {};
  const double step = *std::ranges::min_element(gaps);
  const auto multiples = std::ranges::count_if(gaps, [step](double gap) {
    return std::fabs(gap / step - std::round(gap / step)) < kTolerance;
  });
  if (static_cast<double>(multiples) < kMinShare * static_cast<double>(gaps.size())) return {};
  const bool is_float32 = std::ranges::all_of(
      values, [](double v) { return static_cast<double>(static_cast<float>(v)) == v; });
  return {step, is_float32 && std::exp2(std::round(std::log2(step))) == step};
}

bool is_power_of_ten(double value) {
  const double power = std::log10(value);
  return std::fabs(power - std::round(power)) < 1e-3;
}

/// Share of the sampled points with the x and y of another one.
double share_in_one_place(std::span<const Vec3d> world) {
  std::vector<Vec3d> places;
  const std::size_t count = std::min(world.size(), kMaxSamples * 4);
  places.assign(world.begin(), world.begin() + static_cast<std::ptrdiff_t>(count));
  std::ranges::sort(
      places, [](const Vec3d& a, const Vec3d& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::size_t shared = 0;
  for (std::size_t i = 1; i < count; ++i)
    if (places[i].x == places[i - 1].x && places[i].y == places[i - 1].y) ++shared;
  return static_cast<double>(shared) / static_cast<double>(count);
}

}  // namespace

void warn_of_steps(const std::filesystem::path& file, std::span<const Vec3d> world,
                   ProgressSink& progress) {
  constexpr double kMin_m = 0.0105, kFar_m = 10e3, kManyShared = 0.1;
  constexpr double kMinOfGrid_m = 0.2;  // steps of a raster
  std::string text;
  double first_step = 0;
  bool are_float32 = true, have_lost_digits = true, are_alike = true, is_fine_float32 = false;
  AxisSteps steps;  // of z after the loop
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values =
        sampled(world.size(), [&](std::size_t i) { return world[i][axis]; });
    if (values.size() < kMinSamples) return;
    const auto [low, high] = std::ranges::minmax(values);
    steps = common_step_of(std::move(values));
    if (steps.step_m < kMin_m || std::max(-low, high) < kFar_m) continue;
    text += (text.empty() ? "" : ", ") + std::string(1, "xyz"[axis]) + " of " +
            text_of(steps.step_m) + " m";
    if (first_step == 0) first_step = steps.step_m;
    are_alike = are_alike && std::fabs(steps.step_m - first_step) < kMin_m;
    are_float32 = are_float32 && steps.is_float32;
    have_lost_digits = have_lost_digits && (steps.is_float32 || is_power_of_ten(steps.step_m));
    is_fine_float32 = is_fine_float32 || (steps.is_float32 && steps.step_m < kMinOfGrid_m);
  }
  if (text.empty()) return;
  const bool is_lossy = is_fine_float32 || (have_lost_digits && !are_alike);
  const bool has_fine_heights = steps.step_m < kMin_m;
  if (!is_lossy && !(has_fine_heights && share_in_one_place(world) >= kManyShared)) return;
  progress.warn(file.string() + ": coordinates are on steps (" + text +
                "): " + (are_float32 ? "32-bit numbers" : "a writer with few digits") +
                " lost the rest; surfaces are as coarse. Convert the original file with 64-bit "
                "coordinates, or relative to an origin nearby");
}

void IntensityScales::add(const std::filesystem::path& file, std::span<const float> intensities) {
  std::vector<double> values = sampled(
      intensities.size(), [&](std::size_t i) { return static_cast<double>(intensities[i]); });
  if (values.size() < kMinSamples) return;
  std::ranges::sort(values);
  const auto at = [&values](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  Range range{at(0.02), at(0.5), at(0.98), file.string(), {}};
  range.text = text_of(range.low) + " to " + text_of(range.high);
  if (!(range.median > 0)) return;
  if (least_.file.empty() || range.median < least_.median) least_ = range;
  if (most_.file.empty() || range.median > most_.median) most_ = range;
}

std::string IntensityScales::warning() const {
  constexpr double kMinFactor = 8;
  if (most_.file == least_.file || most_.median < kMinFactor * least_.median ||
      least_.high >= most_.low)
    return {};
  return "intensities of the inputs have different scales: " + least_.text + " in " + least_.file +
         ", " + most_.text + " in " + most_.file +
         " (2nd to 98th percentile); bring them to one scale, or reflectances are wrong";
}

void warn_of_intensity_scales(std::span<const CloudPart> parts, ProgressSink& progress) {
  IntensityScales scales;
  for (const CloudPart& part : parts)
    if (!part.runs.empty()) scales.add(part.runs.front().file, part.cloud.intensities);
  if (const std::string warning = scales.warning(); !warning.empty()) progress.warn(warning);
}

}  // namespace adasplats
