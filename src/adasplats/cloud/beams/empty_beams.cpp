// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/beams/empty_beams.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
/// Points of a ring so near are returns of one beam: a tenth of the finest steps.
constexpr double kOneBeam_rad = 1e-4;
/// Bins of the field of view, one degree each: many steps of most sensors.
constexpr std::size_t kViewBins = 360;
/// Columns of a turn. Coarser and finer sensors that spin are not sold.
constexpr std::size_t kFewestColumns = 180;
constexpr std::size_t kMaxColumns = 16'384;
/// Steps around a firing within which a point is its return.
constexpr double kReturnSteps = 0.75;

using FieldOfView = std::array<bool, kViewBins>;

struct AzimuthPoint {
  double azimuth_rad;  ///< 0 to a turn
  std::uint32_t point;
};

double wrapped_rad(double azimuth_rad) {
  const bool is_wrapped = std::fabs(azimuth_rad) < kTurn_rad;
  const double turned = is_wrapped ? azimuth_rad : std::fmod(azimuth_rad, kTurn_rad);
  return turned < 0 ? turned + kTurn_rad : turned;
}

std::size_t view_bin(double azimuth_rad) {
  return static_cast<std::size_t>(azimuth_rad / kTurn_rad * kViewBins) % kViewBins;
}

/// One scan, by rings and azimuths.
struct SweptRings {
  std::vector<std::vector<AzimuthPoint>> points;  ///< by ring, ascending
  std::vector<double> elevations_rad;             ///< NaN: not known
  std::size_t columns = 0;                        ///< of a turn; 0: unknown
  std::vector<double> phases;                     ///< steps from azimuth 0 to the ring's firings
};

/// Columns of a turn by the median gap; 0 where gaps are not regular.
std::size_t columns_of(const std::vector<std::vector<AzimuthPoint>>& rings,
                       const EmptyBeamOptions& options) {
  std::vector<double> gaps_rad;
  for (const auto& ring : rings) {
    for (std::size_t k = 1; k < ring.size(); ++k) {
      const double gap_rad = ring[k].azimuth_rad - ring[k - 1].azimuth_rad;
      if (gap_rad > kOneBeam_rad) gaps_rad.push_back(gap_rad);
    }
  }
  if (gaps_rad.empty()) return 0;
  const double step_rad = upper_median_of(gaps_rad);
  const auto regular = std::ranges::count_if(gaps_rad, [&](double gap_rad) {
    return gap_rad > 0.7 * step_rad && gap_rad < 1.4 * step_rad;
  });
  if (static_cast<double>(regular) < options.min_regular * static_cast<double>(gaps_rad.size()))
    return 0;
  const auto columns = static_cast<std::size_t>(std::lround(kTurn_rad / step_rad));
  return columns < kFewestColumns || columns > kMaxColumns ? 0 : columns;
}

/// Mean phase of a ring's azimuths among the columns.
double phase_of(const std::vector<AzimuthPoint>& ring, std::size_t columns) {
  std::complex<double> sum = 0;
  for (const AzimuthPoint& p : ring)
    sum += std::polar(1.0, p.azimuth_rad * static_cast<double>(columns));
  return std::arg(sum) / kTurn_rad;
}

/// Of the rings in one scan; NaN: not known.
std::vector<double> elevations_of(const ScanRings& scan, const RecordingRings& recording,
                                  const EmptyBeamOptions& options) {
  std::vector<double> elevations_rad = recording.elevations_rad;
  for (std::size_t ring = 0; ring < elevations_rad.size(); ++ring)
    if (scan.sums[ring].points >= std::max<std::size_t>(1, options.min_ring_points))
      elevations_rad[ring] = scan.sums[ring].mean_rad();
  return elevations_rad;
}

/// Whether any beam of a ring can be as steep in the world as an empty beam must be; false for a
/// ring without elevation. It spares the test of single beams in most rings of most sensors, and
/// in all rings of KITTI on level roads.
bool may_be_empty(double elevation_rad, const Mat3d& world_from_sensor,
                  const EmptyBeamOptions& options) {
  constexpr double kRounding = 1e-9;
  const Vec3d up = world_from_sensor.rows[2];
  const double max_up =
      std::cos(elevation_rad) * std::hypot(up.x, up.y) + std::sin(elevation_rad) * up.z;
  return max_up > options.min_up - kRounding;
}

bool may_have_empty(std::span<const double> elevations_rad, const ScanRings& scan,
                    const EmptyBeamOptions& options) {
  return std::ranges::any_of(elevations_rad, [&](double elevation_rad) {
    return may_be_empty(elevation_rad, scan.world_from_sensor, options);
  });
}

/// Ascending. Azimuths of a ring are spread evenly, so that as many equal steps of a turn as points
/// have about one each.
void sort_by_azimuth(std::vector<AzimuthPoint>& points) {
  const auto step_of = [&](const AzimuthPoint& p) {
    const auto step =
        static_cast<std::size_t>(p.azimuth_rad / kTurn_rad * static_cast<double>(points.size()));
    return std::min(step, points.size() - 1);
  };
  std::vector<std::uint32_t> ends(points.size() + 1);
  for (const AzimuthPoint& p : points) ++ends[step_of(p) + 1];
  for (std::size_t step = 1; step < ends.size(); ++step) ends[step] += ends[step - 1];
  std::vector<AzimuthPoint> sorted(points.size());
  for (const AzimuthPoint& p : points) sorted[ends[step_of(p)]++] = p;
  points = std::move(sorted);
  const auto is_before = [](const AzimuthPoint& a, const AzimuthPoint& b) {
    return a.azimuth_rad != b.azimuth_rad ? a.azimuth_rad < b.azimuth_rad : a.point < b.point;
  };
  // The end of a step is now where the next one began.
  for (std::size_t step = 0, begin = 0; begin < points.size(); begin = ends[step++])
    std::sort(points.begin() + static_cast<std::ptrdiff_t>(begin),
              points.begin() + static_cast<std::ptrdiff_t>(ends[step]), is_before);
}

SweptRings sweep_of(const PointCloud& cloud, const ScanRings& scan,
                    std::vector<double> elevations_rad, const EmptyBeamOptions& options) {
  SweptRings sweep;
  sweep.points.resize(elevations_rad.size());
  for (std::size_t ring = 0; ring < sweep.points.size(); ++ring)
    sweep.points[ring].reserve(scan.sums[ring].points);
  const Mat3d sensor_from_world = scan.world_from_sensor.transposed();
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const std::size_t ring = scan.rings[k];
    if (ring >= elevations_rad.size()) continue;
    const Vec3d d = sensor_from_world * beam_direction(cloud, scan.points[k]);
    sweep.points[ring].push_back({wrapped_rad(std::atan2(d.y, d.x)), scan.points[k]});
  }
  for (auto& points : sweep.points) sort_by_azimuth(points);
  sweep.elevations_rad = std::move(elevations_rad);
  sweep.columns = columns_of(sweep.points, options);
  if (sweep.columns == 0) return sweep;
  for (const auto& ring : sweep.points) sweep.phases.push_back(phase_of(ring, sweep.columns));
  return sweep;
}

/// The cells (ring, column) of a scan and what is known of them.
class BeamImage {
 public:
  BeamImage(const SweptRings& sweep, const Mat3d& world_from_sensor)
      : sweep_(sweep),
        world_from_sensor_(world_from_sensor),
        columns_(sweep.columns),
        returned_(rings() * columns_),
        any_(columns_) {
    for (const double elevation_rad : sweep.elevations_rad)
      slopes_.push_back({std::cos(elevation_rad), std::sin(elevation_rad)});
    for (std::size_t ring = 0; ring < rings(); ++ring)
      for (const AzimuthPoint& p : sweep.points[ring]) add_return(ring, p.azimuth_rad);
  }

  std::size_t rings() const { return sweep_.points.size(); }
  std::size_t columns() const { return columns_; }
  std::size_t size() const { return returned_.size(); }
  std::size_t ring_of(std::size_t cell) const { return cell / columns_; }
  bool returned(std::size_t cell) const { return returned_[cell] != 0; }
  bool any_in(std::size_t column) const { return any_[column] != 0; }
  bool is_known(std::size_t ring) const {
    return sweep_.elevations_rad[ring] == sweep_.elevations_rad[ring];
  }
  double azimuth_rad(std::size_t cell) const {
    const double steps = static_cast<double>(cell % columns_) + sweep_.phases[ring_of(cell)];
    return wrapped_rad(steps * kTurn_rad / static_cast<double>(columns_));
  }
  Vec3d direction(std::size_t cell) const {
    const double azimuth = azimuth_rad(cell);
    const auto [flat, up] = slopes_[ring_of(cell)];
    return world_from_sensor_ * Vec3d{flat * std::cos(azimuth), flat * std::sin(azimuth), up};
  }
  /// may_be_empty()
  bool may_be_empty(std::size_t ring, const EmptyBeamOptions& options) const {
    return adasplats::may_be_empty(sweep_.elevations_rad[ring], world_from_sensor_, options);
  }

 private:
  void add_return(std::size_t ring, double azimuth_rad) {
    const double steps =
        azimuth_rad / kTurn_rad * static_cast<double>(columns_) - sweep_.phases[ring];
    const double nearest = std::round(steps);
    const auto column = static_cast<std::int64_t>(nearest);
    mark(ring, column);
    if (steps - nearest > 1 - kReturnSteps) mark(ring, column + 1);
    if (nearest - steps > 1 - kReturnSteps) mark(ring, column - 1);
  }
  void mark(std::size_t ring, std::int64_t column) {
    const auto columns = static_cast<std::int64_t>(columns_);
    const auto at = static_cast<std::size_t>((column + columns) % columns);
    returned_[ring * columns_ + at] = 1;
    any_[at] = 1;
  }

  struct Slope {
    double flat, up;  ///< cosine and sine of the elevation
  };

  const SweptRings& sweep_;
  Mat3d world_from_sensor_;
  std::size_t columns_;
  std::vector<Slope> slopes_;  ///< by ring
  std::vector<std::uint8_t> returned_, any_;
};

/// Whether the beams of a column without returns were fired: all go upwards, where nothing need be,
/// and the field of view holds it.
bool was_measured(const BeamImage& image, std::size_t column, const FieldOfView& view) {
  if (image.any_in(column)) return true;
  for (std::size_t ring = 0; ring < image.rings(); ++ring) {
    if (!image.is_known(ring)) continue;
    const std::size_t cell = ring * image.columns() + column;
    if (image.direction(cell).z <= 0 || !view[view_bin(image.azimuth_rad(cell))]) return false;
  }
  return true;
}

/// The cells of beams that went upwards and returned nothing, 1 or 0.
std::vector<std::uint8_t> empty_cells(const BeamImage& image, const FieldOfView& view,
                                      const EmptyBeamOptions& options) {
  std::vector<std::size_t> rings;
  for (std::size_t ring = 0; ring < image.rings(); ++ring)
    if (image.may_be_empty(ring, options)) rings.push_back(ring);
  std::vector<std::uint8_t> empty(image.size());
  for (std::size_t column = 0; column < image.columns(); ++column) {
    if (!was_measured(image, column, view)) continue;
    for (const std::size_t ring : rings) {
      const std::size_t cell = ring * image.columns() + column;
      if (image.returned(cell)) continue;
      empty[cell] = image.direction(cell).z > options.min_up ? 1 : 0;
    }
  }
  return empty;
}

/// Visits the cell and those around it that the image has; columns wrap.
template <class Visit>
void for_block(std::size_t cell, std::size_t rings, std::size_t columns, Visit&& visit) {
  const std::size_t ring = cell / columns, column = cell % columns;
  for (std::size_t r = ring == 0 ? 0 : ring - 1; r <= std::min(ring + 1, rings - 1); ++r)
    for (std::size_t c = column + columns - 1; c <= column + columns + 1; ++c)
      visit(r * columns + c % columns);
}

/// Of the cells those in a connected region that holds three by three of them, ascending.
std::vector<std::size_t> regions_with_blocks(std::vector<std::uint8_t> cells, std::size_t rings,
                                             std::size_t columns) {
  if (columns == 0) return {};
  std::vector<std::size_t> open;
  for (std::size_t ring = 1; ring + 1 < rings; ++ring) {
    for (std::size_t cell = ring * columns; cell < (ring + 1) * columns; ++cell) {
      int filled = 0;
      for_block(cell, rings, columns, [&](std::size_t k) { filled += cells[k]; });
      if (filled == 9) open.push_back(cell);
    }
  }
  std::vector<std::uint8_t> reached(cells.size());
  for (const std::size_t cell : open) reached[cell] = 1;
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    for_block(cell, rings, columns, [&](std::size_t k) {
      if (cells[k] == 0 || reached[k] != 0) return;
      reached[k] = 1;
      open.push_back(k);
    });
  }
  std::vector<std::size_t> kept;
  for (std::size_t cell = 0; cell < reached.size(); ++cell)
    if (reached[cell] != 0) kept.push_back(cell);
  return kept;
}

/// Where the sensor was at an azimuth, from the points there: it moves as it turns.
class SweepOrigins {
 public:
  SweepOrigins(const PointCloud& cloud, const SweptRings& sweep, const EmptyBeamOptions& options)
      : cloud_(cloud), sweep_(sweep), options_(options) {
    const AzimuthPoint none{std::numeric_limits<double>::infinity(), 0};
    std::vector<AzimuthPoint> first(sweep.columns, none);
    for (const auto& ring : sweep.points) {
      for (const AzimuthPoint& p : ring) {
        const auto bin = static_cast<std::size_t>(p.azimuth_rad / kTurn_rad *
                                                  static_cast<double>(sweep.columns));
        AzimuthPoint& place = first[std::min(bin, sweep.columns - 1)];
        if (p.azimuth_rad < place.azimuth_rad) place = p;
      }
    }
    for (const AzimuthPoint& p : first)
      if (p.azimuth_rad < none.azimuth_rad) all_.push_back(p);
  }

  /// By the nearest point of the ring; of any ring where that one is far or the sensor moved much
  /// from one side to the other, as at the seam of a sweep. Nothing if both fail.
  std::optional<Vec3f> find(std::size_t ring, double azimuth_rad) const {
    const Nearest of_ring = nearest_in(sweep_.points[ring], azimuth_rad);
    if (of_ring.is_near && of_ring.moved_m < options_.max_moved_m) return of_ring.origin;
    const Nearest of_any = nearest_in(all_, azimuth_rad);
    if (of_any.is_near || of_any.moved_m < options_.max_moved_m) return of_any.origin;
    return std::nullopt;
  }

 private:
  struct Nearest {
    Vec3f origin;
    bool is_near = false;
    double moved_m = std::numeric_limits<double>::infinity();  ///< between the points on its sides
  };

  Nearest nearest_in(const std::vector<AzimuthPoint>& points, double azimuth_rad) const {
    if (points.empty()) return {};
    const auto above = std::ranges::lower_bound(
        points, azimuth_rad, {}, [](const AzimuthPoint& p) { return p.azimuth_rad; });
    const AzimuthPoint& next = above == points.end() ? points.front() : *above;
    const AzimuthPoint& last = above == points.begin() ? points.back() : *(above - 1);
    const double up_rad = wrapped_rad(next.azimuth_rad - azimuth_rad);
    const double down_rad = wrapped_rad(azimuth_rad - last.azimuth_rad);
    const Vec3f after = cloud_.sensor_positions[next.point];
    const Vec3f before = cloud_.sensor_positions[last.point];
    return {up_rad < down_rad ? after : before, std::min(up_rad, down_rad) <= options_.max_away_rad,
            static_cast<double>(length(after - before))};
  }

  const PointCloud& cloud_;
  const SweptRings& sweep_;
  const EmptyBeamOptions& options_;
  std::vector<AzimuthPoint> all_;
};

std::vector<EmptyBeam> beams_of_scan(const PointCloud& cloud, const ScanRings& scan,
                                     const SweptRings& sweep, const FieldOfView& view,
                                     const EmptyBeamOptions& options) {
  std::vector<EmptyBeam> beams;
  if (sweep.columns == 0) return beams;
  const BeamImage image(sweep, scan.world_from_sensor);
  const std::vector<std::size_t> cells =
      regions_with_blocks(empty_cells(image, view, options), image.rings(), image.columns());
  if (cells.empty()) return beams;
  const SweepOrigins origins(cloud, sweep, options);
  for (const std::size_t cell : cells) {
    const auto origin = origins.find(image.ring_of(cell), image.azimuth_rad(cell));
    if (!origin) continue;
    beams.push_back({*origin, vec_cast<float>(normalized(image.direction(cell))), scan.scan});
  }
  return beams;
}

// ---- lost beams ------------------------------------------------------------------------------

/// Number of the sector of a degree of a ring.
std::size_t sector_of(std::size_t ring, double azimuth_rad) {
  return ring * kViewBins + view_bin(azimuth_rad);
}

struct LostBeam {
  EmptyBeam beam;
  std::size_t sector;
};

/// The lost beams of one scan, and beams by sector.
struct LostOfScan {
  std::vector<LostBeam> beams;
  std::vector<std::uint32_t> returned, lost;
};

LostOfScan lost_of_scan(const PointCloud& cloud, const ScanRings& scan, const SweptRings& sweep,
                        const EmptyBeamOptions& options) {
  LostOfScan found;
  found.returned.resize(sweep.points.size() * kViewBins);
  found.lost.resize(found.returned.size());
  if (sweep.columns == 0) return found;
  const double step_rad = kTurn_rad / static_cast<double>(sweep.columns);
  const Mat3d sensor_from_world = scan.world_from_sensor.transposed();
  const auto up_of = [&](const AzimuthPoint& p) {
    return (sensor_from_world * beam_direction(cloud, p.point)).z;
  };
  for (std::size_t ring = 0; ring < sweep.points.size(); ++ring) {
    const std::vector<AzimuthPoint>& points = sweep.points[ring];
    if (points.size() < options.min_ring_points) continue;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const AzimuthPoint& last = points[k];
      const AzimuthPoint& next = points[(k + 1) % points.size()];
      ++found.returned[sector_of(ring, last.azimuth_rad)];
      const double gap_rad = wrapped_rad(next.azimuth_rad - last.azimuth_rad);
      const auto steps = static_cast<int>(std::round(gap_rad / step_rad));
      if (steps < 2 || gap_rad > 2 * options.max_away_rad) continue;
      const double up_last = up_of(last), up_next = up_of(next);
      const Vec3f from = cloud.sensor_positions[last.point];
      const Vec3f way = cloud.sensor_positions[next.point] - from;
      for (int j = 1; j < steps; ++j) {
        const double share = static_cast<double>(j) / steps;
        const double azimuth_rad = wrapped_rad(last.azimuth_rad + share * gap_rad);
        const double up = up_last + share * (up_next - up_last);
        const double flat = std::sqrt(std::max(1 - up * up, 0.0));
        const Vec3d direction = {flat * std::cos(azimuth_rad), flat * std::sin(azimuth_rad), up};
        const std::size_t sector = sector_of(ring, azimuth_rad);
        ++found.lost[sector];
        found.beams.push_back(
            {{from + static_cast<float>(share) * way,
              vec_cast<float>(normalized(scan.world_from_sensor * direction)), scan.scan, true},
             sector});
      }
    }
  }
  return found;
}

/// Whether the sensor was at places that are far enough apart to tell the vehicle from the scene.
bool has_moved(const PointCloud& cloud, std::span<const ScanRings> scans) {
  constexpr float kMinWay_m = 6;
  std::optional<Vec3f> first;
  for (const ScanRings& scan : scans) {
    if (scan.points.empty()) continue;
    const Vec3f place = cloud.sensor_positions[scan.points.front()];
    if (!first) first = place;
    if (length(place - *first) > kMinWay_m) return true;
  }
  return false;
}

/// Adds the lost beams of all scans except those in sectors that the vehicle blocks.
void add_lost(const PointCloud& cloud, std::span<const ScanRings> scans,
              const std::vector<LostOfScan>& of_scans, std::vector<EmptyBeam>& beams) {
  constexpr std::size_t kMinScans = 3;
  if (of_scans.empty()) return;
  std::vector<std::size_t> seen(of_scans.front().lost.size()), mostly_lost = seen;
  for (const LostOfScan& scan : of_scans) {
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::uint32_t returned = scan.returned[k], lost = scan.lost[k];
      seen[k] += returned + lost > 0 ? 1 : 0;
      mostly_lost[k] += lost > returned ? 1 : 0;
    }
  }
  const bool may_block = has_moved(cloud, scans);
  for (const LostOfScan& scan : of_scans)
    for (const LostBeam& lost : scan.beams) {
      const std::size_t k = lost.sector;
      const bool blocked = may_block && seen[k] >= kMinScans && 4 * mostly_lost[k] >= 3 * seen[k];
      if (!blocked) beams.push_back(lost.beam);
    }
}

/// Azimuths at which any scan has points. Most sensors see all around, as a few points of the first
/// scans say.
FieldOfView view_of(const PointCloud& cloud, std::span<const ScanRings> scans,
                    const Executor& executor) {
  std::vector<FieldOfView> views(scans.size());
  std::atomic<bool> is_full = false;
  executor.for_chunks(scans.size(), 1, [&](std::size_t s, std::size_t) {
    const Mat3d sensor_from_world = scans[s].world_from_sensor.transposed();
    std::size_t seen = 0;
    for (const std::uint32_t i : scans[s].points) {
      if (is_full.load(std::memory_order_relaxed)) return;
      const Vec3d d = sensor_from_world * beam_direction(cloud, i);
      bool& bin = views[s][view_bin(wrapped_rad(std::atan2(d.y, d.x)))];
      if (!bin && ++seen == kViewBins) is_full = true;
      bin = true;
    }
  });
  FieldOfView all{};
  if (is_full) all.fill(true);
  for (const FieldOfView& view : views)
    for (std::size_t bin = 0; bin < kViewBins; ++bin) all[bin] = all[bin] || view[bin];
  return all;
}

}  // namespace

std::vector<EmptyBeam> find_empty_beams(const PointCloud& cloud, const EmptyBeamOptions& options,
                                        const Executor& executor) {
  const RecordingRings recording = find_scan_rings(cloud, options.rings, executor);
  const std::span<const ScanRings> scans = recording.scans;
  std::vector<std::vector<double>> elevations_rad(scans.size());
  std::vector<std::size_t> looked_at;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    elevations_rad[s] = elevations_of(scans[s], recording, options);
    if (options.lost || may_have_empty(elevations_rad[s], scans[s], options))
      looked_at.push_back(s);
  }
  if (looked_at.empty()) return {};
  const FieldOfView view = view_of(cloud, scans, executor);
  std::vector<std::vector<EmptyBeam>> of_scans(looked_at.size());
  std::vector<LostOfScan> lost(options.lost ? looked_at.size() : 0);
  executor.for_chunks(looked_at.size(), 1, [&](std::size_t k, std::size_t) {
    const std::size_t s = looked_at[k];
    const SweptRings sweep = sweep_of(cloud, scans[s], std::move(elevations_rad[s]), options);
    of_scans[k] = beams_of_scan(cloud, scans[s], sweep, view, options);
    if (options.lost) lost[k] = lost_of_scan(cloud, scans[s], sweep, options);
  });
  std::vector<EmptyBeam> beams;
  for (const auto& part : of_scans) beams.insert(beams.end(), part.begin(), part.end());
  add_lost(cloud, scans, lost, beams);
  return beams;
}

}  // namespace adasplats
