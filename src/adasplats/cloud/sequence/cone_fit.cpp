// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/cone_fit.h"

#include <array>
#include <cstdint>
#include <numbers>
#include <utility>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"

namespace adasplats {

namespace {

constexpr double kCap_rad = 0.5 * kDegree;  // of one point's residual, against outliers

/// Mean of min(|x|, cap) for x uniform within half a gap.
double chance_of(double gap_rad) {
  const double half = 0.5 * gap_rad;
  return half <= kCap_rad ? 0.5 * half : kCap_rad - 0.5 * kCap_rad * kCap_rad / half;
}

void add_lasers(const std::vector<std::size_t>& counts, ConeScore& score) {
  const auto has = [](std::size_t count) { return count > 0; };
  const auto first =
      static_cast<std::size_t>(std::find_if(counts.begin(), counts.end(), has) - counts.begin());
  const auto end =
      static_cast<std::size_t>(counts.rend() - std::find_if(counts.rbegin(), counts.rend(), has));
  double points = 0, filled = 0, empty = 0;
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t above = i == 0 ? 0 : counts[i - 1];
    const std::size_t below = i + 1 == counts.size() ? 0 : counts[i + 1];
    points += static_cast<double>(counts[i]);
    filled += counts[i] > 0 ? 1 : 0;
    // At most a tenth of its neighbours' mean count: noise spreads as many from the neighbours.
    empty += 20 * counts[i] <= above + below ? 1 : 0;
  }
  if (first >= end) return;
  score.largest = static_cast<double>(*std::max_element(counts.begin(), counts.end())) / points;
  score.filled = filled / static_cast<double>(counts.size());
  score.empty = empty / static_cast<double>(end - first);
}

/// The same axis without the turn about it.
RigidTransform without_yaw(const RigidTransform& mount) {
  const Vec3d up = axis_of(mount);
  return mount_of(mount.translation, std::asin(std::clamp(-up.y, -1.0, 1.0)),
                  std::atan2(up.x, up.z));
}

using Unknowns = std::array<double, 5>;  // x, y, z, roll, pitch; yaw does not show

/// How the elevation of a point (sensor's frame) over a cone's tip changes with the mount.
Unknowns gradient_of(Vec3d point, double tip_m, const Mat3d& rotation) {
  const Vec3d p = {point.x, point.y, point.z - tip_m};
  const double flat_m = std::max(std::sqrt(p.x * p.x + p.y * p.y), 1e-6);
  const double square = flat_m * flat_m + p.z * p.z;
  const Vec3d up = {-p.z * p.x / (flat_m * square), -p.z * p.y / (flat_m * square),
                    flat_m / square};
  const Vec3d shift = -(rotation * up);
  const Vec3d turn = -cross(point, up);
  return {shift.x, shift.y, shift.z, turn.x, turn.y};
}

/// One step of Gauss-Newton with the weights of Geman and McClure. Only points take part whose
/// gaps are wide for what `doubt` makes of their elevation: sparse lasers and far points lead, the
/// others follow as the doubt falls.
void gauss_newton_step(std::span<const Vec3d> points, const ConeTable& table,
                       const MountDoubt& doubt, RigidTransform& mount) {
  constexpr double kWide = 2.5;  // 79 of 100 doubts are within half of such a gap
  const RigidTransform sensor_from_vehicle = mount.inverse();
  std::array<double, 25> normal{};
  Unknowns right{};
  double used = 0;
  for (const Vec3d& point : points) {
    const Vec3d p = sensor_from_vehicle * point;
    const ConePlace place = table.place_of(p);
    const double width_rad = angle_of(doubt, p);
    if (place.outside || place.gap_rad < kWide * width_rad) continue;
    const Unknowns gradient = gradient_of(p, table[place.laser].height_m, mount.rotation);
    const double widths = place.residual_rad / width_rad;
    const double falls = 1 / (1 + widths * widths);
    const double weight = falls * falls / (width_rad * width_rad);
    for (std::size_t r = 0; r < 5; ++r) {
      for (std::size_t c = 0; c <= r; ++c) normal[r * 5 + c] += weight * gradient[r] * gradient[c];
      right[r] -= weight * gradient[r] * place.residual_rad;
    }
    used += 1;
  }
  if (used < 30) return;
  // What the points do not show stays: a step as long as the doubt costs a hundredth of them.
  const Unknowns doubts = {doubt.aside_m, doubt.aside_m, doubt.height_m, doubt.tilt_rad,
                           doubt.tilt_rad};
  for (std::size_t r = 0; r < 5; ++r) normal[r * 6] += 0.01 * used / (doubts[r] * doubts[r]);
  factor<5>(normal);
  const Unknowns change = solved<5>(normal, right);
  mount.translation = mount.translation + Vec3d{change[0], change[1], change[2]};
  mount.rotation = mount.rotation * rotation_by({change[3], change[4], 0});
}

}  // namespace

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

ConeScore score_of(std::span<const Vec3d> points, const ConeTable& table,
                   const RigidTransform& mount) {
  const RigidTransform sensor_from_vehicle = mount.inverse();
  std::vector<std::size_t> counts(table.size());
  ConeScore score;
  const double one = 1 / static_cast<double>(points.size());
  for (const Vec3d& point : points) {
    const ConePlace place = table.place_of(sensor_from_vehicle * point);
    const double residual_rad = std::abs(place.residual_rad);
    score.residual_rad += one * (place.outside ? kCap_rad : std::min(residual_rad, kCap_rad));
    score.chance_rad += one * chance_of(place.gap_rad);
    score.share += residual_rad < 0.125 * place.gap_rad ? one : 0;
    score.outside += place.outside ? one : 0;
    if (!place.outside) ++counts[place.laser];
  }
  add_lasers(counts, score);
  return score;
}

RigidTransform mount_of(Vec3d origin, double roll_rad, double pitch_rad) {
  return {rotation_from_yaw_pitch_roll(0, pitch_rad, roll_rad), origin};
}

Vec3d axis_of(const RigidTransform& mount) { return mount.rotation.transposed().rows[2]; }

double slope_of(Vec3d p) { return std::abs(p.z) * std::sqrt(p.x * p.x + p.y * p.y) / dot(p, p); }

double angle_of(const MountDoubt& doubt, Vec3d p) {
  const double range_m = length(p);
  const double height_rad = doubt.height_m / range_m;
  const double aside_rad = slope_of(p) * doubt.aside_m / range_m;
  return std::sqrt(doubt.tilt_rad * doubt.tilt_rad + height_rad * height_rad +
                   aside_rad * aside_rad);
}

RigidTransform refined_mount(std::span<const Vec3d> points, const ConeTable& table,
                             MountDoubt doubt, int steps, RigidTransform mount) {
  constexpr MountDoubt kLast = {0.05 * kDegree, 0.005, 0.01};
  const auto fall = [&](double first, double last) {
    return std::pow(std::min(last / first, 1.0), 1.0 / (steps - 1));
  };
  const MountDoubt falls = {fall(doubt.tilt_rad, kLast.tilt_rad),
                            fall(doubt.height_m, kLast.height_m),
                            fall(doubt.aside_m, kLast.aside_m)};
  for (int i = 0; i < steps; ++i) {
    gauss_newton_step(points, table, doubt, mount);
    doubt = {doubt.tilt_rad * falls.tilt_rad, doubt.height_m * falls.height_m,
             doubt.aside_m * falls.aside_m};
  }
  return without_yaw(mount);
}

ConeFit fit_near(std::span<const Vec3d> points, const ConeTable& table,
                 const RigidTransform& mount) {
  const RigidTransform better =
      refined_mount(sample_of(points, kBetterPoints), table, kFound, 12, mount);
  const std::vector<Vec3d> all = sample_of(points, kFinalPoints);
  const RigidTransform best = refined_mount(all, table, kFound, 6, better);
  return {best, score_of(all, table, best)};
}

namespace {

// Of each of 64 sectors eight points for the grid; then enough that a laser of 128 has six.
constexpr std::size_t kSectors = 64;
constexpr std::size_t kPointsPerSector = 8;
constexpr std::size_t kStartPoints = 800;

// Of the mounts of the grid those that are refined, and of these those that are with more points.
constexpr std::size_t kStartsPerLevel = 4;
constexpr std::size_t kStarts = 48;
constexpr std::size_t kBetterStarts = 6;

std::size_t sector_of(Vec3d p) {
  const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi) + 0.5;
  return std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1);
}

double azimuth_of(std::size_t sector) {
  return ((static_cast<double>(sector) + 0.5) / kSectors - 0.5) * (2 * std::numbers::pi);
}

/// The points that lead the search, and the doubt that most of them allow.
struct Guides {
  std::vector<Vec3d> points;
  MountDoubt doubt;
};

/// Of each sector the points that leave a mount most room before they take one laser for the next:
/// the gap for two tilts, gap * range for the height, gap * range / slope for two shifts in the
/// plane. Far points and sparse lasers, that is.
Guides guides_of(std::span<const Vec3d> points, const ConeTable& table) {
  struct Guide {
    double room;
    MountDoubt gap;
    std::size_t point;
  };
  const Vec3d middle = {0, 0, 0.5 * (kLowest_m + kHighest_m)};
  std::array<std::vector<Guide>, kSectors> sectors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d p = points[i] - middle;
    const double gap_rad = table.place_of(p).gap_rad, height_m = gap_rad * length(p);
    // The middle is up to 1.5 m off, a slope at 30 m 0.05.
    const double aside_m = height_m / (0.05 + slope_of(p));
    const double room = gap_rad * gap_rad * height_m * aside_m * aside_m;
    sectors[sector_of(p)].push_back({room, {gap_rad, height_m, aside_m}, i});
  }
  Guides guides;
  std::vector<double> gaps_rad, heights_m, asides_m;
  for (std::vector<Guide>& sector : sectors) {
    std::sort(sector.begin(), sector.end(), [](const Guide& a, const Guide& b) {
      return a.room != b.room ? a.room > b.room : a.point < b.point;
    });
    sector.resize(std::min(sector.size(), kPointsPerSector));
    for (const Guide& guide : sector) {
      guides.points.push_back(points[guide.point]);
      gaps_rad.push_back(guide.gap.tilt_rad);
      heights_m.push_back(guide.gap.height_m);
      asides_m.push_back(guide.gap.aside_m);
    }
  }
  // A quarter of a gap is half the way to where the next laser is as near.
  guides.doubt = 0.25 * MountDoubt{upper_median_of(gaps_rad), upper_median_of(heights_m),
                                   upper_median_of(asides_m)};
  // Of cones that coincide, too, something is left.
  guides.doubt.tilt_rad = std::max(guides.doubt.tilt_rad, 0.01 * kDegree);
  guides.doubt.height_m = std::max(guides.doubt.height_m, 0.001);
  guides.doubt.aside_m = std::max(guides.doubt.aside_m, 0.01);
  return guides;
}

/// Even steps.
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

struct MountGrid {
  Steps height_m, aside_m, tilt_rad;
};

/// Steps of one and a half doubts: the next mount is within three quarters in each unknown.
MountGrid grid_of(const MountDoubt& doubt) {
  return {steps_over(kLowest_m, kHighest_m, 1.5 * doubt.height_m),
          steps_over(-kMaxAside_m, kMaxAside_m, 1.5 * doubt.aside_m),
          steps_over(-kMaxTilt_rad, kMaxTilt_rad, 1.5 * doubt.tilt_rad)};
}

/// What best_tilt() does for a grid, in additions; a point at a place costs about a hundred.
double cost_of(const MountGrid& grid) {
  const auto asides = static_cast<double>(grid.aside_m.count);
  const auto tilts = static_cast<double>(grid.tilt_rad.count);
  return static_cast<double>(grid.height_m.count) * asides * asides *
         static_cast<double>(kSectors) * (tilts * tilts + 100.0 * kPointsPerSector);
}

/// The finer the grid the clearer the best mount: as fine as a third of a second allows, to a
/// sixteenth of the gaps. Where it allows not even a quarter (dense tables, narrow places) the
/// search may fail.
MountDoubt affordable(MountDoubt doubt) {
  constexpr double kMaxCost = 3e8;
  constexpr double kFiner = 0.95;
  const double min_rad = doubt.tilt_rad / 4;
  while (cost_of(grid_of(doubt)) > kMaxCost) doubt = (1 / kFiner) * doubt;
  while (doubt.tilt_rad > min_rad && cost_of(grid_of(kFiner * doubt)) < kMaxCost)
    doubt = kFiner * doubt;
  return doubt;
}

constexpr double kBin_rad = 0.03 * kDegree;
constexpr std::size_t kChanges = 128;  // of an elevation, in bins, for all tilts of the grid
static_assert(kChanges * kBin_rad > 2 * std::numbers::sqrt2 * kMaxTilt_rad);

/// By range and elevation, the log of how much likelier an elevation is within `doubt` of the
/// table's cones than anywhere in the gaps.
class Likelihood {
 public:
  Likelihood(const ConeTable& table, const MountDoubt& doubt)
      : mean_height_m_(table.mean_height_m()), ratios_(kRows * kBins) {
    for (std::size_t row = 0; row < kRows; ++row) {
      const double range_m = 1 / ((static_cast<double>(row) + 0.5) * kPerMetre);
      for (std::size_t bin = 0; bin < kBins; ++bin) {
        const double level_rad =
            (static_cast<double>(bin) + 0.5) * kBin_rad - 0.5 * std::numbers::pi;
        const Vec3d p = {range_m * std::cos(level_rad), 0, range_m * std::sin(level_rad)};
        ratios_[row * kBins + bin] = ratio_of(table, doubt, p);
      }
    }
  }

  /// kChanges values around that of a point in the sensor's frame, by elevation. Its middle is the
  /// tips' mean, so that their spread alone needs the range.
  const float* around(Vec3d p) const {
    p.z -= mean_height_m_;
    const auto row = static_cast<std::size_t>(1 / (std::max(length(p), 0.1) * kPerMetre));
    const double flat_m = std::sqrt(p.x * p.x + p.y * p.y);
    const double level_rad = std::clamp(std::atan2(p.z, flat_m), -1.5, 1.5);
    const auto bin = static_cast<std::size_t>((level_rad + 0.5 * std::numbers::pi) / kBin_rad);
    return &ratios_[std::min(row, kRows - 1) * kBins + bin - kChanges / 2];
  }

 private:
  static constexpr std::size_t kBins = 6000;  // half a turn
  static constexpr std::size_t kRows = 12;
  static constexpr double kPerMetre = 1 / (kNearestOnCones_m * kRows);  // inverse range of a row

  float ratio_of(const ConeTable& table, const MountDoubt& doubt, Vec3d p) const {
    const double width_rad = angle_of(doubt, p);
    const auto bell = [&](double x_rad) {
      return std::exp(-0.5 * x_rad * x_rad / (width_rad * width_rad));
    };
    const auto [laser, residual_rad] = table.sensor().nearest({p.x, p.y, p.z + mean_height_m_});
    const double above_rad = table.gap_above(laser), below_rad = table.gap_below(laser);
    double density = bell(residual_rad);
    if (laser > 0) density += bell(residual_rad - above_rad);
    if (laser + 1U < table.size()) density += bell(residual_rad + below_rad);
    density *= 0.5 * (above_rad + below_rad) / (width_rad * std::sqrt(2 * std::numbers::pi));
    return static_cast<float>(std::log(0.1 + 0.9 * density));  // one in ten is an outlier
  }

  double mean_height_m_;
  std::vector<float> ratios_;
};

struct Start {
  double value;  ///< the larger the better
  RigidTransform mount;
};

/// Sorts, the best first; equal ones stay in their order.
void keep_best(std::vector<Start>& starts, std::size_t count) {
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.value > b.value; });
  starts.resize(std::min(starts.size(), count));
}

/// The best tilt at one place. What the points of a sector say of a change of their elevation is
/// added up first, so a tilt takes one look at each sector.
Start best_tilt(std::span<const Vec3d> guides, const Likelihood& likelihood, Vec3d origin,
                const Steps& tilts) {
  std::vector<float> changes(kSectors * kChanges);
  for (const Vec3d& guide : guides) {
    const Vec3d p = guide - origin;
    const float* const values = likelihood.around(p);
    float* const sum = &changes[sector_of(p) * kChanges];
    for (std::size_t i = 0; i < kChanges; ++i) sum[i] += values[i];
  }
  const auto fixed = [](double change_rad) {  // bins with 16 bits behind the point: even steps add
    return static_cast<std::int32_t>(std::floor(change_rad * (65536 / kBin_rad)));
  };
  std::vector<float> sums(tilts.count * tilts.count);
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    const double sine = std::sin(azimuth_of(sector)), cosine = std::cos(azimuth_of(sector));
    const float* const middle = &changes[sector * kChanges + kChanges / 2];
    const std::int32_t pitch = fixed(tilts.step * cosine);
    for (std::size_t r = 0; r < tilts.count; ++r) {
      // A roll lowers what is to the left, a pitch raises what is in front.
      std::int32_t change = fixed(tilts.first * cosine - tilts.at(r) * sine);
      float* const sum = &sums[r * tilts.count];
      for (std::size_t c = 0; c < tilts.count; ++c, change += pitch) sum[c] += middle[change >> 16];
    }
  }
  const auto best = std::max_element(sums.begin(), sums.end());
  const auto i = static_cast<std::size_t>(best - sums.begin());
  return {*best, mount_of(origin, tilts.at(i / tilts.count), tilts.at(i % tilts.count))};
}

/// The best mounts of the grid, from several heights: what is best at a wrong one comes in crowds.
std::vector<Start> starts_of(const Guides& guides, const ConeTable& table,
                             const Executor& executor) {
  const Likelihood likelihood(table, guides.doubt);
  const MountGrid grid = grid_of(guides.doubt);
  std::vector<std::vector<Start>> levels(grid.height_m.count);
  executor.for_chunks(levels.size(), 1, [&](std::size_t level, std::size_t) {
    const double height_m = grid.height_m.at(level);
    for (std::size_t x = 0; x < grid.aside_m.count; ++x) {
      for (std::size_t y = 0; y < grid.aside_m.count; ++y) {
        const Vec3d origin = {grid.aside_m.at(x), grid.aside_m.at(y), height_m};
        levels[level].push_back(best_tilt(guides.points, likelihood, origin, grid.tilt_rad));
      }
    }
    keep_best(levels[level], kStartsPerLevel);
  });
  std::vector<Start> starts;
  for (const std::vector<Start>& level : levels)
    starts.insert(starts.end(), level.begin(), level.end());
  keep_best(starts, kStarts);
  return starts;
}

std::vector<Start> refined_starts(std::span<const Vec3d> points, const ConeTable& table,
                                  const MountDoubt& doubt, std::vector<Start> starts,
                                  const Executor& executor) {
  constexpr int kSteps = 12;  // the doubt falls to 0.7 of itself or slower
  executor.for_chunks(starts.size(), 1, [&](std::size_t i, std::size_t) {
    starts[i].mount = refined_mount(points, table, doubt, kSteps, starts[i].mount);
    starts[i].value = -score_of(points, table, starts[i].mount).ratio();
  });
  return starts;
}

/// A fit whose tilt is off by one laser of a dense part of the table lies nearly as well (0.41 and
/// 0.39 of chance for PandaSet's): the best of those tilts, over all points.
ConeFit best_beside(const ConeFit& fit, std::span<const Vec3d> points, const ConeTable& table,
                    const Executor& executor) {
  constexpr MountDoubt kBeside = {0.1 * kDegree, 0.03, 0.15};  // places go along with tilts
  const std::vector<Vec3d> better = sample_of(points, kBetterPoints);
  std::vector<double> gaps_rad;
  gaps_rad.reserve(better.size());
  for (const Vec3d& point : better)
    gaps_rad.push_back(table.place_of(fit.mount.inverse() * point).gap_rad);
  const double gap_rad = upper_median_of(gaps_rad);
  std::vector<Start> starts;
  for (const double roll : {-gap_rad, 0.0, gap_rad})
    for (const double pitch : {-gap_rad, 0.0, gap_rad})
      starts.push_back(
          {0, {fit.mount.rotation * rotation_by({roll, pitch, 0}), fit.mount.translation}});
  starts = refined_starts(better, table, kBeside, std::move(starts), executor);
  keep_best(starts, 3);
  ConeFit best = fit;
  for (const Start& start : starts) {
    const ConeFit other = fit_near(points, table, start.mount);
    if (other.score.ratio() < best.score.ratio()) best = other;
  }
  return best;
}

}  // namespace

ConeFit searched_fit(std::span<const Vec3d> points, const ConeTable& table,
                     const Executor& executor) {
  constexpr double kPromising = 0.9;  // of chance; wrong tables rarely are
  Guides guides = guides_of(sample_of(points, kFinalPoints), table);
  guides.doubt = affordable(guides.doubt);
  std::vector<Start> starts = starts_of(guides, table, executor);
  std::vector<Vec3d> leading = sample_of(points, kStartPoints);
  leading.insert(leading.end(), guides.points.begin(), guides.points.end());
  starts = refined_starts(leading, table, guides.doubt, std::move(starts), executor);
  keep_best(starts, kBetterStarts);
  starts =
      refined_starts(sample_of(points, kBetterPoints), table, kFound, std::move(starts), executor);
  keep_best(starts, 1);
  const ConeFit fit = fit_near(points, table, starts.front().mount);
  return fit.score.ratio() < kPromising ? best_beside(fit, points, table, executor) : fit;
}

}  // namespace adasplats
