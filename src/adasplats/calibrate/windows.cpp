// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/windows.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "adasplats/calibrate/calibrate_rig.h"
#include "adasplats/calibrate/common_errors.h"
#include "adasplats/calibrate/window_gauges.h"
#include "adasplats/cloud/load/join_clouds.h"

namespace adasplats {
namespace {

/// Windows used to estimate lasers and mount, which are constant over a recording. The median of
/// eight outvotes three wrong ones; every further window would cost a second solve.
constexpr std::size_t kCommonWindows = 8;

/// Splits a drive into pieces of half a window: window k is pieces k and k + 1.
std::vector<ScanSpan> cut_pieces(std::size_t scans, std::size_t window_scans) {
  if (scans <= window_scans) return {{0, scans}};
  const std::size_t max_scans = window_scans / 2;
  const std::size_t count = (scans + max_scans - 1) / max_scans;
  std::vector<ScanSpan> pieces;
  for (std::size_t k = 0; k < count; ++k)
    pieces.push_back({scans * k / count, scans * (k + 1) / count});
  return pieces;
}

/// Keeps every n-th point, with the same n as calibrate(), and only the attributes that it needs.
PointCloud thinned(PointCloud cloud, std::size_t points_a_scan) {
  cloud.intensities = {};
  cloud.classes = {};
  cloud.instances = {};
  cloud.empty_beams = {};
  const std::size_t wanted = points_a_scan * std::max<std::size_t>(1, cloud.scan_poses.size());
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / wanted);
  if (stride == 1) return cloud;
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < cloud.size(); i += stride)
    kept.push_back(static_cast<std::uint32_t>(i));
  return gather(cloud, kept);
}

/// Gives both clouds the same attributes.
void match_attributes(PointCloud& a, PointCloud& b) {
  if (a.lasers.empty() != b.lasers.empty()) a.lasers = b.lasers = {};
  if (a.sensor_positions.empty() != b.sensor_positions.empty())
    a.sensor_positions = b.sensor_positions = {};
  if (a.origin_kinds.empty() == b.origin_kinds.empty()) return;
  PointCloud& lacking = a.origin_kinds.empty() ? a : b;
  lacking.origin_kinds.assign(lacking.size(), lacking.origin_kind(0));
}

/// Joins two neighbouring pieces into one cloud.
PointCloud joined_pieces(const PointCloud& first, PointCloud second) {
  PointCloud whole = first;
  const auto scans = static_cast<std::uint32_t>(first.scan_poses.size());
  for (std::uint32_t& scan : second.scan_indices) scan += scans;
  Trajectory poses = first.scan_poses;
  poses.insert(poses.end(), second.scan_poses.begin(), second.scan_poses.end());
  if (!whole.empty() && !second.empty()) {
    move_origin(second, whole.origin);
    match_attributes(whole, second);
  }
  append(whole, std::move(second));
  whole.scan_poses = std::move(poses);
  return whole;
}

/// Reads the windows of a drive in order; every piece is read once.
class WindowReader {
 public:
  WindowReader(const DriveSource& drive, std::size_t window_scans, std::size_t points_a_scan)
      : drive_(drive),
        points_a_scan_(points_a_scan),
        pieces_(cut_pieces(drive.scans, window_scans)) {}

  PointCloud read(std::size_t window) {
    if (pieces_.size() == 1) return piece(0);
    if (!last_ || number_ != window) last_ = piece(window);
    PointCloud second = piece(window + 1);
    PointCloud whole = joined_pieces(*last_, second);
    last_ = std::move(second);
    number_ = window + 1;
    return whole;
  }

 private:
  PointCloud piece(std::size_t k) const {
    PointCloud cloud = drive_.read(pieces_[k]);
    if (cloud.scan_poses.size() != pieces_[k].size())
      throw std::logic_error("calibrate_windows: the reader returned the wrong number of scans");
    return thinned(std::move(cloud), points_a_scan_);
  }

  const DriveSource& drive_;
  std::size_t points_a_scan_;
  std::vector<ScanSpan> pieces_;
  std::optional<PointCloud> last_;  ///< the piece read last...
  std::size_t number_ = 0;          ///< ...and its number
};

/// A calibration of lasers and mount only.
Calibration common_calibration(const CommonErrors& common, const Trajectory& given) {
  Calibration calibration;
  calibration.lasers = common.lasers;
  if (common.mount && common.mount->objection.empty())
    calibration.mount = common.mount->found.mount;
  for (const TimedPose& pose : given)
    calibration.poses.push_back({pose.time_s, pose.world_from_sensor.translation, {}, {}});
  return calibration;
}

/// Pose corrections after the mount correction, expressed about the given positions.
std::vector<PoseCorrection> about_given(std::vector<PoseCorrection> poses,
                                        const Trajectory& given) {
  for (std::size_t scan = 0; scan < poses.size(); ++scan) {
    const RigidTransform correction = poses[scan].corrected_from_given();
    const Vec3d position = given[scan].world_from_sensor.translation;
    poses[scan].position = position;
    poses[scan].shift_m = correction * position - position;
  }
  return poses;
}

void add_counts(ResidualCounts& sum, const ResidualCounts& more) {
  for (std::size_t bin = 0; bin < sum.counts.size(); ++bin) sum.counts[bin] += more.counts[bin];
}

/// Median, interpolated within its bin; in the last bin, the bin's lower end.
double median_m(const ResidualCounts& residuals) {
  const auto total = static_cast<double>(
      std::accumulate(residuals.counts.begin(), residuals.counts.end(), std::size_t{0}));
  double below = 0;
  for (std::size_t bin = 0; bin + 1 < residuals.counts.size(); ++bin) {
    const auto count = static_cast<double>(residuals.counts[bin]);
    if (count > 0 && below + count >= 0.5 * total)
      return ResidualCounts::kBin_m * (static_cast<double>(bin) + (0.5 * total - below) / count);
    below += count;
  }
  return total > 0 ? ResidualCounts::kBin_m * static_cast<double>(residuals.counts.size() - 1) : 0;
}

class WindowedCalibrator {
 public:
  WindowedCalibrator(std::span<const DriveSource> drives, const CalibrateOptions& options,
                     const CalibrateWindowOptions& windows, const CalibrateCloud& calibrate_cloud,
                     const Executor& executor, ProgressSink& progress)
      : drives_(drives),
        options_(options),
        max_scans_(windows.window_scans),
        calibrate_cloud_(calibrate_cloud),
        executor_(executor),
        progress_(progress) {
    report_.window_scans = max_scans_;
    for (std::size_t drive = 0; drive < drives.size(); ++drive)
      for (const ScanSpan& span : cut_windows(drives[drive].scans, max_scans_)) {
        WindowReport window;
        window.drive = drive;
        window.begin = span.begin;
        window.end = span.end;
        report_.windows.push_back(window);
      }
  }

  WindowedCalibration run() {
    find_common();
    WindowedCalibration result;
    result.calibration = common_calibration(common_, {});
    std::size_t number = 0;
    progress_.begin_step("calibrate windows", report_.windows.size());
    for (std::size_t drive = 0; drive < drives_.size(); ++drive) add_drive(drive, number, result);
    progress_.end_step();
    finish(result);
    return result;
  }

 private:
  bool wants_common() const {
    return options_.ranges || options_.elevations || options_.azimuths || options_.mount_correction;
  }

  /// Solves a few windows, spread over all, for everything, and pools their lasers and mounts.
  void find_common() {
    if (!wants_common()) return;
    const std::size_t all = report_.windows.size();
    const std::size_t count = std::min(all, kCommonWindows);
    std::vector<WindowFinding> findings;
    progress_.begin_step("calibrate lasers and mount", count);
    for (std::size_t k = 0; k < count; ++k) {
      WindowReport& window = report_.windows[(2 * k + 1) * all / (2 * count)];
      findings.push_back(finding_of(window));
      progress_.advance(k + 1);
    }
    progress_.end_step();
    const bool has_map = options_.free_scans != CalibrateOptions().free_scans;
    common_ = pooled(findings, options_.mount, has_map);
    report_.laser_windows = common_.laser_windows;
    report_.range_disagreement_m = common_.range_disagreement_m;
    report_.elevation_disagreement_rad = common_.elevation_disagreement_rad;
    report_.mount_windows = common_.mount_windows;
    report_.mount_disagreement_rad = common_.mount_disagreement_rad;
    report_.mount_disagreement_m = common_.mount_disagreement_m;
  }

  WindowFinding finding_of(WindowReport& window) const {
    const std::vector<ScanSpan> spans = cut_windows(drives_[window.drive].scans, max_scans_);
    const auto at = std::ranges::find(spans, window.begin, &ScanSpan::begin);
    WindowReader reader(drives_[window.drive], max_scans_, options_.points_a_scan);
    const PointCloud cloud = reader.read(static_cast<std::size_t>(at - spans.begin()));
    auto [calibration, report] = calibrate_cloud_(cloud, options_);
    WindowFinding finding;
    finding.mount = std::move(report.mount);
    if (!calibration.empty() && !(finding.mount && !finding.mount->alone_because.empty())) {
      finding.lasers = std::move(calibration.lasers);
      finding.weight = static_cast<double>(report.points);
    }
    window.constrains_lasers = !finding.lasers.empty();
    if (!options_.poses) note(report, window);
    return finding;
  }

  static void note(const CalibrationReport& found, WindowReport& window) {
    window.planes = found.planes;
    window.points = found.points;
    window.weakest_share = found.weakest_share;
    window.calibrated_m = found.calibrated_m;
    window.objection = found.objection;
  }

  void add_drive(std::size_t drive, std::size_t& number, WindowedCalibration& result) {
    const std::vector<ScanSpan> spans = cut_windows(drives_[drive].scans, max_scans_);
    WindowReader reader(drives_[drive], max_scans_, options_.points_a_scan);
    std::vector<WindowPoses> windows;
    Trajectory given;
    const std::size_t first = number;
    for (std::size_t k = 0; k < spans.size(); ++k, ++number) {
      PointCloud cloud = reader.read(k);
      const std::size_t known = given.size() - spans[k].begin;
      given.insert(given.end(), std::next(cloud.scan_poses.begin(), std::ptrdiff_t(known)),
                   cloud.scan_poses.end());
      windows.push_back({spans[k].begin, own_poses(cloud, report_.windows[number])});
      progress_.advance(number + 1);
    }
    const auto apart =
        settle_windows(windows, {options_.rotation_sigma_rad, options_.translation_sigma_m});
    for (std::size_t k = 0; k < apart.size(); ++k) report_.windows[first + k].overlap = apart[k];
    add_overlaps(windows);
    std::vector<PoseCorrection> poses = blended(windows, given);
    align_to_given(poses);
    if (poses.empty()) poses = common_calibration(common_, given).poses;
    auto& all = result.calibration.poses;
    all.insert(all.end(), poses.begin(), poses.end());
    result.given.insert(result.given.end(), given.begin(), given.end());
  }

  /// Pose corrections of a window after the common lasers and mount; empty with an objection.
  std::vector<PoseCorrection> own_poses(PointCloud& cloud, WindowReport& window) {
    const Trajectory given = cloud.scan_poses;
    CalibrateOptions own = options_;
    own.ranges = own.elevations = own.azimuths = own.mount_correction = false;
    const Calibration common = common_calibration(common_, given);
    if (!common.lasers.empty() || !common.mount.empty()) {
      own.poses = false;  // measures the residuals only
      const CalibrationReport as_given = calibrate_cloud_(cloud, own).second;
      window.given_m = as_given.given_m;
      add_counts(given_counts_, as_given.given);
      own.poses = options_.poses;
      if (!apply(common, cloud, executor_)) {
        window.objection = missing_for_calibration(cloud);
        return {};
      }
    }
    auto [calibration, report] = calibrate_cloud_(cloud, own);
    if (common.lasers.empty() && common.mount.empty()) {
      window.given_m = report.given_m;
      add_counts(given_counts_, report.given);
    }
    const bool has_own = options_.poses && report.objection.empty();
    if (options_.poses) note(report, window);
    window.common_m = report.given_m;
    if (!has_own) window.calibrated_m = report.given_m;
    add_counts(calibrated_counts_, has_own ? report.calibrated : report.given);
    if (has_own && !(weakest_ && weakest_->weakest_share <= report.weakest_share))
      weakest_ = report;
    return about_given(std::move(calibration.poses), given);
  }

  void add_overlaps(const std::vector<WindowPoses>& windows) {
    for (std::size_t k = 1; k < windows.size(); ++k) {
      if (windows[k - 1].poses.empty()) continue;
      const std::span before = windows[k - 1].poses, behind = windows[k].poses;
      for (std::size_t scan = windows[k].begin;
           scan < std::min(windows[k - 1].end(), windows[k].end()); ++scan) {
        overlap_before_.push_back(before[scan - windows[k - 1].begin]);
        overlap_behind_.push_back(behind[scan - windows[k].begin]);
      }
    }
  }

  void finish(WindowedCalibration& result) {
    CalibrationReport& report = result.report;
    report_.overlaps = disagreement_of(overlap_before_, overlap_behind_);
    for (const WindowReport& window : report_.windows) {
      report.planes += window.planes;
      report.points += window.points;
    }
    report.given = given_counts_;
    report.calibrated = calibrated_counts_;
    report.given_m = median_m(given_counts_);
    report.calibrated_m = median_m(calibrated_counts_);
    if (weakest_) {
      report.weakest_share = weakest_->weakest_share;
      report.weakest = weakest_->weakest;
    }
    report.mount = std::move(common_.mount);
    const bool is_mounted = report.mount && report.mount->objection.empty();
    const bool has_poses = options_.poses && report_.without_evidence() < report_.windows.size();
    if (!has_poses && common_.lasers.empty()) {
      std::string why = options_.poses && !report_.windows.empty()
                            ? "no window has evidence for its poses, the first one: " +
                                  report_.windows.front().objection
                            : "no window constrains the laser offsets";
      if (is_mounted)
        report.mount->alone_because = std::move(why);
      else
        report.objection = std::move(why);
    }
    report.windows = std::move(report_);
    if (report.objection.empty())
      result.calibration.smooth_s = best_smoothing(result.calibration);
    else
      result.calibration = {};
  }

  std::span<const DriveSource> drives_;
  const CalibrateOptions& options_;
  std::size_t max_scans_;
  const CalibrateCloud& calibrate_cloud_;
  const Executor& executor_;
  ProgressSink& progress_;
  CommonErrors common_;
  WindowsReport report_;
  ResidualCounts given_counts_, calibrated_counts_;
  std::optional<CalibrationReport> weakest_;
  std::vector<PoseCorrection> overlap_before_, overlap_behind_;  ///< of all overlaps, scan by scan
};

/// Index from the scans of a cloud to their points.
class ScanView {
 public:
  explicit ScanView(const PointCloud& cloud)
      : cloud_(cloud), begins_(cloud.scan_poses.size() + 1), order_(cloud.size()) {
    for (const std::uint32_t scan : cloud.scan_indices) ++begins_[scan + 1];
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      order_[next[cloud.scan_indices[i]]++] = static_cast<std::uint32_t>(i);
  }

  /// Points of scans [begin, end), thinned to about `points_a_scan` per scan.
  PointCloud of(std::size_t begin, std::size_t end, std::size_t points_a_scan) const {
    const std::size_t points = begins_[end] - begins_[begin];
    const std::size_t stride =
        std::max<std::size_t>(1, points / (points_a_scan * std::max<std::size_t>(1, end - begin)));
    std::vector<std::uint32_t> chosen;
    for (std::size_t k = begins_[begin]; k < begins_[end]; k += stride) chosen.push_back(order_[k]);
    PointCloud part;
    part.origin = cloud_.origin;
    for (const std::uint32_t i : chosen) {
      part.positions.push_back(cloud_.positions[i]);
      part.sensor_positions.push_back(cloud_.sensor_positions[i]);
      if (!cloud_.origin_kinds.empty()) part.origin_kinds.push_back(cloud_.origin_kinds[i]);
      if (!cloud_.lasers.empty()) part.lasers.push_back(cloud_.lasers[i]);
      part.scan_indices.push_back(cloud_.scan_indices[i] - static_cast<std::uint32_t>(begin));
    }
    part.scan_poses.assign(std::next(cloud_.scan_poses.begin(), std::ptrdiff_t(begin)),
                           std::next(cloud_.scan_poses.begin(), std::ptrdiff_t(end)));
    return part;
  }

 private:
  const PointCloud& cloud_;
  std::vector<std::size_t> begins_;   ///< into order_; number of scans + 1
  std::vector<std::uint32_t> order_;  ///< points, scan by scan
};

}  // namespace

std::vector<ScanSpan> cut_windows(std::size_t scans, std::size_t window_scans) {
  std::vector<ScanSpan> pieces = cut_pieces(scans, window_scans);
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) pieces[k].end = pieces[k + 1].end;
  if (pieces.size() > 1) pieces.pop_back();
  return pieces;
}

WindowedCalibration calibrate_windows(std::span<const DriveSource> drives,
                                      const CalibrateOptions& options,
                                      const CalibrateWindowOptions& windows,
                                      const CalibrateCloud& calibrate_cloud,
                                      const Executor& executor, ProgressSink& progress) {
  return WindowedCalibrator(drives, options, windows, calibrate_cloud, executor, progress).run();
}

std::pair<Calibration, CalibrationReport> calibrate_drives(
    const PointCloud& cloud, const CalibrateOptions& options, const CalibrateWindowOptions& windows,
    const CalibrateCloud& calibrate_cloud, const Executor& executor, ProgressSink& progress) {
  if (cloud.sensors.size() > 1 && missing_for_calibration(cloud) == nullptr)
    return calibrate_rig(cloud, options, windows, calibrate_cloud, executor, progress);
  const std::vector<ScanSpan> spans = drives_of(cloud.scan_poses);
  const bool is_long = std::ranges::any_of(
      spans, [&](const ScanSpan& span) { return span.size() > windows.window_scans; });
  if (!is_long || missing_for_calibration(cloud) != nullptr) {
    progress.begin_step("calibrate", 1);
    auto found = calibrate_cloud(cloud, options);
    progress.end_step();
    return found;
  }
  const ScanView view(cloud);
  std::vector<DriveSource> drives;
  drives.reserve(spans.size());
  for (const ScanSpan& drive : spans)
    drives.push_back({drive.size(), [&view, &options, drive](ScanSpan part) {
                        return view.of(drive.begin + part.begin, drive.begin + part.end,
                                       options.points_a_scan);
                      }});
  WindowedCalibration found =
      calibrate_windows(drives, options, windows, calibrate_cloud, executor, progress);
  return {std::move(found.calibration), std::move(found.report)};
}

}  // namespace adasplats
