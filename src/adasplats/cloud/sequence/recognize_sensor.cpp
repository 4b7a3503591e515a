// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/recognize_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/small_cholesky.h"
#include "adasplats/core/maths/small_motion.h"

namespace adasplats {
namespace {

constexpr double kNearest_m = 3;    // nearer points are the vehicle's own, and a mount is 2 m away
constexpr double kFarthest_m = 80;  // farther ones are few and spread over more than one cone
constexpr std::size_t kFewestPoints = 500;
constexpr double kCap_rad = 0.5 * kDegree;  // of one point's residual: an outlier tells no more

// The mounts that are searched; a fit may leave them by half as much again.
constexpr double kMostAside_m = 2;
constexpr double kLowest_m = -0.5;
constexpr double kHighest_m = 2.5;
constexpr double kMostTilt_rad = 1.25 * kDegree;

// Points of the stages: 16 sectors of 25 for the grid; then enough that a laser of 128 has six,
// twenty and a hundred.
constexpr std::size_t kSectors = 64;
constexpr std::size_t kPointsPerSector = 8;
constexpr std::size_t kStartPoints = 800;
constexpr std::size_t kBetterPoints = 3000;
constexpr std::size_t kFinalPoints = 20000;
constexpr double kMostNodes = 3e8;  // of one table's grid: a third of a second
constexpr std::size_t kStartsPerLevel = 4;
constexpr std::size_t kStarts = 48;
constexpr int kFiner = 40;  // steps of 5 %
constexpr int kStartSteps = 12;
constexpr std::size_t kBetterStarts = 6;

/// Where a point lies among the cones.
struct Place {
  std::size_t laser;
  double residual_rad;  ///< positive: above the cone
  double gap_rad;       ///< to the next laser on that side
  bool outside;         ///< beyond the outermost cones by more than half their gap
};

/// Cones with the gaps between them.
class Table {
 public:
  explicit Table(const SensorCones& cones) : cones_(&cones) {
    const std::size_t count = cones.cones.size();
    for (std::size_t i = 0; i + 1 < count; ++i)
      gaps_rad_.push_back(cones.cones[i].elevation_rad - cones.cones[i + 1].elevation_rad);
    double sum_m = 0;
    for (const SensorCones::Cone& cone : cones.cones) sum_m += cone.height_m;
    mean_height_m_ = sum_m / static_cast<double>(count);
  }

  std::size_t size() const { return cones_->cones.size(); }
  const SensorCones& cones() const { return *cones_; }
  double mean_height_m() const { return mean_height_m_; }
  double gap_above(std::size_t laser) const { return gaps_rad_[laser == 0 ? 0 : laser - 1]; }
  double gap_below(std::size_t laser) const {
    return gaps_rad_[std::min(laser, gaps_rad_.size() - 1)];
  }

  Place place_of(Vec3d point) const {
    const auto [laser, residual_rad] = cones_->nearest(point);
    const bool above = residual_rad > 0;
    const double gap_rad = above ? gap_above(laser) : gap_below(laser);
    const bool outer = above ? laser == 0 : laser + 1U == size();
    return {laser, residual_rad, gap_rad, outer && std::abs(residual_rad) > 0.5 * gap_rad};
  }

 private:
  const SensorCones* cones_;
  std::vector<double> gaps_rad_;
  double mean_height_m_ = 0;
};

/// Mean of min(|x|, cap) for x uniform within half a gap.
double chance_of(double gap_rad) {
  const double half = 0.5 * gap_rad;
  return half <= kCap_rad ? 0.5 * half : kCap_rad - 0.5 * kCap_rad * kCap_rad / half;
}

/// One of each of `count` equal parts of the points, at random: a stride could meet the same laser
/// again and again where points come in the order of firing.
std::vector<Vec3d> sample_of(std::span<const Vec3d> points, std::size_t count) {
  if (points.size() <= count) return {points.begin(), points.end()};
  std::vector<Vec3d> sample(count);
  const double part = static_cast<double>(points.size()) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(0, 0, i);
    const auto at = static_cast<std::size_t>((static_cast<double>(i) + random.uniform()) * part);
    sample[i] = points[std::min(at, points.size() - 1)];
  }
  return sample;
}

std::vector<Vec3d> usable(std::span<const Vec3d> points) {
  std::vector<Vec3d> kept;
  for (const Vec3d& point : points) {
    const double range_m = length(point);
    if (is_finite(point) && range_m > kNearest_m && range_m < kFarthest_m) kept.push_back(point);
  }
  return kept;
}

/// How well points lie on the cones of a table seen from a mount.
struct Score {
  double residual_rad = 0;
  double chance_rad = 0;
  double share = 0;
  double outside = 0;  ///< share of points beyond the table
  double largest = 0;  ///< share of the laser with most points
  double empty = 0;    ///< share of lasers without points among those that span the points
  double lasers = 0;   ///< share of lasers with points

  double ratio() const { return chance_rad > 0 ? residual_rad / chance_rad : 1; }
};

/// Lasers whose neighbours have points and they have not.
void count_lasers(const std::vector<std::size_t>& counts, std::size_t points, Score& score) {
  const auto has = [](std::size_t count) { return count > 0; };
  const auto first = std::find_if(counts.begin(), counts.end(), has) - counts.begin();
  const auto last = counts.rend() - std::find_if(counts.rbegin(), counts.rend(), has);
  std::size_t filled = 0, empty = 0;
  for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
    const std::size_t above = i == 0 ? 0 : counts[i - 1];
    const std::size_t below = i + 1 == counts.size() ? 0 : counts[i + 1];
    filled += counts[i] > 0 ? 1 : 0;
    // A tenth of its neighbours: what noise brings over from them.
    empty += 20 * counts[i] <= above + below ? 1 : 0;
  }
  const auto total = static_cast<double>(counts.size());
  score.empty = static_cast<double>(empty) / std::max(1.0, static_cast<double>(last - first));
  score.lasers = static_cast<double>(filled) / total;
  score.largest = static_cast<double>(*std::max_element(counts.begin(), counts.end())) /
                  static_cast<double>(points);
}

Score score_of(std::span<const Vec3d> points, const Table& table, const RigidTransform& mount) {
  const RigidTransform sensor_from_vehicle = mount.inverse();
  std::vector<std::size_t> counts(table.size());
  Score score;
  for (const Vec3d& point : points) {
    const Place place = table.place_of(sensor_from_vehicle * point);
    const double residual_rad = std::abs(place.residual_rad);
    score.residual_rad += place.outside ? kCap_rad : std::min(residual_rad, kCap_rad);
    score.chance_rad += chance_of(place.gap_rad);
    score.share += residual_rad < 0.125 * place.gap_rad ? 1 : 0;
    score.outside += place.outside ? 1 : 0;
    if (!place.outside) ++counts[place.laser];
  }
  const auto count = static_cast<double>(points.size());
  score.residual_rad /= count;
  score.chance_rad /= count;
  score.share /= count;
  score.outside /= count;
  count_lasers(counts, points.size(), score);
  return score;
}

RigidTransform mount_of(Vec3d origin, double roll_rad, double pitch_rad) {
  return {rotation_from_yaw_pitch_roll(0, pitch_rad, roll_rad), origin};
}

/// The same axis without the turn about it.
RigidTransform without_yaw(const RigidTransform& mount) {
  const Mat3d axes = mount.rotation.transposed();
  const Vec3d up = axes.rows[2];
  return mount_of(mount.translation, std::asin(std::clamp(-up.y, -1.0, 1.0)),
                  std::atan2(up.x, up.z));
}

/// How far a mount may be off.
struct Doubt {
  double tilt_rad;
  double height_m;
  double aside_m;  ///< in the plane

  /// Of the elevation of a point in the sensor's frame.
  double at(Vec3d p) const {
    const double range_m = length(p);
    const double slope = std::abs(p.z) * std::hypot(p.x, p.y) / (range_m * range_m);
    const double height_rad = height_m / range_m, aside_rad = slope * aside_m / range_m;
    return std::sqrt(tilt_rad * tilt_rad + height_rad * height_rad + aside_rad * aside_rad);
  }
  friend Doubt operator*(double scale, Doubt d) {
    return {scale * d.tilt_rad, scale * d.height_m, scale * d.aside_m};
  }
};

using Unknowns = std::array<double, 5>;  // x, y, z, roll, pitch; yaw does not show

/// How the elevation of `point` (sensor frame) over a cone's tip changes with the mount.
Unknowns slope_of(Vec3d point, double tip_m, const Mat3d& rotation) {
  const Vec3d p = {point.x, point.y, point.z - tip_m};
  const double flat_m = std::max(std::hypot(p.x, p.y), 1e-6);
  const double square = flat_m * flat_m + p.z * p.z;
  const Vec3d up = {-p.z * p.x / (flat_m * square), -p.z * p.y / (flat_m * square),
                    flat_m / square};
  const Vec3d shift = -(rotation * up);
  const Vec3d turn = -cross(point, up);
  return {shift.x, shift.y, shift.z, turn.x, turn.y};
}

/// One step of Gauss-Newton, robust by the weight of Geman and McClure: only points whose laser
/// `doubt` does not confuse with the next take part, so sparse lasers and far points lead. False:
/// too few.
bool step(std::span<const Vec3d> points, const Table& table, Doubt doubt, RigidTransform& mount) {
  const RigidTransform sensor_from_vehicle = mount.inverse();
  std::array<double, 25> normal{};
  Unknowns right{};
  std::size_t used = 0;
  for (const Vec3d& point : points) {
    const Vec3d p = sensor_from_vehicle * point;
    const Place place = table.place_of(p);
    const double width_rad = doubt.at(p);
    if (place.outside || place.gap_rad < 2.5 * width_rad) continue;
    const double tip_m = table.cones().cones[place.laser].height_m;
    const Unknowns slope = slope_of(p, tip_m, mount.rotation);
    const double q = place.residual_rad * place.residual_rad / (width_rad * width_rad);
    const double weight = 1 / ((1 + q) * (1 + q) * width_rad * width_rad);
    for (std::size_t r = 0; r < 5; ++r) {
      for (std::size_t c = 0; c <= r; ++c) normal[r * 5 + c] += weight * slope[r] * slope[c];
      right[r] -= weight * slope[r] * place.residual_rad;
    }
    ++used;
  }
  if (used < 30) return false;
  // A weak prior: a step of the doubt costs as much as one point in a hundred that is off by it.
  const double prior = 0.01 * static_cast<double>(used);
  for (std::size_t r = 0; r < 5; ++r) {
    const double doubtful = r < 2 ? doubt.aside_m : r == 2 ? doubt.height_m : doubt.tilt_rad;
    normal[r * 6] += prior / (doubtful * doubtful);
  }
  factor<5>(normal);
  const Unknowns change = solved<5>(normal, right);
  mount.translation = mount.translation + Vec3d{change[0], change[1], change[2]};
  mount.rotation = mount.rotation * rotation_by({change[3], change[4], 0});
  return true;
}

/// Steps while the doubt falls to what the angles of sensors and poses leave.
RigidTransform refined(std::span<const Vec3d> points, const Table& table, Doubt doubt, int steps,
                       RigidTransform mount) {
  constexpr Doubt kLast = {0.05 * kDegree, 0.005, 0.01};
  const double share = 1.0 / std::max(steps - 1, 1);
  const auto fall = [&](double first, double last) {
    return std::pow(std::min(last / first, 1.0), share);
  };
  const Doubt falls = {fall(doubt.tilt_rad, kLast.tilt_rad), fall(doubt.height_m, kLast.height_m),
                       fall(doubt.aside_m, kLast.aside_m)};
  for (int i = 0; i < steps; ++i) {
    step(points, table, doubt, mount);
    doubt = {doubt.tilt_rad * falls.tilt_rad, doubt.height_m * falls.height_m,
             doubt.aside_m * falls.aside_m};
  }
  return without_yaw(mount);
}

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The points that guide the search, and how fine it has to be for them.
struct Guides {
  std::vector<Vec3d> points;
  Doubt doubt;  ///< that does not confuse their lasers
};

/// Of each sector the points that leave a mount most room: by how many mounts' errors one could
/// take its laser for the next, which goes with gap (two tilts), gap * range (height) and
/// gap * range / slope (two offsets in the plane).
Guides guides_of(std::span<const Vec3d> points, const Table& table) {
  const RigidTransform middle = mount_of({0, 0, 0.5 * (kLowest_m + kHighest_m)}, 0, 0);
  struct Guide {
    double room, gap_rad, height_m, aside_m;
    std::size_t index;
  };
  std::array<std::vector<Guide>, kSectors> sectors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d p = middle.inverse() * points[i];
    const Place place = table.place_of(p);
    const double range_m = length(p);
    // A point of the road at 20 m has a slope of 0.06: the least that the plane counts.
    const double slope = 0.05 + std::abs(p.z) * std::hypot(p.x, p.y) / (range_m * range_m);
    const double height_m = place.gap_rad * range_m, aside_m = height_m / slope;
    const double room = place.gap_rad * place.gap_rad * height_m * aside_m * aside_m;
    const double turn = (std::atan2(p.y, p.x) + std::numbers::pi) / (2 * std::numbers::pi);
    const auto sector = std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1);
    sectors[sector].push_back({room, place.gap_rad, height_m, aside_m, i});
  }
  Guides guides;
  std::vector<double> gaps_rad, heights_m, asides_m;
  for (std::vector<Guide>& sector : sectors) {
    std::sort(sector.begin(), sector.end(), [](const Guide& a, const Guide& b) {
      return a.room != b.room ? a.room > b.room : a.index < b.index;
    });
    sector.resize(std::min(sector.size(), kPointsPerSector));
    for (const Guide& guide : sector) {
      guides.points.push_back(points[guide.index]);
      gaps_rad.push_back(guide.gap_rad);
      heights_m.push_back(guide.height_m);
      asides_m.push_back(guide.aside_m);
    }
  }
  guides.doubt.tilt_rad = middle_of(gaps_rad) / 4;
  guides.doubt.height_m = middle_of(heights_m) / 4;
  guides.doubt.aside_m = middle_of(asides_m) / 4;
  return guides;
}

constexpr double kBin_rad = 0.03 * kDegree;
constexpr std::size_t kChanges = 128;  // of an elevation, in bins, that tilts of the grid make
static_assert(kChanges * kBin_rad > 2 * 1.5 * kMostTilt_rad);  // sqrt(2): both tilts

std::size_t sector_of(Vec3d p) {
  const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi) + 0.5;
  return std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1);
}

double azimuth_of(std::size_t sector) {
  return ((static_cast<double>(sector) + 0.5) / kSectors - 0.5) * (2 * std::numbers::pi);
}

/// Log likelihood ratio of an elevation: within `doubt` of the table's cones against anywhere.
class Likelihood {
 public:
  Likelihood(const Table& table, Doubt doubt) : ratios_(kRows * kBins) {
    for (std::size_t row = 0; row < kRows; ++row) {
      const double range_m = 1 / ((static_cast<double>(row) + 0.5) * kPerMetre);
      for (std::size_t bin = 0; bin < kBins; ++bin) {
        const double elevation_rad =
            (static_cast<double>(bin) + 0.5) * kBin_rad - std::numbers::pi / 2;
        const Vec3d point = {range_m * std::cos(elevation_rad), 0,
                             range_m * std::sin(elevation_rad) + table.mean_height_m()};
        ratios_[row * kBins + bin] = ratio_of(table, point, doubt.at(point));
      }
    }
  }

  /// kChanges ratios about that of a point in the sensor's frame, by elevation.
  const float* around(Vec3d p) const {
    const double flat_m = std::hypot(p.x, p.y);
    const auto row = static_cast<std::size_t>(1 / (std::hypot(flat_m, p.z) * kPerMetre));
    const double level_rad = std::clamp(std::atan2(p.z, flat_m), -1.4, 1.4);
    const auto bin = static_cast<std::size_t>((level_rad + std::numbers::pi / 2) / kBin_rad);
    return &ratios_[std::min(row, kRows - 1) * kBins + bin - kChanges / 2];
  }

 private:
  static constexpr std::size_t kBins = 6000;
  static constexpr std::size_t kRows = 12;
  static constexpr double kPerMetre = 1 / (kNearest_m * kRows);  // inverse range of a row

  static float ratio_of(const Table& table, Vec3d point, double width_rad) {
    const auto [laser, residual_rad] = table.cones().nearest(point);
    const double above_rad = table.gap_above(laser), below_rad = table.gap_below(laser);
    double density = bell(residual_rad / width_rad);
    if (laser > 0) density += bell((residual_rad - above_rad) / width_rad);
    if (laser + 1U < table.size()) density += bell((residual_rad + below_rad) / width_rad);
    density *= 0.5 * (above_rad + below_rad) / (width_rad * std::sqrt(2 * std::numbers::pi));
    return static_cast<float>(std::log(0.1 + 0.9 * density));  // one in ten is an outlier
  }
  static double bell(double x) { return std::exp(-0.5 * x * x); }

  std::vector<float> ratios_;
};

struct Start {
  double value;
  RigidTransform mount;
};

/// Even steps from `first` on.
struct Steps {
  double first, step;
  std::size_t count;

  double at(std::size_t i) const { return first + step * static_cast<double>(i); }
};

/// At most `step` apart, both ends included.
Steps steps_over(double first, double last, double step) {
  const double count = std::ceil((last - first) / step);
  return {first, (last - first) / count, static_cast<std::size_t>(count) + 1};
}

struct Grid {
  Steps height_m, aside_m, tilt_rad;
};

double nodes_of(const Grid& grid) {
  const auto heights = static_cast<double>(grid.height_m.count);
  const auto asides = static_cast<double>(grid.aside_m.count);
  const auto tilts = static_cast<double>(grid.tilt_rad.count);
  return heights * asides * asides *
         (kSectors * tilts * tilts + 100.0 * kSectors * kPointsPerSector);
}

/// Steps of one and a half doubts: no mount is further than three quarters off in each unknown.
Grid grid_of(const Guides& guides) {
  return {steps_over(kLowest_m, kHighest_m, 1.5 * guides.doubt.height_m),
          steps_over(-kMostAside_m, kMostAside_m, 1.5 * guides.doubt.aside_m),
          steps_over(-kMostTilt_rad, kMostTilt_rad, 1.5 * guides.doubt.tilt_rad)};
}

/// The finer the more it tells, as fine as the time allows.
Guides with_affordable_doubt(Guides guides) {
  const double finer = 1 / 1.05;
  for (int i = 0; i < kFiner && nodes_of(grid_of(guides)) < kMostNodes; ++i) {
    guides.doubt = finer * guides.doubt;
  }
  while (nodes_of(grid_of(guides)) > kMostNodes) {
    guides.doubt = (1 / finer) * guides.doubt;
  }
  return guides;
}

/// Sorted, the best first; equal ones by their place, so that nothing depends on the order.
void keep_best(std::vector<Start>& starts, std::size_t count) {
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.value > b.value; });
  starts.resize(std::min(starts.size(), count));
}

/// Tilts of the grid at one place; the best of them. What points of one sector say of a change of
/// their elevation is added up first: a tilt is then one look at each sector.
Start best_tilt(const Guides& guides, const Likelihood& likelihood, double tips_m, Vec3d origin,
                const Steps& tilts) {
  std::vector<float> changes(kSectors * kChanges);
  for (const Vec3d& point : guides.points) {
    const Vec3d p = {point.x - origin.x, point.y - origin.y, point.z - origin.z - tips_m};
    const float* const row = likelihood.around(p);
    float* const sum = &changes[sector_of(p) * kChanges];
    for (std::size_t i = 0; i < kChanges; ++i) sum[i] += row[i];
  }
  std::vector<float> sums(tilts.count * tilts.count);
  const auto fixed = [](double change_rad) {
    return static_cast<std::int32_t>(std::floor(change_rad * (65536 / kBin_rad)));
  };
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    const double azimuth_rad = azimuth_of(sector);
    const double sine = std::sin(azimuth_rad), cosine = std::cos(azimuth_rad);
    const float* const middle = &changes[sector * kChanges + kChanges / 2];
    const std::int32_t step = fixed(tilts.step * cosine);
    for (std::size_t r = 0; r < tilts.count; ++r) {
      std::int32_t at = fixed(tilts.first * cosine - tilts.at(r) * sine);
      float* const sum = &sums[r * tilts.count];
      for (std::size_t c = 0; c < tilts.count; ++c, at += step) sum[c] += middle[at >> 16];
    }
  }
  const auto best = std::max_element(sums.begin(), sums.end());
  const auto i = static_cast<std::size_t>(best - sums.begin());
  return {*best, mount_of(origin, tilts.at(i / tilts.count), tilts.at(i % tilts.count))};
}

/// The best tilts of each place of one height, the best places only.
std::vector<Start> starts_at(const Guides& guides, const Likelihood& likelihood, double tips_m,
                             const Grid& grid, double height_m) {
  std::vector<Start> starts;
  for (std::size_t i = 0; i < grid.aside_m.count; ++i)
    for (std::size_t k = 0; k < grid.aside_m.count; ++k)
      starts.push_back(best_tilt(guides, likelihood, tips_m,
                                 {grid.aside_m.at(i), grid.aside_m.at(k), height_m},
                                 grid.tilt_rad));
  keep_best(starts, kStartsPerLevel);
  return starts;
}

std::vector<Start> starts_of(const Guides& guides, const Table& table, const Executor& executor) {
  const Likelihood likelihood(table, guides.doubt);
  const Grid grid = grid_of(guides);
  std::vector<std::vector<Start>> levels(grid.height_m.count);
  executor.for_chunks(levels.size(), 1, [&](std::size_t begin, std::size_t) {
    levels[begin] =
        starts_at(guides, likelihood, table.mean_height_m(), grid, grid.height_m.at(begin));
  });
  std::vector<Start> starts;
  for (const std::vector<Start>& level : levels)
    starts.insert(starts.end(), level.begin(), level.end());
  keep_best(starts, kStarts);
  return starts;
}

/// Refines all starts and keeps the best.
std::vector<Start> refined_starts(std::span<const Vec3d> points, const Table& table, Doubt doubt,
                                  int steps, std::vector<Start> starts, std::size_t kept,
                                  const Executor& executor) {
  executor.for_chunks(starts.size(), 1, [&](std::size_t begin, std::size_t) {
    Start& start = starts[begin];
    start.mount = refined(points, table, doubt, steps, start.mount);
    start.value = -score_of(points, table, start.mount).ratio();
  });
  keep_best(starts, kept);
  return starts;
}

struct Fit {
  RigidTransform mount;
  Score score;
};

Fit fit_of(std::span<const Vec3d> points, const Table& table, std::vector<Start> starts,
           const Executor& executor) {
  constexpr Doubt kFound = {0.1 * kDegree, 0.03, 0.06};
  const std::vector<Vec3d> better = sample_of(points, kBetterPoints);
  const std::vector<Vec3d> all = sample_of(points, kFinalPoints);
  starts = refined_starts(better, table, kFound, 12, std::move(starts), 1, executor);
  const RigidTransform mount = refined(all, table, kFound, 6, starts.front().mount);
  return {mount, score_of(all, table, mount)};
}

Fit searched_fit(std::span<const Vec3d> points, const Table& table, const Executor& executor) {
  const std::vector<Vec3d> all = sample_of(points, kFinalPoints);
  std::vector<Vec3d> few = sample_of(points, kStartPoints);
  const Guides guides = with_affordable_doubt(guides_of(all, table));
  std::vector<Start> starts = starts_of(guides, table, executor);
  few.insert(few.end(), guides.points.begin(), guides.points.end());
  starts = refined_starts(few, table, guides.doubt, kStartSteps, std::move(starts), kBetterStarts,
                          executor);
  return fit_of(points, table, std::move(starts), executor);
}

// Rules. By chance a ratio is 1 and a share 0.25. On pandaset-002 the right table has a ratio of
// 0.42, the next best 0.91.
constexpr double kMostRatio = 0.6, kLeastShare = 0.4;
constexpr double kMostOutside = 0.05, kMostEmpty = 0.1, kLeastLasers = 0.5;
constexpr double kClearer = 0.2;  // in ratio, than any other table

bool is_convincing(const Score& score) {
  return score.ratio() <= kMostRatio && score.share >= kLeastShare &&
         score.outside <= kMostOutside && score.empty <= kMostEmpty && score.lasers >= kLeastLasers;
}

/// The one fit that convinces, clearer than all others; nothing: none does.
const Fit* clear_fit(std::span<const Fit> fits) {
  const Fit* best = nullptr;
  for (const Fit& fit : fits)
    if (is_convincing(fit.score) && (!best || fit.score.ratio() < best->score.ratio())) best = &fit;
  for (const Fit& fit : fits)
    if (best && &fit != best && fit.score.ratio() < best->score.ratio() + kClearer &&
        fit.score.lasers >= kLeastLasers)
      return nullptr;
  return best;
}
}  // namespace

std::pair<std::uint16_t, double> SensorCones::nearest(Vec3d point) const {
  const double flat_m = std::hypot(point.x, point.y);
  const auto residual_of = [&](std::size_t i) {
    return std::atan2(point.z - cones[i].height_m, flat_m) - cones[i].elevation_rad;
  };
  // As seen from the middle cone's tip; the others' tips are near it, so the laser is near, too.
  const std::size_t middle = cones.size() / 2;
  const double seen_rad = residual_of(middle) + cones[middle].elevation_rad;
  const auto below = std::lower_bound(
      cones.begin(), cones.end(), seen_rad,
      [](const Cone& cone, double elevation_rad) { return cone.elevation_rad > elevation_rad; });
  std::size_t best = static_cast<std::size_t>(below - cones.begin());
  if (best == cones.size()) --best;
  double residual_rad = residual_of(best);
  for (const int way : {-1, 1}) {
    while (way < 0 ? best > 0 : best + 1 < cones.size()) {
      const std::size_t next = way < 0 ? best - 1 : best + 1;
      const double next_rad = residual_of(next);
      if (!(std::abs(next_rad) < std::abs(residual_rad))) break;
      best = next;
      residual_rad = next_rad;
    }
  }
  return {static_cast<std::uint16_t>(best), residual_rad};
}

double Recognition::confidence() const {
  return chance_rad > 0 ? std::clamp(1 - residual_rad / chance_rad, 0.0, 1.0) : 0.0;
}

SensorCones cones_of(const LidarModel& model) {
  SensorCones result;
  result.sensor = model.name;
  if (model.rosette) return result;
  LidarModel one;  // column is enough, unless beams skip columns
  const std::vector<Firing>* firings = &model.free_pattern;
  std::vector<Firing> column;
  if (model.free_pattern.empty()) {
    one = model;
    one.columns = 1;
    column = firings_of(one);
    firings = &column;
  }
  std::vector<std::optional<SensorCones::Cone>> rings(model.rings());
  for (const Firing& firing : *firings) {
    const Vec3d way = vec_cast<double>(firing.direction), from = vec_cast<double>(firing.origin);
    const double flat = std::hypot(way.x, way.y);
    const double elevation_rad = std::atan2(way.z, flat);
    const double outward_m = (way.x * from.x + way.y * from.y) / flat;
    const SensorCones::Cone cone = {elevation_rad, from.z - outward_m * way.z / flat};
    std::optional<SensorCones::Cone>& ring = rings[firing.ring];
    if (!ring) ring = cone;
    if (std::abs(ring->elevation_rad - elevation_rad) > 1e-4) return result;
  }
  for (const auto& ring : rings)
    if (ring) result.cones.push_back(*ring);
  std::sort(result.cones.begin(), result.cones.end(),
            [](const auto& a, const auto& b) { return a.elevation_rad > b.elevation_rad; });
  return result;
}

std::vector<SensorCones> library_cones() {
  std::vector<SensorCones> result;
  for (const std::string& name : lidar_model_names()) {
    if (name.ends_with("-paper")) continue;  // no maker's: evenly spaced stand-ins
    SensorCones cones = cones_of(load_lidar_model(name));
    if (!cones.cones.empty()) result.push_back(std::move(cones));
  }
  return result;
}

std::optional<Recognition> recognize_sensor(std::span<const Vec3d> points,
                                            std::span<const SensorCones> candidates,
                                            const Executor& executor) {
  const std::vector<Vec3d> kept = usable(points);
  if (kept.size() < kFewestPoints) return std::nullopt;
  for (const bool searches : {false, true}) {
    std::vector<Fit> fits;
    for (const SensorCones& cones : candidates) {
      const Table table(cones);
      fits.push_back(searches ? searched_fit(kept, table, executor)
                              : fit_of(kept, table, {Start{0, {}}}, executor));
    }
    if (const Fit* const fit = clear_fit(fits))
      return Recognition{candidates[static_cast<std::size_t>(fit - fits.data())], fit->mount,
                         fit->score.residual_rad, fit->score.chance_rad, fit->score.share};
  }
  return std::nullopt;
}

}  // namespace adasplats
