// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/intensity_scale.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr float kMaxOfByte = 255;

/// One that is not finite is not known, and says nothing.
bool can_be_byte(float value) {
  return !std::isfinite(value) || (value >= 0 && value <= kMaxOfByte && value == std::trunc(value));
}

bool is_above_share(float value) { return std::isfinite(value) && value > 1; }

Error other_scale(const std::filesystem::path& file, float value, const char* others) {
  return {ErrorKind::data, file.string() + ": has an intensity of " +
                               exact_text(static_cast<double>(value)) +
                               ", but those of other scans are " + others};
}

}  // namespace

IntensityScale::IntensityScale(std::span<const std::vector<float>> sample) {
  bool all_bytes = true, any_above = false;
  for (const std::vector<float>& scan : sample) {
    all_bytes = all_bytes && std::ranges::all_of(scan, can_be_byte);
    any_above = any_above || std::ranges::any_of(scan, is_above_share);
  }
  is_bytes_ = all_bytes && any_above;
  are_shares_ = !any_above;
}

std::vector<float> IntensityScale::scaled(std::vector<float> intensities,
                                          const std::filesystem::path& file) const {
  if (is_bytes_) {
    const auto wrong = std::ranges::find_if_not(intensities, can_be_byte);
    if (wrong != intensities.end()) throw other_scale(file, *wrong, "whole numbers from 0 to 255");
    for (float& value : intensities) value /= kMaxOfByte;
  } else if (are_shares_) {
    const auto wrong = std::ranges::find_if(intensities, is_above_share);
    if (wrong != intensities.end()) throw other_scale(file, *wrong, "at most 1");
  }
  return intensities;
}

IntensityScale scale_of_scans(const ScanSource& source,
                              const std::vector<std::filesystem::path>& files) {
  const std::set<std::size_t> chosen = {0, files.size() / 2, files.size() - 1};
  std::vector<std::vector<float>> sample;
  sample.reserve(chosen.size());
  for (const std::size_t k : chosen) sample.push_back(source.read(files[k]).intensities);
  return IntensityScale(sample);
}

std::string IntensityScale::description() const {
  return is_bytes_ ? "0 to 255 in the files, divided by 255" : "as in the files";
}

}  // namespace adasplats
