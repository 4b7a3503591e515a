// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/common_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/calibrate/chain_system.h"
#include "adasplats/calibrate/robust_weight.h"

namespace adasplats {
namespace {

constexpr int kPoolingIterations = 5;
/// Distance from the median, in median distances, at which a window has a quarter of its weight.
/// 1.48 median distances are a standard deviation of a normal distribution, so this is three.
constexpr double kWidthOfPooling = 4.5;
constexpr double kMinWidthOfPooling = 1e-5;  // m and rad: windows do not agree better than this

struct Weighted {
  double value = 0, weight = 0;
};

double weighted_median(std::vector<Weighted> values) {
  std::ranges::sort(values, {}, &Weighted::value);
  double total = 0;
  for (const Weighted& each : values) total += each.weight;
  double sum = 0;
  for (const Weighted& each : values) {
    sum += each.weight;
    if (sum >= 0.5 * total) return each.value;
  }
  return 0;
}

double robust_mean(const std::vector<Weighted>& values) {
  double mean = weighted_median(values);
  std::vector<Weighted> apart;
  apart.reserve(values.size());
  for (const Weighted& each : values) apart.push_back({std::fabs(each.value - mean), each.weight});
  const double width =
      std::max(kMinWidthOfPooling, kWidthOfPooling * weighted_median(std::move(apart)));
  for (int iteration = 0; iteration < kPoolingIterations; ++iteration) {
    double sum = 0, total = 0;
    for (const Weighted& each : values) {
      const double weight = each.weight * robust_weight(each.value - mean, width);
      sum += weight * each.value;
      total += weight;
    }
    if (total > 0) mean = sum / total;
  }
  return mean;
}

/// Pools one list of offsets and removes its mean unless it is observed; returns the RMS difference
/// of the windows.
double pool_offsets(std::span<const WindowFinding> findings,
                    std::vector<double> LaserOffsets::*which, bool keeps_mean,
                    std::vector<double>& result) {
  double mean = 0;
  for (std::size_t laser = 0; laser < result.size(); ++laser) {
    std::vector<Weighted> values;
    for (const WindowFinding& finding : findings)
      if (const auto& offsets = finding.lasers.*which; laser < offsets.size())
        values.push_back({offsets[laser], finding.weight});
    result[laser] = robust_mean(values);
    mean += result[laser] / static_cast<double>(result.size());
  }
  double square = 0, count = 0;
  for (double& offset : result) offset -= keeps_mean ? 0 : mean;
  for (const WindowFinding& finding : findings)
    for (std::size_t laser = 0; laser < (finding.lasers.*which).size(); ++laser) {
      square += std::pow((finding.lasers.*which)[laser] - result[laser], 2);
      ++count;
    }
  return count > 0 ? std::sqrt(square / count) : 0;
}

void pool_lasers(std::span<const WindowFinding> findings, bool keeps_range_mean,
                 CommonErrors& common) {
  std::size_t lasers = 0;
  for (const WindowFinding& finding : findings) {
    lasers = std::max(lasers, finding.lasers.range_m.size());
    common.laser_windows += finding.lasers.empty() ? 0 : 1;
  }
  common.lasers.range_m.resize(lasers);
  common.lasers.elevation_rad.resize(lasers);
  common.range_disagreement_m =
      pool_offsets(findings, &LaserOffsets::range_m, keeps_range_mean, common.lasers.range_m);
  common.elevation_disagreement_rad =
      pool_offsets(findings, &LaserOffsets::elevation_rad, false, common.lasers.elevation_rad);
  common.lasers.azimuth_rad.resize(lasers);
  pool_offsets(findings, &LaserOffsets::azimuth_rad, false, common.lasers.azimuth_rad);
}

using MountColumn = ChainSystem::Column;

/// A rotation is measured by the displacement it causes at `range_m`.
MountColumn mount_column(Vec3d rotation, Vec3d shift_m, double range_m) {
  return {range_m * rotation.x,
          range_m * rotation.y,
          range_m * rotation.z,
          shift_m.x,
          shift_m.y,
          shift_m.z};
}

/// Information matrix of a window's estimate, zero along the directions that it does not observe.
ChainSystem::Block information_of(const MountEstimate& found, double range_m) {
  constexpr std::size_t kCount = ChainSystem::kUnknowns;
  ChainSystem::Block seen{};  // projector onto the observed directions
  for (std::size_t k = 0; k < kCount; ++k) seen[k][k] = 1;
  for (const MountDirection& direction : found.not_observed) {
    const MountColumn axis = mount_column(direction.turning, direction.shifting, 1);
    for (std::size_t r = 0; r < kCount; ++r)
      for (std::size_t c = 0; c < kCount; ++c) seen[r][c] -= axis[r] * axis[c];
  }
  // The standard deviation of a nearly unobserved axis is close to 0, so it is bounded from below.
  constexpr double kMinShare = 0.1, kMinSd_m = 1e-4;
  const MountColumn sd = mount_column(found.rotation_sd_rad, found.shift_sd_m, range_m);
  const double min_m = std::max(kMinSd_m, kMinShare * *std::ranges::max_element(sd));
  ChainSystem::Block information{};
  for (std::size_t r = 0; r < kCount; ++r)
    for (std::size_t c = 0; c < kCount; ++c)
      for (std::size_t k = 0; k < kCount; ++k)
        information[r][c] += seen[r][k] * seen[k][c] / std::pow(std::max(min_m, sd[k]), 2);
  return information;
}

MountCorrection pooled_mount(std::span<const MountReport* const> reports, double range_m) {
  ChainSystem system(1);
  ChainSystem::Block whole{};
  MountColumn right{};
  for (const MountReport* report : reports) {
    const auto information = information_of(report->found, range_m);
    const MountColumn value =
        mount_column(report->found.mount.rotation_rad, report->found.mount.shift_m, range_m);
    for (std::size_t r = 0; r < value.size(); ++r)
      for (std::size_t c = 0; c < value.size(); ++c) {
        whole[r][c] += information[r][c];
        right[r] += information[r][c] * value[c];
      }
  }
  // A direction that no window observes stays as given: a weak prior keeps it at zero.
  double largest = 0;
  for (std::size_t k = 0; k < right.size(); ++k) largest = std::max(largest, whole[k][k]);
  for (std::size_t k = 0; k < right.size(); ++k) whole[k][k] += 1e-6 * largest;
  system.add(0, 0, whole);
  system.add(0, right);
  const std::vector<double> x = system.solve();
  return {(1 / range_m) * Vec3d{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

/// Directions that no window observes, compared by name.
std::vector<MountDirection> unobserved_directions(std::span<const MountReport* const> reports) {
  std::vector<MountDirection> result = reports.front()->found.not_observed;
  for (const MountReport* report : reports)
    std::erase_if(result, [&](const MountDirection& direction) {
      return std::ranges::find(report->found.not_observed, direction.name, &MountDirection::name) ==
             report->found.not_observed.end();
    });
  return result;
}

Vec3d smaller(Vec3d a, Vec3d b) { return min(a, b); }

/// Pools the reports of the windows that found a mount error.
MountReport pooled_report(std::span<const MountReport* const> reports, double range_m,
                          CommonErrors& common) {
  MountReport result;
  MountEstimate& found = result.found;
  found.mount = pooled_mount(reports, range_m);
  found.not_observed = unobserved_directions(reports);
  found.rotation_sd_rad = reports.front()->found.rotation_sd_rad;
  found.shift_sd_m = reports.front()->found.shift_sd_m;
  found.deviations = std::numeric_limits<double>::infinity();
  const double count = static_cast<double>(reports.size());
  for (const MountReport* report : reports) {
    const MountEstimate& own = report->found;
    found.planes += own.planes;
    found.deviations = std::min(found.deviations, own.deviations);
    found.rotation_sd_rad = smaller(found.rotation_sd_rad, own.rotation_sd_rad);
    found.shift_sd_m = smaller(found.shift_sd_m, own.shift_sd_m);
    result.given_m += report->given_m / count;
    result.mounted_m += report->mounted_m / count;
    common.mount_disagreement_rad = std::max(
        common.mount_disagreement_rad, length(own.mount.rotation_rad - found.mount.rotation_rad));
    common.mount_disagreement_m =
        std::max(common.mount_disagreement_m, length(own.mount.shift_m - found.mount.shift_m));
  }
  return result;
}

void pool_mount(std::span<const WindowFinding> findings, const MountOptions& options,
                CommonErrors& common) {
  std::vector<const MountReport*> with_planes, accepted;
  std::string objection;
  for (const WindowFinding& finding : findings) {
    if (!finding.mount) continue;
    const MountReport& report = *finding.mount;
    if (report.objection.empty()) accepted.push_back(&report);
    if (!report.objection.empty() && objection.empty()) objection = report.objection;
    if (report.found.planes >= options.min_planes) with_planes.push_back(&report);
  }
  if (findings.empty() || !findings.front().mount) return;
  if (accepted.empty() || 2 * accepted.size() <= with_planes.size()) {
    common.mount.emplace();
    common.mount->objection = accepted.empty() ? objection
                                               : "only " + std::to_string(accepted.size()) +
                                                     " of " + std::to_string(with_planes.size()) +
                                                     " windows find it wrong";
    return;
  }
  common.mount_windows = accepted.size();
  common.mount = pooled_report(accepted, options.range_m, common);
}

}  // namespace

CommonErrors pooled(std::span<const WindowFinding> findings, const MountOptions& options,
                    bool keeps_range_mean) {
  CommonErrors common;
  pool_lasers(findings, keeps_range_mean, common);
  pool_mount(findings, options, common);
  return common;
}

}  // namespace adasplats
