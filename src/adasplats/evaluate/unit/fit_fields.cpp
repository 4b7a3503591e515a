// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Measured turns of a sensor, for the variation that its parameters do not describe.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "adasplats/evaluate/unit/fit_unit.h"

namespace adasplats {
namespace {

constexpr float kUnestimated = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kMaxTurns = 2;  // 0.8 MB of an HDL-64E

/// [begin, end) of the beams of each scan.
std::vector<std::pair<std::size_t, std::size_t>> spans_of_scans(std::span<const SensorBeam> beams) {
  std::vector<std::pair<std::size_t, std::size_t>> spans;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (i == 0 || beams[i].scan != beams[i - 1].scan) spans.emplace_back(i, i);
    spans.back().second = i + 1;
  }
  return spans;
}

/// Fills the gaps (NaN) in the numbers of a ring, one per column, with the mirrored values next to
/// them, half from either side. `otherwise`: for a ring without values.
void fill_gaps(std::span<float> ring, float otherwise) {
  std::vector<std::size_t> known;
  for (std::size_t c = 0; c < ring.size(); ++c)
    if (ring[c] == ring[c]) known.push_back(c);
  if (known.empty()) {
    std::ranges::fill(ring, otherwise);
    return;
  }
  const std::vector<float> measured(ring.begin(), ring.end());
  // Value k of the known ones, continued around the turn.
  const auto around = [&](std::ptrdiff_t k) {
    const auto count = static_cast<std::ptrdiff_t>(known.size());
    return measured[known[static_cast<std::size_t>((k % count + count) % count)]];
  };
  for (std::size_t next = 0; next <= known.size(); ++next) {
    const std::size_t begin = next == 0 ? 0 : known[next - 1] + 1;
    const std::size_t end = next == known.size() ? ring.size() : known[next];
    for (std::size_t c = begin; c < end; ++c) {
      const auto from_left = static_cast<std::ptrdiff_t>(c - begin);
      const auto from_right = static_cast<std::ptrdiff_t>(end - 1 - c);
      const auto at = static_cast<std::ptrdiff_t>(next);
      ring[c] = from_left < from_right ? around(at - 1 - from_left) : around(at + from_right);
    }
  }
}

/// Scales the noise of a ring to that of neighbouring returns on smooth surfaces; elsewhere it
/// includes errors of the model.
void scale_noise(std::span<float> ring, double noise_m) {
  std::vector<float> second;
  for (std::size_t c = 0; c + 2 < ring.size(); ++c)
    second.push_back(std::fabs(ring[c] - 2 * ring[c + 1] + ring[c + 2]));
  const double found_m = noise_of_second_differences(second);
  const auto factor = static_cast<float>(found_m > 0 ? noise_m / found_m : 0.0);
  for (float& value : ring) value *= factor;
}

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::floor(value), 0.0, 255.0));
}

/// The inverse of beam_fields().
std::uint8_t coded(SensorField field, float value) {
  const auto v = static_cast<double>(value);
  if (field == SensorField::drop || field == SensorField::zero) return byte_of(256 * std::sqrt(v));
  if (field == SensorField::intensity) return byte_of(256 * v);
  const double root = 127 * std::sqrt(std::fabs(v) / kMaxFieldNoise_m);
  return byte_of(128.5 + (v < 0 ? -root : root));
}

/// Measured less modelled range; NaN if they are of different surfaces.
float noise_m_of(const SensorBeam& beam) {
  const float noise_m = beam.range_m - beam.expected_m;
  const bool is_one_surface = beam.hit && std::fabs(noise_m) < static_cast<float>(kMaxFieldNoise_m);
  return is_one_surface ? noise_m : kUnestimated;
}

/// The value of a field for one beam; NaN if not estimated.
float number_of(SensorField field, const SensorBeam& beam, std::size_t i,
                const BeamShares& shares) {
  const auto share = [&](std::span<const float> all) {
    return all.empty() ? kUnestimated : all[i];
  };
  switch (field) {
    case SensorField::drop: return share(shares.drop);
    case SensorField::intensity: return share(shares.intensity);
    case SensorField::zero: return share(shares.zero);
    case SensorField::noise: break;
  }
  return noise_m_of(beam);
}

}  // namespace

SensorFields fit_unit_fields(std::span<const SensorBeam> beams, const UnitPattern& pattern,
                             std::span<const double> ring_noise_m, const BeamShares& shares) {
  const auto spans = spans_of_scans(beams);
  const std::size_t turns = std::min(kMaxTurns, spans.size());
  const std::size_t rings = pattern.rings, columns = pattern.columns;
  SensorFields fields;
  fields.turns = static_cast<std::uint32_t>(turns);
  fields.rings = static_cast<std::uint32_t>(rings);
  fields.columns = static_cast<std::uint32_t>(columns);
  fields.bytes.resize(turns * rings * columns * kSensorFields);
  std::vector<float> numbers(rings * columns);
  const auto fill_ring = [&](SensorField field, std::size_t ring) {
    const std::span<float> of_ring = std::span(numbers).subspan(ring * columns, columns);
    fill_gaps(of_ring, field == SensorField::noise ? 0.0F : 0.5F);
    if (field == SensorField::noise)
      scale_noise(of_ring, ring < ring_noise_m.size() ? ring_noise_m[ring] : 0.0);
  };
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const auto [begin, end] = spans[turn * spans.size() / turns];
    for (const SensorField field :
         {SensorField::drop, SensorField::intensity, SensorField::noise, SensorField::zero}) {
      std::ranges::fill(numbers, kUnestimated);
      for (std::size_t i = begin; i < end; ++i)
        if (beams[i].ring < rings && beams[i].column < columns)
          numbers[beams[i].ring * columns + beams[i].column] =
              number_of(field, beams[i], i, shares);
      for (std::size_t ring = 0; ring < rings; ++ring) fill_ring(field, ring);
      for (std::size_t k = 0; k < numbers.size(); ++k)
        fields
            .bytes[(turn * rings * columns + k) * kSensorFields + static_cast<std::size_t>(field)] =
            coded(field, numbers[k]);
    }
  }
  return fields;
}

}  // namespace adasplats
