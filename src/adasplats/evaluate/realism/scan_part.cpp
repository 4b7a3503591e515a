// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/scan_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/small_matrix.h"

namespace adasplats {
namespace {

constexpr double kUnknownValue = std::numeric_limits<double>::quiet_NaN();
constexpr float kOneSurface_m = 0.3F;  // more than ten times the noise of rotating LiDARs
constexpr float kEdge_m = 0.5F;
constexpr std::size_t kMinOfRing = 8;  // values that a ring's median is of

/// A piece that a plane is fitted to.
constexpr std::size_t kPieceColumns = 8;
constexpr std::size_t kMinInPiece = 32;     // of 64
constexpr std::size_t kMinInPieceRing = 3;  // returns that a ring's mean is of
constexpr double kMaxOffPlane_m = 0.15;     // RMS of a plane: five times real noise

/// Returns [begin, end) of a ring.
struct RingSpan {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

RingSpan span_of(const RingScan& scan, std::size_t ring, double begin_rad, double end_rad) {
  const auto first = scan.azimuths_rad.begin();
  const auto low = first + static_cast<std::ptrdiff_t>(scan.begins[ring]);
  const auto high = first + static_cast<std::ptrdiff_t>(scan.begins[ring + 1]);
  const auto begin = std::lower_bound(low, high, static_cast<float>(begin_rad));
  const auto end = std::lower_bound(begin, high, static_cast<float>(end_rad));
  return {static_cast<std::size_t>(begin - first), static_cast<std::size_t>(end - first)};
}

/// Beams of long runs of a ring within a part.
double nothing_in(const RingScan& scan, std::size_t ring, const RingSpan& span,
                  const PartOfScan& part, double step_rad) {
  const std::size_t begin = scan.begins[ring], end = scan.begins[ring + 1];
  if (begin == end) return (part.end_rad - part.begin_rad) / step_rad;
  double beams = 0;
  const auto add = [&](std::size_t i, double turned_rad) {
    if (scan.missing[i] <= kLongestRun) return;
    const double from = static_cast<double>(scan.azimuths_rad[i]) + turned_rad + 0.5 * step_rad;
    const double to = from + scan.missing[i] * step_rad;
    beams += std::max(0.0, std::min(to, part.end_rad) - std::max(from, part.begin_rad)) / step_rad;
  };
  for (std::size_t i = span.begin; i < span.end; ++i) add(i, 0);
  if (span.begin > begin) {
    add(span.begin - 1, 0);
  } else {
    add(end - 1, -2 * std::numbers::pi);  // the run over the seam
  }
  return beams;
}

void count_run(const RingScan& scan, std::size_t i, std::size_t next, PartCounts& counts) {
  const std::uint32_t run = scan.missing[i];
  if (run == 0 || run > kLongestRun) return;
  counts.missing += run;
  counts.missing_6_to_20 += run > 5 ? run : 0;
  (run == 1 ? counts.runs_of_1 : run <= 5 ? counts.runs_to_5 : counts.runs_to_20) += 1;
  counts.runs_at_edges += std::fabs(scan.ranges_m[next] - scan.ranges_m[i]) > kEdge_m ? 1 : 0;
}

void count_pair(const RingScan& scan, std::size_t i, double step_rad, PartCounts& counts) {
  ++counts.neighbors;
  const double gap =
      static_cast<double>(scan.azimuths_rad[i + 1] - scan.azimuths_rad[i]) / step_rad;
  counts.gap_steps += gap;
  counts.gap_square_steps2 += gap * gap;
  counts.edges += std::fabs(scan.ranges_m[i + 1] - scan.ranges_m[i]) > kEdge_m ? 1 : 0;
  const float a = scan.intensities[i], b = scan.intensities[i + 1];
  if (a != a || b != b) return;
  ++counts.known_pairs;
  counts.equal += a == b ? 1 : 0;
  if (a != 0) return;
  ++counts.zero_pairs;
  counts.zero_next += b == 0 ? 1 : 0;
}

/// Second differences of one ring.
class SecondDifferences {
 public:
  explicit SecondDifferences(PartCounts& counts) : counts_(counts) {}

  /// The middle of three neighbours that returned.
  void add(const RingScan& scan, std::size_t i) {
    const float left = scan.ranges_m[i] - scan.ranges_m[i - 1];
    const float right = scan.ranges_m[i + 1] - scan.ranges_m[i];
    ++counts_.triples;
    const bool far = std::fabs(left) > kOneSurface_m && std::fabs(right) > kOneSurface_m;
    counts_.between += far && (left > 0) == (right > 0) ? 1 : 0;
    counts_.isolated += far && (left > 0) != (right > 0) ? 1 : 0;
    if (!(std::fabs(left) < kOneSurface_m && std::fabs(right) < kOneSurface_m)) return;
    const float second = right - left;
    const float second_intensity =
        scan.intensities[i - 1] - 2 * scan.intensities[i] + scan.intensities[i + 1];
    own_m_.push_back(std::fabs(second));
    add_product(i, second, before_m_, counts_.square_m2, counts_.product_m2);
    if (second_intensity == second_intensity) {
      counts_.second_intensity.push_back(std::fabs(second_intensity));
      add_product(i, second_intensity, before_intensity_, counts_.square_intensity,
                  counts_.product_intensity);
    }
    before_m_ = second;
    before_intensity_ = second_intensity;
    before_ = i;
  }

  void end_ring() {
    counts_.second_m.insert(counts_.second_m.end(), own_m_.begin(), own_m_.end());
    std::ranges::sort(own_m_);
    if (own_m_.size() >= kMinOfRing)
      counts_.ring_second_m.push_back(mean_between(own_m_, 0.25, 0.75));
  }

 private:
  void add_product(std::size_t i, float value, float before, double& square,
                   double& product) const {
    const auto v = static_cast<double>(value), b = static_cast<double>(before);
    if (before_ + 1 != i || b != b) return;
    square += 0.5 * (v * v + b * b);
    product += v * b;
  }

  PartCounts& counts_;
  std::vector<float> own_m_;
  float before_m_ = 0, before_intensity_ = 0;
  std::size_t before_ = static_cast<std::size_t>(-2);
};

double ring_median(const RingScan& scan, const RingSpan& span) {
  std::vector<float> known;
  for (std::size_t i = span.begin; i < span.end; ++i)
    if (scan.intensities[i] == scan.intensities[i]) known.push_back(scan.intensities[i]);
  std::ranges::sort(known);
  return known.size() < kMinOfRing ? kUnknownValue : quantile_of(known, 0.5);
}

void count_ring(const RingScan& scan, std::size_t ring, const RingSpan& span,
                const PartOfScan& part, double step_rad, PartCounts& counts) {
  const std::size_t first = scan.begins[ring], end = scan.begins[ring + 1];
  SecondDifferences differences(counts);
  const std::size_t missing_before = counts.missing;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    counts.ranges_m.push_back(scan.ranges_m[i]);
    const float intensity = scan.intensities[i];
    if (intensity == intensity) {
      counts.intensities.push_back(intensity);
      ++counts.known;
      counts.zeros += intensity == 0 ? 1 : 0;
    }
    const bool last = i + 1 == end;
    count_run(scan, i, last ? first : i + 1, counts);
    if (last || scan.missing[i] > 0) continue;
    count_pair(scan, i, step_rad, counts);
    if (i > first && scan.missing[i - 1] == 0) differences.add(scan, i);
  }
  differences.end_ring();
  counts.returns += span.size();
  counts.ring_intensity.push_back(ring_median(scan, span));
  counts.nothing +=
      static_cast<std::size_t>(std::lround(nothing_in(scan, ring, span, part, step_rad)));
  const auto missing = static_cast<double>(counts.missing - missing_before);
  if (span.size() >= kMinOfRing)
    counts.ring_missing.push_back(missing / (missing + static_cast<double>(span.size())));
}

void count_across(const MissingBeams& missing, const PartOfScan& part, double step_rad,
                  PartCounts& counts) {
  const auto begin = static_cast<std::size_t>(part.begin_rad / step_rad);
  const auto end = std::min(missing.columns, static_cast<std::size_t>(part.end_rad / step_rad));
  for (std::size_t ring = part.first_ring; ring + 1 < part.end_ring; ++ring) {
    for (std::size_t column = begin; column < end; ++column) {
      if (missing.at[ring * missing.columns + column] == 0) continue;
      ++counts.missing_above;
      counts.missing_across += missing.near(ring + 1, column) ? 1 : 0;
    }
  }
}

/// Fits the plane a . p = 1 to points p = range * direction by least squares and adds the range
/// errors as a piece, if the points form a plane.
void add_plane(const RingScan& scan, std::size_t first_ring, std::span<const RingSpan> spans,
               std::vector<PlanePiece>& pieces) {
  std::array<double, 9> matrix{};
  std::array<double, 3> right{};
  std::size_t count = 0;
  const auto point_of = [&](std::size_t i) {
    return static_cast<double>(scan.ranges_m[i]) * vec_cast<double>(scan.directions[i]);
  };
  for (const RingSpan& span : spans) {
    for (std::size_t i = span.begin; i < span.end; ++i, ++count) {
      const Vec3d p = point_of(i);
      const std::array<double, 3> at = {p.x, p.y, p.z};
      for (std::size_t a = 0; a < 3; ++a) {
        right[a] += at[a];
        for (std::size_t b = 0; b < 3; ++b) matrix[3 * a + b] += at[a] * at[b];
      }
    }
  }
  if (count < kMinInPiece) return;
  factor<3>(matrix);
  const std::array<double, 3> plane = solved<3>(matrix, right);
  PlanePiece piece;
  piece.first_ring = first_ring;
  piece.ring_m.fill(kUnknownValue);
  double within = 0, within_count = 0, between = 0, rings = 0, all = 0;
  for (std::size_t k = 0; k < spans.size(); ++k) {
    double sum = 0, squares = 0;
    for (std::size_t i = spans[k].begin; i < spans[k].end; ++i) {
      const Vec3d d = vec_cast<double>(scan.directions[i]);
      const double along = plane[0] * d.x + plane[1] * d.y + plane[2] * d.z;
      if (!(along > 1e-6)) return;  // the plane passes the sensor
      const double error_m = static_cast<double>(scan.ranges_m[i]) - 1 / along;
      sum += error_m;
      squares += error_m * error_m;
    }
    all += squares;
    const auto n = static_cast<double>(spans[k].size());
    if (spans[k].size() < kMinInPieceRing) continue;
    piece.ring_m[k] = sum / n;
    within += squares - sum * sum / n;
    within_count += n - 1;
    between += sum * sum / (n * n);
    ++rings;
  }
  if (!(all < kMaxOffPlane_m * kMaxOffPlane_m * static_cast<double>(count)) || rings < 4) return;
  piece.within_m = std::sqrt(within / within_count);
  piece.between_m = std::sqrt(between / rings);
  pieces.push_back(piece);
}

void add_planes(const RingScan& scan, const PartOfScan& part, double step_rad, PartCounts& counts) {
  const double width_rad = kPieceColumns * step_rad;
  for (std::size_t ring = part.first_ring; ring + kPlaneRings <= part.end_ring;
       ring += kPlaneRings) {
    for (double at_rad = part.begin_rad; at_rad + width_rad <= part.end_rad + 1e-9;
         at_rad += width_rad) {
      std::array<RingSpan, kPlaneRings> spans;
      for (std::size_t k = 0; k < kPlaneRings; ++k)
        spans[k] = span_of(scan, ring + k, at_rad, at_rad + width_rad);
      add_plane(scan, ring, spans, counts.planes);
    }
  }
}

}  // namespace

MissingBeams::MissingBeams(const RingScan& scan, double step_rad)
    : columns(static_cast<std::size_t>(std::ceil(2 * std::numbers::pi / step_rad))),
      at(scan.rings() * columns, 0) {
  for (std::size_t ring = 0; ring < scan.rings(); ++ring) {
    for (std::size_t i = scan.begins[ring]; i < scan.begins[ring + 1]; ++i) {
      if (scan.missing[i] > kLongestRun) continue;
      for (std::uint32_t k = 1; k <= scan.missing[i]; ++k) {
        const double azimuth_rad = static_cast<double>(scan.azimuths_rad[i]) + k * step_rad;
        const auto column = static_cast<std::size_t>(azimuth_rad / step_rad);
        at[ring * columns + column % columns] = 1;
      }
    }
  }
}

bool MissingBeams::near(std::size_t ring, std::size_t column) const {
  const std::uint8_t* row = at.data() + ring * columns;
  return row[column] != 0 || row[(column + 1) % columns] != 0 ||
         row[(column + columns - 1) % columns] != 0;
}

PartCounts count_part(const RingScan& scan, const MissingBeams& missing, const PartOfScan& part,
                      double step_rad) {
  PartCounts counts;
  for (std::size_t ring = part.first_ring; ring < part.end_ring; ++ring)
    count_ring(scan, ring, span_of(scan, ring, part.begin_rad, part.end_rad), part, step_rad,
               counts);
  counts.beams = counts.returns + counts.missing + counts.nothing;
  count_across(missing, part, step_rad, counts);
  add_planes(scan, part, step_rad, counts);
  for (auto* values :
       {&counts.ranges_m, &counts.intensities, &counts.second_m, &counts.second_intensity})
    std::ranges::sort(*values);
  return counts;
}

double PartCounts::gap_deviation() const {
  if (neighbors == 0) return kUnknownValue;
  const auto n = static_cast<double>(neighbors);
  const double mean = gap_steps / n;
  return std::sqrt(std::max(0.0, gap_square_steps2 / n - mean * mean));
}

double quantile_of(std::span<const float> ascending, double share) {
  if (ascending.empty()) return kUnknownValue;
  const double at = share * static_cast<double>(ascending.size() - 1);
  return static_cast<double>(ascending[static_cast<std::size_t>(std::lround(at))]);
}

double mean_between(std::span<const float> ascending, double from, double to) {
  const auto size = static_cast<double>(ascending.size());
  const auto begin = static_cast<std::size_t>(from * size);
  const auto end = std::min(ascending.size(), static_cast<std::size_t>(std::ceil(to * size)));
  double sum = 0;
  for (std::size_t k = begin; k < end; ++k) sum += static_cast<double>(ascending[k]);
  return begin < end ? sum / static_cast<double>(end - begin) : kUnknownValue;
}

double median_of_known(std::vector<double> values) {
  std::erase_if(values, [](double value) { return value != value; });
  if (values.empty()) return kUnknownValue;
  return upper_median_of(values);
}

}  // namespace adasplats
