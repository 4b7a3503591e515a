// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/load_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "adasplats/cloud/beams/empty_beams.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/dropped_points.h"
#include "adasplats/cloud/load/join_clouds.h"
#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/cloud/load/point_origins.h"
#include "adasplats/cloud/load/timed_points.h"
#include "adasplats/cloud/load/value_checks.h"
#include "adasplats/cloud/vehicle/driven_path.h"
#include "adasplats/cloud/vehicle/own_body.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/memory.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {

namespace {

/// The parts that were read, and their common coordinate system.
struct ReadParts {
  std::vector<CloudPart> parts;
  Crs crs;
};

bool is_unknown(float intensity) { return std::isnan(intensity); }

/// Remarks on files without a known intensity beside files with some.
void remark_on_unknown_intensities(std::span<CloudPart> parts) {
  const auto are_unknown = [](const CloudPart& part) {
    return std::ranges::all_of(part.cloud.intensities, is_unknown);
  };
  if (std::ranges::all_of(parts, are_unknown)) return;
  for (CloudPart& part : parts)
    if (!part.cloud.intensities.empty() && are_unknown(part))
      part.remarks.push_back("the intensities of all " + std::to_string(part.size()) +
                             " points are 0 or NaN, so unknown; other inputs have some");
}

/// Warns of each remark on a file, once for all files that have it.
void warn_of_remarks(std::span<const CloudPart> parts, ProgressSink& progress) {
  std::vector<std::pair<std::string, std::vector<std::string>>> files_with;
  for (const CloudPart& part : parts)
    for (const std::string& remark : part.remarks) {
      auto known = std::ranges::find(files_with, remark, [](const auto& e) { return e.first; });
      if (known == files_with.end()) known = files_with.insert(known, {remark, {}});
      known->second.push_back(part.runs.front().file.string());
    }
  for (const auto& [remark, files] : files_with) {
    const std::string more =
        files.size() == 1 ? "" : " and " + std::to_string(files.size() - 1) + " more files";
    progress.warn(files.front() + more + ": " + remark);
  }
}

ReadParts read_parts(std::span<const OpenInput> sources, const LoadOptions& options,
                     const Executor& executor, ProgressSink& progress) {
  std::vector<CloudPart> parts;
  SharedCrs crs;
  std::size_t points = 0;
  std::uint32_t scans = 0;
  for (const OpenInput& source : sources) {
    const std::filesystem::path& path = source.input.path;
    if (source.sequence) {
      parts.push_back(read_sequence_part(*source.sequence, options, scans, executor, progress));
    } else {
      parts.push_back(read_file_part(path, options, progress, &executor));
    }
    crs.add(path, parts.back().cloud.crs);
    if (source.input.is_sequence) scans += static_cast<std::uint32_t>(parts.back().runs.size());
    points += parts.back().size();
    if (points > std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorKind::data, path.string() +
                                       ": with this input the cloud exceeds 4,294,967,295 points; "
                                       "load fewer inputs, or build a city (`tile`)");
  }
  if (const std::string warning = crs.warning(); !warning.empty()) progress.warn(warning);
  for (const CloudPart& part : parts)
    if (!part.is_sequence) warn_of_steps(part.runs.front().file, part.world_positions, progress);
  remark_on_unknown_intensities(parts);
  warn_of_remarks(parts, progress);
  warn_of_intensity_scales(parts, progress);
  return {std::move(parts), crs.crs()};
}

/// Rejects a file that is one scan in the sensor frame of a known pose, and reports others.
void check_frame(const std::filesystem::path& file, const CloudPart& part,
                 const LoadOptions& options, LoadReport& report) {
  if (options.viewpoint || !part.world_sensors.empty()) return;
  const std::optional<std::filesystem::path> drive = drive_with_scan(file);
  if (!drive && !part.sensor_frame) return;
  const std::string because =
      part.sensor_frame ? part.sensor_frame->because : drive->string() + " has its pose";
  report.sensor_frames.emplace_back(file, because);
  if (options.accept_sensor_frame) return;
  const std::string what = file.string() + ": is one scan in the sensor frame (" + because + ")";
  if (drive && data_tree_of(*drive) == nullptr && std::filesystem::exists(*drive / "poses.csv"))
    throw Error(ErrorKind::data, what + "; " + advice_for_scans(*drive, *drive / "poses.csv"));
  if (drive)
    throw Error(ErrorKind::data,
                what + "; give its drive, " + drive->string() + ", which has the poses");
  if (part.sensor_frame->has_pose)
    throw Error(ErrorKind::data, what + ", at the pose in its VIEWPOINT; " +
                                     advice_for_scans(file, "POSES.csv") +
                                     ", with the pose in POSES.csv (time,x,y,z,qw,qx,qy,qz)");
}

/// check_frame() of all files. Points alone show a scan only if all files look like one: files in
/// world coordinates may begin near the origin. Scans of unknown poses are one warning.
void check_frames(std::span<const OpenInput> sources, std::vector<CloudPart>& parts,
                  const LoadOptions& options, LoadReport& report, ProgressSink& progress) {
  const bool all_scans = std::ranges::all_of(
      parts, [](const CloudPart& part) { return !part.is_sequence && part.sensor_frame; });
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].is_sequence) continue;
    if (parts[p].sensor_frame && parts[p].sensor_frame->by_points && !all_scans)
      parts[p].sensor_frame.reset();
    check_frame(sources[p].input.path, parts[p], options, report);
  }
  // Several scans are an error of require_poses_of_scans().
  if (options.accept_sensor_frame || report.sensor_frames.size() != 1) return;
  const auto& [file, because] = report.sensor_frames.front();
  progress.warn(file.string() + ": is one scan in the sensor frame (" + because +
                ") of unknown pose; the sensor frame is used as the world; " +
                advice_for_scans(file, "POSES.csv"));
}

/// Measures the parts of loading.
class LoadClock {
 public:
  explicit LoadClock(std::vector<LoadReport::PartTime>& parts) : parts_(parts) {}
  /// Records the time since the last end.
  void end(const char* name) {
    parts_.push_back({name, watch_.seconds()});
    watch_ = {};
  }

 private:
  std::vector<LoadReport::PartTime>& parts_;
  Stopwatch watch_;
};

/// Which points of a part stay, 1 or 0 each.
using Kept = std::vector<std::uint8_t>;

struct Extents {
  Vec3d low{kNone, kNone, kNone};
  Vec3d high{-kNone, -kNone, -kNone};
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Extents& operator+=(const Extents& other) {
    low = min(low, other.low);
    high = max(high, other.high);
    return *this;
  }
};

/// Marks the finite points and returns their extents.
Extents find_finite(const CloudPart& part, Kept& kept, const Executor& executor) {
  kept.resize(part.size());
  return executor.sum_chunks(
      part.size(), kCoarseGrain, Extents{}, [&](std::size_t begin, std::size_t end) {
        Extents extents;
        part.for_each(begin, end, [&](std::size_t i, Vec3d world, const PartRun&) {
          if (!is_finite(world)) return;
          kept[i] = 1;
          extents += {world, world};
        });
        return extents;
      });
}

std::size_t count_dropped(const Kept& kept) {
  return static_cast<std::size_t>(std::ranges::count(kept, std::uint8_t{0}));
}

void require_all_finite(const CloudPart& part, const Kept& kept) {
  const auto dropped = std::ranges::find(kept, std::uint8_t{0});
  if (dropped == kept.end()) return;
  const auto i = static_cast<std::size_t>(dropped - kept.begin());
  const auto run = std::ranges::upper_bound(part.runs, i, {}, &PartRun::end);
  throw Error(ErrorKind::data, run->file.string() + ": point " + std::to_string(i - run->begin) +
                                   " (from 0) is not finite in position");
}

/// Number of points with three NaN coordinates.
std::size_t count_no_returns(const CloudPart& part, const Kept& kept) {
  std::size_t count = 0;
  if (count_dropped(kept) == 0) return count;
  part.for_each(0, part.size(), [&](std::size_t i, Vec3d, const PartRun&) {
    const Vec3d p =
        part.is_sequence ? vec_cast<double>(part.cloud.positions[i]) : part.world_positions[i];
    if (std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z)) ++count;
  });
  return count;
}

/// Replaces values that are not finite with NaN (unknown). Returns how many kept points have one.
std::size_t mark_unknown(std::vector<float>& intensities, const Kept& kept,
                         const Executor& executor) {
  return executor.sum_chunks(intensities.size(), kCoarseGrain, std::size_t{0},
                             [&](std::size_t begin, std::size_t end) {
                               std::size_t count = 0;
                               for (std::size_t i = begin; i < end; ++i) {
                                 if (std::isfinite(intensities[i])) continue;
                                 intensities[i] = std::numeric_limits<float>::quiet_NaN();
                                 if (kept[i] != 0) ++count;
                               }
                               return count;
                             });
}

Extents extents_of(const CloudPart& part, const Kept& kept, const Executor& executor) {
  return executor.sum_chunks(
      part.size(), kCoarseGrain, Extents{}, [&](std::size_t begin, std::size_t end) {
        Extents extents;
        part.for_each(begin, end, [&](std::size_t i, Vec3d world, const PartRun&) {
          if (kept[i] != 0) extents += {world, world};
        });
        return extents;
      });
}

/// The parts and which of their points are kept, before they become one cloud.
struct Gathered {
  std::vector<CloudPart> parts;
  std::vector<Kept> kept = {};  ///< per part
  Extents finite = {};          ///< of the finite points

  Extents extents(const Executor& executor) const {
    Extents all;
    for (std::size_t p = 0; p < parts.size(); ++p) all += extents_of(parts[p], kept[p], executor);
    return all;
  }
};

/// The componentwise (lower) median. One axis at a time bounds the memory to 8 bytes a point.
Vec3d median_of(const Gathered& gathered) {
  Vec3d median;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
      const CloudPart& part = gathered.parts[p];
      part.for_each(0, part.size(), [&](std::size_t i, Vec3d world, const PartRun&) {
        if (gathered.kept[p][i] != 0) values.push_back(world[axis]);
      });
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[axis] = *middle;
  }
  return median;
}

/// Drops points farther from the median than allowed; returns the extents of the rest.
Extents drop_far(Gathered& gathered, double max_distance_m, const Executor& executor) {
  const Extents& all = gathered.finite;
  if (!(all.low.x <= all.high.x)) return all;  // no points
  // If the box is smaller than the distance, no point is that far from another.
  if (is_valid_position(all.low) && is_valid_position(all.high) &&
      length(all.high - all.low) <= max_distance_m)
    return all;
  const Vec3d median = median_of(gathered);
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    const CloudPart& part = gathered.parts[p];
    executor.for_chunks(part.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
      part.for_each(begin, end, [&](std::size_t i, Vec3d world, const PartRun&) {
        if (!is_valid_position(world) || !(length(world - median) <= max_distance_m))
          gathered.kept[p][i] = 0;
      });
    });
  }
  return gathered.extents(executor);
}

/// Moves the kept values together, run by run: most clouds lose few points.
template <class T>
void keep_only(std::vector<T>& values, const Kept& kept) {
  if (values.empty()) return;
  const std::uint8_t* const flags = kept.data();
  const std::size_t size = values.size();
  // The first such flag at or after `i`; memchr compares many at a time.
  const auto find = [&](std::size_t i, int flag) {
    const void* const found = i < size ? std::memchr(flags + i, flag, size - i) : nullptr;
    return found == nullptr
               ? size
               : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - flags);
  };
  std::size_t kept_end = 0;
  for (std::size_t begin = find(0, 1); begin < size;) {
    const std::size_t end = find(begin, 0);
    if (kept_end != begin)
      std::copy(values.begin() + static_cast<std::ptrdiff_t>(begin),
                values.begin() + static_cast<std::ptrdiff_t>(end),
                values.begin() + static_cast<std::ptrdiff_t>(kept_end));
    kept_end += end - begin;
    begin = find(end, 1);
  }
  const bool is_much_smaller = kept_end < size / 4 * 3;
  values.resize(kept_end);
  if (is_much_smaller) values.shrink_to_fit();
}

/// One thread per attribute, in place.
void keep_only(PointCloud& cloud, const Kept& kept, const Executor& executor) {
  std::vector<std::function<void()>> tasks = {[&] { keep_only(cloud.positions, kept); }};
  for_each_attribute([&](const auto& attribute) {
    auto& values = attribute.of(cloud);
    tasks.emplace_back([&values, &kept] { keep_only(values, kept); });
  });
  for (Column& column : cloud.others.columns)
    tasks.emplace_back([&column, &kept] {
      std::visit([&kept](auto& values) { keep_only(values, kept); }, column.values);
    });
  executor.for_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t) { tasks[task](); });
}

/// Throws data for a sensor position out of range: as a float it would be infinite.
void require_sensor_places(const CloudPart& part, const Kept& kept) {
  for (std::size_t i = 0; i < part.world_sensors.size(); ++i) {
    if (kept[i] == 0 || !is_finite(part.world_sensors[i]) ||
        is_valid_position(part.world_sensors[i]))
      continue;
    throw Error(ErrorKind::data,
                part.runs.front().file.string() + ": the sensor position of point " +
                    std::to_string(i) +
                    " (from 0) is beyond 1e12 m; expected metres, or NaN if unknown");
  }
}

/// The part's cloud relative to `origin`, without the dropped points.
PointCloud localized(CloudPart&& part, const Kept& kept, Vec3d origin, const PointOrigins& origins,
                     const Executor& executor) {
  const std::size_t points = part.size();
  const bool has_sensors = origins.has_any(part);
  const bool has_kinds = has_sensors && !part.is_sequence;
  PointCloud cloud = std::move(part.cloud);
  // The part keeps positions and kinds, since for_each() and PointOrigins read them there. Those of
  // sequences are transformed in place: each is read once, just before it is written.
  std::vector<Vec3f>& positions = part.cloud.positions;
  positions = std::move(cloud.positions);
  resize_large(positions, points);
  part.cloud.origin_kinds = std::exchange(cloud.origin_kinds, {});
  if (has_sensors) resize_large(cloud.sensor_positions, points);
  if (has_kinds) cloud.origin_kinds.resize(points);
  executor.for_chunks(points, kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    part.for_each(begin, end, [&](std::size_t i, Vec3d world, const PartRun& run) {
      if (kept[i] == 0) return;
      positions[i] = vec_cast<float>(world - origin);
      if (!has_sensors) return;
      const PointOrigin from = origins.of(part, i, world, run);
      cloud.sensor_positions[i] = vec_cast<float>(from.world - origin);
      if (has_kinds) cloud.origin_kinds[i] = from.kind;
    });
  });
  cloud.origin = origin;
  cloud.positions = std::move(positions);
  part = {};
  if (count_dropped(kept) > 0) keep_only(cloud, kept, executor);
  return cloud;
}

/// Merges flags (1 or 0 each, or empty) into others; returns how many are new.
std::size_t add_flags(const Kept& more, Kept& flags) {
  if (more.empty()) return 0;
  flags.resize(more.size());
  std::size_t added = 0;
  for (std::size_t i = 0; i < more.size(); ++i) {
    added += more[i] > flags[i] ? 1 : 0;
    flags[i] = std::max(flags[i], more[i]);
  }
  return added;
}

/// Points on the recording vehicle, of those without a flag in `left_out`.
Kept own_body(const PointCloud& cloud, std::optional<double> radius_m, const Kept& left_out,
              const Executor& executor) {
  if (!radius_m) return find_own_body(cloud, {}, executor, left_out);
  if (*radius_m == 0) return {};
  if (!cloud.has_beams()) {
    throw Error(
        ErrorKind::usage,
        "`own_body` needs sensor positions, but no point has one (`own_body` 0 keeps all points)");
  }
  return points_within(cloud, *radius_m, executor);
}

/// What a piece needs to know of the rest of the inputs.
struct PieceContext {
  bool has_whole_scans = true;  ///< all scans have all of their points
  PathBeyond beyond;
};

/// Removes the points with a flag in `moving`, those on the vehicle and those in its driven path,
/// in one pass over the cloud.
void remove_points(PointCloud& cloud, Kept moving, const LoadOptions& options,
                   const PathBeyond& beyond, LoadReport& report, const Executor& executor) {
  Kept left_out;
  report.in_boxes = add_flags(moving, left_out);
  moving = {};
  report.own_body = add_flags(own_body(cloud, options.own_body_m, left_out, executor), left_out);
  DrivenPathOptions path;
  path.half_width_m = options.driven_path_m;
  report.driven_path =
      add_flags(find_in_driven_path(cloud, path, executor, left_out, beyond), left_out);
  if (report.in_boxes + report.own_body + report.driven_path == 0) return;
  for (std::uint8_t& flag : left_out) flag = flag == 0 ? 1 : 0;  // now the points to keep
  keep_only(cloud, left_out, executor);
}

/// Flags of the kept points in boxes of moving objects, 1 or 0 each, in the order of the cloud;
/// empty: none.
Kept in_boxes(const Gathered& gathered) {
  const auto has_boxes = [](const CloudPart& part) { return !part.in_boxes.empty(); };
  Kept flags;
  if (std::ranges::none_of(gathered.parts, has_boxes)) return flags;
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    const CloudPart& part = gathered.parts[p];
    for (std::size_t i = 0; i < part.size(); ++i)
      if (gathered.kept[p][i] != 0)
        flags.push_back(has_boxes(part) && part.in_boxes[i] != 0 ? 1 : 0);
  }
  return flags;
}

/// Finds and counts the finite points of the parts.
void inspect_parts(std::span<const OpenInput> sources, const LoadOptions& options,
                   Gathered& gathered, LoadReport& report, const Executor& executor) {
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    CloudPart& part = gathered.parts[p];
    gathered.kept.emplace_back();
    gathered.finite += find_finite(part, gathered.kept.back(), executor);
    if (options.strict) require_all_finite(part, gathered.kept.back());
    report.points_read += part.size();
    if (part.is_sequence) {
      report.beams.push_back(part.beams.description());
      report.drives.push_back(
          {sources[p].input.path, part.beams.sensor, part.runs.size(),
           sources[p].is_frame_drive ? sources[p].sequence->facts : DriveFacts{}});
    }
    report.dropped_not_finite += count_dropped(gathered.kept.back());
    report.no_returns += count_no_returns(part, gathered.kept.back());
    report.unknown_intensities +=
        mark_unknown(part.cloud.intensities, gathered.kept.back(), executor);
  }
}

/// Loads open inputs; `name` is their name in messages.
std::pair<PointCloud, LoadReport> load_open(std::span<const OpenInput> sources,
                                            const LoadOptions& options, const std::string& name,
                                            const PieceContext& context, const Executor& executor,
                                            ProgressSink& progress) {
  const PointOrigins origins(options);
  LoadReport report;
  LoadClock clock(report.seconds);
  auto [parts, crs] = read_parts(sources, options, executor, progress);
  const auto is_empty = [](const CloudPart& part) { return part.size() == 0; };
  if (!options.selection.is_all() && std::ranges::all_of(parts, is_empty)) {
    PointCloud none;
    none.crs = std::move(crs);
    return {std::move(none), std::move(report)};
  }
  check_frames(sources, parts, options, report, progress);
  Gathered gathered{std::move(parts)};
  require_poses_of_scans(name, report);
  const std::optional<PlacedByTimes> placed =
      place_by_times(gathered.parts, options, executor, progress);
  const bool any_drive = std::ranges::any_of(sources, &OpenInput::is_frame_drive);
  require_options_used(options, placed.has_value() || any_drive, placed.has_value() || any_drive);
  Trajectory scan_poses = scan_poses_of(gathered.parts, placed);

  clock.end("read");
  inspect_parts(sources, options, gathered, report, executor);
  if (placed) {
    report.timed = placed->origins;
    report.drives.push_back({sources.front().input.path, {}, placed->origins.scans});
  }
  const Extents extents = drop_far(gathered, options.max_distance_m, executor);
  std::size_t dropped = 0;
  for (const Kept& kept : gathered.kept) dropped += count_dropped(kept);
  report.dropped_far = dropped - report.dropped_not_finite;
  report_dropped(name, report, options, progress);
  require_metres(name, extents.low, extents.high, crs, progress);
  const Vec3d origin = choose_origin(extents.low, extents.high);

  Kept moving = in_boxes(gathered);
  std::vector<PointCloud> clouds;
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    require_sensor_places(gathered.parts[p], gathered.kept[p]);
    clouds.push_back(
        localized(std::move(gathered.parts[p]), gathered.kept[p], origin, origins, executor));
    const CloudInput& input = sources[p].input;
    if (!input.is_sequence) check_origins(clouds.back(), input.path, options, executor);
  }
  PointCloud cloud = join_clouds(std::move(clouds), origin, std::move(scan_poses), progress);
  cloud.crs = std::move(crs);
  clock.end("place");
  // Before any point is removed: where one was, its beam did return.
  if (options.empty_beams && context.has_whole_scans)
    cloud.empty_beams = find_empty_beams(cloud, {.lost = options.lost_beams}, executor);
  clock.end("find empty beams");
  remove_points(cloud, std::move(moving), options, context.beyond, report, executor);
  report_own_body(name, report, options, progress);
  clock.end("leave the vehicle out");
  report.origins = count_origins(cloud);
  return {std::move(cloud), report};
}

}  // namespace

void require_poses_of_scans(const std::string& name, const LoadReport& report) {
  const std::size_t scans = report.sensor_frames.size();
  if (scans < 2) return;
  const auto& [file, because] = report.sensor_frames.front();
  throw Error(ErrorKind::data,
              name + ": " + std::to_string(scans) +
                  " of its files are scans in the sensor frame (" + file.string() + ": " + because +
                  "), which cannot be joined without their poses; give the folder of the scans "
                  "with the poses as `trajectory`, or `viewpoint` 0,0,0 if the sensor stood still");
}

std::pair<PointCloud, LoadReport> OpenInputs::load(const Executor& executor,
                                                   ProgressSink& progress) const {
  if (rig_) return load_sensors(executor, progress);
  const PieceContext context = {options_.selection.is_all(), {}};
  auto loaded = load_open(inputs_, options_, name_, context, executor, progress);
  std::vector<float>& intensities = loaded.first.intensities;
  if (std::ranges::all_of(intensities, is_unknown)) intensities = {};
  if (loaded.second.points_read == 0 && options_.selection.extent) throw empty_extent_error();
  return loaded;
}

namespace {

/// CloudSensor::unknown_sweep_m of a drive. Most scans last 0.1 s.
double unknown_sweep_m(const KittiSequence& drive, SweepPoints stated) {
  const bool is_unknown = drive.facts.is_motion_assumed || !drive.reader;
  if (!is_unknown || stated == SweepPoints::compensated || drive.trajectory.size() < 2) return 0;
  if (drive.beams.from_hdl64) return drive.beams.unknown_sweep_m;
  constexpr double kScan_s = 0.1, kLever_m = 10;
  std::vector<double> moved_m;
  for (std::size_t k = 1; k < drive.trajectory.size(); ++k) {
    const TimedPose &from = drive.trajectory[k - 1], &to = drive.trajectory[k];
    const RigidTransform way = from.world_from_sensor.inverse() * to.world_from_sensor;
    const double share = std::min(1.0, kScan_s / (to.time_s - from.time_s));
    moved_m.push_back(share *
                      (length(way.translation) + kLever_m * angle_between(way.rotation, Mat3d{})));
  }
  return upper_median_of(std::move(moved_m));
}

}  // namespace

std::pair<PointCloud, LoadReport> OpenInputs::load_sensors(const Executor& executor,
                                                           ProgressSink& progress) const {
  std::vector<PointCloud> clouds;
  std::vector<CloudSensor> sensors;
  LoadReport report;
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    const RigSensor& sensor = rig_->sensors[k];
    sensors.push_back({sensor.name, 0, sensor.is_in_model,
                       unknown_sweep_m(*inputs_[k].sequence, sensor.sweep_points)});
    auto [cloud, loaded] = load({k}, executor, progress);
    clouds.push_back(std::move(cloud));
    report.add(std::move(loaded));
  }
  return {join_sensors(std::move(clouds), std::move(sensors), progress), std::move(report)};
}

void LoadReport::add(LoadReport&& other) {
  points_read += other.points_read;
  dropped_not_finite += other.dropped_not_finite;
  no_returns += other.no_returns;
  unknown_intensities += other.unknown_intensities;
  dropped_far += other.dropped_far;
  in_boxes += other.in_boxes;
  own_body += other.own_body;
  driven_path += other.driven_path;
  for (std::size_t kind = 0; kind < origins.size(); ++kind) origins[kind] += other.origins[kind];
  const auto move_to = [](auto& all, auto&& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  move_to(beams, std::move(other.beams));
  move_to(drives, std::move(other.drives));
  move_to(seconds, std::move(other.seconds));
}

std::pair<PointCloud, LoadReport> OpenInputs::load(const InputPiece& piece,
                                                   const Executor& executor,
                                                   ProgressSink& progress) const {
  const OpenInput& input = inputs_.at(piece.input);
  const bool is_all = piece.first == 0 && piece.count == InputPiece().count;
  LoadOptions part = options_;
  PieceContext context = {options_.selection.is_all(), {}};
  if (input.sequence) context.beyond = path_beyond(piece);
  if (input.sequence && !is_all) {
    part.first_scan += static_cast<std::size_t>(piece.first) * options_.scan_stride;
    part.scan_count = static_cast<std::size_t>(piece.count);
  } else if (!is_all) {
    part.selection.records = RecordSpan{piece.first, piece.count};
    context.has_whole_scans = context.has_whole_scans && piece.has_whole_scans;
    context.beyond = piece.beyond;
  }
  return load_open({&input, 1}, part, input.input.path.string(), context, executor, progress);
}

std::pair<PointCloud, LoadReport> load_cloud(std::span<const std::filesystem::path> inputs,
                                             const LoadOptions& options, const Executor& executor,
                                             ProgressSink& progress) {
  return OpenInputs(inputs, options, executor, progress).load(executor, progress);
}

}  // namespace adasplats
