// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/hesai_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace adasplats {
namespace {

constexpr double kMicrosecond_in_s = 1e-6;

constexpr double kTimesOf40p_us[40] = {12.45, 26.2,  38.63, 51.05, 9.18,  22.93, 7.21,  0,
                                       34.05, 20.96, 13.76, 46.48, 34.05, 27.51, 3.94,  46.48,
                                       39.93, 17.69, 9.18,  1.97,  30.78, 22.93, 15.72, 43.2,
                                       36.02, 29.48, 5.91,  48.44, 41.9,  19.66, 32.75, 45.17,
                                       11.15, 24.9,  37.32, 49.75, 12.45, 26.2,  38.63, 51.05};

/// Lasers (from 1) in the order in which the two sequences of a QT128 fire them.
constexpr std::uint8_t kQt128Sequences[2][96] = {
    {99,  65, 35, 102, 72, 38, 107, 73, 43, 110, 80, 46, 115, 81, 51, 118, 88, 54, 123, 89, 59,
     126, 96, 62, 97,  67, 33, 104, 70, 40, 105, 75, 41, 112, 78, 48, 113, 83, 49, 120, 86, 56,
     121, 91, 57, 128, 94, 64, 98,  68, 34, 103, 69, 39, 106, 76, 42, 111, 77, 47, 114, 84, 50,
     119, 85, 55, 122, 92, 58, 127, 93, 63, 100, 66, 36, 101, 71, 37, 108, 74, 44, 109, 79, 45,
     116, 82, 52, 117, 87, 53, 124, 90, 60, 125, 95, 61},
    {65, 99,  1,  72, 102, 8,  73, 107, 9,  80, 110, 16, 81, 115, 17, 88, 118, 24, 89, 123, 25,
     96, 126, 32, 67, 97,  3,  70, 104, 6,  75, 105, 11, 78, 112, 14, 83, 113, 19, 86, 120, 22,
     91, 121, 27, 94, 128, 30, 68, 98,  4,  69, 103, 5,  76, 106, 12, 77, 111, 13, 84, 114, 20,
     85, 119, 21, 92, 122, 28, 93, 127, 29, 66, 100, 2,  71, 101, 7,  74, 108, 10, 79, 109, 15,
     82, 116, 18, 87, 117, 23, 90, 124, 26, 95, 125, 31}};

/// Lasers of an OT128 fire in odd columns (o), even ones (e) or both (b); capitals 2.144 us later
/// in one azimuth state.
constexpr std::string_view kOt128Columns =
    "ooEeooEeooEeooEeooEeooEeBBbBBbBbBbbbbbBBBBBbbBbbbBBbBbBBbbbBbbBB"
    "BBBbbBbbbBBbBbBBbbbBbbBBooEeooEeooEeooEeooEeooEeooEeooEeooEeooEe";

/// Firing times of an AT128, ns, and the index of each laser's as a letter.
constexpr std::int64_t kAt128Times_ns[] = {0,    848,  2504,  4112,  4144,  4976,  6616, 8240,
                                           8264, 9112, 10768, 12376, 12424, 13280, 14928};
constexpr std::string_view kAt128Lasers =
    "aahdehaamedillimaadheaaemidllmibcfggjcbknnfjookcbgfjgbcnkfnnjkon"
    "bjncfbcokkofggjknnjfccbkookgfjgdmaeaamaimmhhillmdeaaaaamiheihlli";

std::array<double, 128> qt128_times_s(unsigned sequence) {
  std::array<double, 128> times_s{};
  for (std::size_t i = 0; i < 96; ++i) {
    const std::size_t group = i / 3;
    times_s[kQt128Sequences[sequence][i] - 1U] =
        kMicrosecond_in_s *
        (0.6 + 0.856 * static_cast<double>(i % 3) + 3.168 * static_cast<double>(group));
  }
  return times_s;
}

}  // namespace

std::vector<double> hesai_firing_times_s(PacketFormat format) {
  std::vector<double> times_s;
  const auto add = [&](double time_us) { times_s.push_back(kMicrosecond_in_s * time_us); };
  if (format == PacketFormat::pandar_40p)
    for (const double time_us : kTimesOf40p_us) add(time_us);
  if (format == PacketFormat::xt_16)
    for (int i = 0; i < 16; ++i) add(3.024 * i);
  if (format == PacketFormat::xt_32m)
    for (int i = 0; i < 32; ++i) add(2.888 * (i % 16));
  if (format == PacketFormat::pandar_qt) {
    constexpr double kOfGroup_us[] = {0, 2.06, 4.12, 6.18, 8.23, 10.29, 12.35, 14.4};
    for (int i = 0; i < 64; ++i) {
      const int half = i / 8 % 2, quarter = i / 16;
      add(kOfGroup_us[i % 8] + 16.845 * half + 34.295 * quarter);
    }
  }
  return times_s;
}

double late_s_of_qt128(unsigned sequence, std::size_t laser) {
  static const std::array<std::array<double, 128>, 2> kTimes_s = {qt128_times_s(0),
                                                                  qt128_times_s(1)};
  return kTimes_s.at(sequence).at(laser);
}

double late_s_of_ot128(double fine_s, bool is_fine, unsigned azimuth_state, std::size_t laser) {
  const char columns = kOt128Columns.at(laser);
  double time_us = 0;
  if (!is_fine && columns == 'o') time_us += 27.778;
  if ((columns == 'E' || columns == 'B') && azimuth_state == (is_fine ? 2U : 1U)) time_us += 2.144;
  return fine_s + kMicrosecond_in_s * time_us;
}

double late_s_of_at128(std::size_t laser) {
  const auto index = static_cast<std::size_t>(kAt128Lasers.at(laser) - 'a');
  return 1e-9 * static_cast<double>(kAt128Times_ns[index]);
}

std::optional<PacketFormat> hesai_model_of(const std::vector<double>& elevations_deg,
                                           const std::vector<double>& azimuths_deg) {
  constexpr double kTopOfXt32_deg = 17, kWidestOfOt128_deg = 5;
  if (elevations_deg.empty()) return std::nullopt;
  const double top_deg = std::ranges::max(elevations_deg);
  // QT sensors count from the lowest laser.
  const bool counts_upwards = elevations_deg.front() < elevations_deg.back();
  const double widest_deg =
      std::ranges::max(azimuths_deg, {}, [](double angle) { return std::fabs(angle); });
  switch (elevations_deg.size()) {
    case 16: return PacketFormat::xt_16;
    case 32: return top_deg < kTopOfXt32_deg ? PacketFormat::xt_32 : PacketFormat::xt_32m;
    case 40: return PacketFormat::pandar_40p;
    case 64: return counts_upwards ? PacketFormat::pandar_qt : PacketFormat::pandar_64;
    case 128: break;
    default: return std::nullopt;
  }
  if (counts_upwards) return PacketFormat::qt_128;
  // A Pandar128E3X has the same packets but other firing times.
  if (std::fabs(widest_deg) > kWidestOfOt128_deg) return std::nullopt;
  return PacketFormat::ot_128;
}

}  // namespace adasplats
