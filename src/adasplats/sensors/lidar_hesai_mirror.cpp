// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The angle correction file of a Hesai AT128: EE FF, version, lasers, mirrors, frames, 8 bytes of
// configuration, the unit of angles; then per mirror the start and end of its frame on the encoder,
// per laser azimuth and elevation, per laser 180 corrections of each; a SHA-256 of what precedes
// (AT128 User Manual, "Angle Correction").

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/sensors/hesai_models.h"
#include "adasplats/sensors/lidar_files.h"

namespace adasplats {
namespace {

constexpr std::size_t kAtLasers = 128, kAtAdjustments = 180, kAtMostFrames = 16;
constexpr std::size_t kAtHead = 16, kAtSha = 32;
constexpr double kAtAngle_deg = 1.0 / 25600, kAtAdjustment_deg = 0.01;  // times the unit
constexpr double kAtDegreesPerAdjustment = 2;

double turned_deg(double from, double to) { return std::fmod(to - from + 720, 360); }

template <class T>
std::vector<T> scaled(std::string_view& rest, std::size_t count, auto raw, double unit) {
  std::vector<T> values;
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&raw, rest.data() + i * sizeof raw, sizeof raw);
    values.push_back(static_cast<T>(unit * static_cast<double>(raw)));
  }
  rest.remove_prefix(count * sizeof raw);
  return values;
}

MirrorAngles read_mirror(std::string_view text, const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& why) { return data_error({path, {}, {}}, why); };
  const auto byte = [&](std::size_t at) { return unsigned{static_cast<std::uint8_t>(text[at])}; };
  if (text.size() < kAtHead || !text.starts_with("\xEE\xFF"))
    throw wrong("does not begin with EE FF, expected the angle correction file of a Hesai AT128");
  if (byte(3) != 5)
    throw wrong("version " + std::to_string(byte(2)) + "." + std::to_string(byte(3)) +
                " of angle correction files is not read, expected 1.5 (AT128)");
  const std::size_t mirrors = byte(5), frames = byte(6), unit = byte(15);
  if (byte(4) != kAtLasers) throw wrong("has " + std::to_string(byte(4)) + " lasers, expected 128");
  if (mirrors == 0 || mirrors > kAtMostFrames || frames == 0 || frames > mirrors || unit == 0)
    throw wrong(std::to_string(mirrors) + " mirrors, " + std::to_string(frames) +
                " frames and unit " + std::to_string(unit) + " are not those of an AT128");
  const std::size_t size = kAtHead + 8 * mirrors + kAtLasers * (8 + 2 * kAtAdjustments) + kAtSha;
  if (text.size() != size)
    throw wrong(std::to_string(text.size()) + " bytes, expected " + std::to_string(size));
  MirrorAngles angles;
  std::string_view rest = text.substr(kAtHead);
  const double angle = kAtAngle_deg * static_cast<double>(unit);
  const double adjustment = kAtAdjustment_deg * static_cast<double>(unit);
  angles.frame_starts = scaled<double>(rest, mirrors, std::uint32_t{}, angle);
  angles.frame_ends = scaled<double>(rest, mirrors, std::uint32_t{}, angle);
  angles.frame_starts.resize(frames);
  angles.frame_ends.resize(frames);
  angles.azimuths = scaled<double>(rest, kAtLasers, std::int32_t{}, angle);
  angles.elevations = scaled<double>(rest, kAtLasers, std::int32_t{}, angle);
  angles.azimuth_adjustments =
      scaled<float>(rest, kAtLasers * kAtAdjustments, std::int8_t{}, adjustment);
  angles.elevation_adjustments =
      scaled<float>(rest, kAtLasers * kAtAdjustments, std::int8_t{}, adjustment);
  for (std::size_t frame = 0; frame < frames; ++frame)
    if (!(angles.frame_starts[frame] < 360 && angles.frame_ends[frame] < 360))
      throw wrong("frame " + std::to_string(frame) + " is not between 0 and 360 degrees");
  for (const double elevation : angles.elevations)
    if (!(std::fabs(elevation) <= 90))
      throw wrong("an elevation is " + std::to_string(elevation) + " degrees");
  for (const double azimuth : angles.azimuths)
    if (!(std::fabs(azimuth) <= 360))
      throw wrong("an azimuth is " + std::to_string(azimuth) + " degrees");
  return angles;
}

void check_beams_of_mirror(const MirrorAngles& mirror, const LidarModel& model,
                           const std::filesystem::path& path) {
  LidarModel beams = model;
  for (const double azimuth : mirror.azimuths)
    beams.azimuth_offsets_rad.push_back(-radians(azimuth));
  for (const auto& fault : {angle_fault(beams), degrees_fault(beams)})
    if (fault) throw data_error({path, {}, {}}, *fault);
}

/// The firings of one frame: a column every 41.666 us, 0.05 degrees of a mirror that turns 200
/// times a minute.
void add_frame(const MirrorAngles& mirror, LidarModel& model) {
  constexpr double kColumn_s = 41.666e-6, kColumn_deg = 0.05;
  std::vector<std::size_t> laser_of_ring(kAtLasers);
  std::iota(laser_of_ring.begin(), laser_of_ring.end(), std::size_t{0});
  std::ranges::stable_sort(laser_of_ring, std::greater<>(),
                           [&](std::size_t laser) { return mirror.elevations[laser]; });
  const double start = mirror.frame_starts[0];
  model.columns =
      static_cast<std::uint32_t>(turned_deg(start, mirror.frame_ends[0]) / kColumn_deg) + 1;
  for (std::size_t ring = 0; ring < kAtLasers; ++ring)
    for (std::uint32_t column = 0; column < model.columns; ++column) {
      const std::size_t laser = laser_of_ring[ring];
      const MirrorAngles::Angles angles =
          mirror.at(laser, 0, std::fmod(start + kColumn_deg * column, 360));
      Firing& firing = model.free_pattern.emplace_back();
      firing.direction = direction_of(radians(90 - angles.azimuth), radians(angles.elevation));
      firing.ring = static_cast<std::uint16_t>(ring);
      firing.column = column;
      firing.time_s = static_cast<float>(kColumn_s * column + late_s_of_at128(laser));
    }
}

}  // namespace

MirrorAngles::Angles MirrorAngles::at(std::size_t laser, std::size_t frame, double encoder) const {
  const double place = encoder / kAtDegreesPerAdjustment;
  const auto before = static_cast<std::size_t>(place) % kAtAdjustments;
  const double share = place - std::floor(place);
  const auto adjusted = [&](const std::vector<float>& table) {
    const float* const row = table.data() + laser * kAtAdjustments;
    return (1 - share) * row[before] + share * row[(before + 1) % kAtAdjustments];
  };
  return {2 * turned_deg(frame_starts[frame], encoder) - azimuths[laser] +
              adjusted(azimuth_adjustments),
          elevations[laser] + adjusted(elevation_adjustments)};
}

std::size_t MirrorAngles::frame_of(double encoder) const {
  std::size_t frame = 0;
  while (frame < frame_starts.size() && turned_deg(frame_starts[frame], encoder) >
                                            turned_deg(frame_starts[frame], frame_ends[frame]))
    ++frame;
  return frame;
}

LidarFile read_hesai_dat(std::string_view text, const std::filesystem::path& path) {
  auto mirror = std::make_shared<MirrorAngles>(read_mirror(text, path));
  LidarFile file = default_rotating_lidar();
  LidarModel& model = file.model;
  model.name = path.stem().string();
  model.source = path.filename().string();
  model.max_range_m = 200;
  model.range_resolution_m = 0.004;
  model.max_returns = 2;
  PacketLayout& packets = model.packets.emplace();
  packets.format = PacketFormat::at_128;
  for (std::size_t laser = 0; laser < kAtLasers; ++laser) {
    model.elevations_rad.push_back(radians(mirror->elevations[laser]));
    packets.laser_ids.push_back(static_cast<std::uint32_t>(laser));
  }
  check_beams_of_mirror(*mirror, model, path);
  add_frame(*mirror, model);
  packets.mirror = std::move(mirror);
  return file;
}

}  // namespace adasplats
