// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/load_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "adasplats/cloud/beams/empty_beams.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/dropped_points.h"
#include "adasplats/cloud/load/frame_drive.h"
#include "adasplats/cloud/load/point_origins.h"
#include "adasplats/cloud/load/timed_points.h"
#include "adasplats/cloud/vehicle/driven_path.h"
#include "adasplats/cloud/vehicle/own_body.h"
#include "adasplats/core/error.h"
#include "adasplats/core/large_vector.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/box_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/packets/capture_reader.h"

namespace adasplats {

namespace {

using Input = CloudInput;

/// Something to read: a file, or a drive that is open already.
struct Source {
  Input input;
  std::optional<KittiSequence> drive;
};

std::vector<Input> list_inputs(std::span<const std::filesystem::path> paths) {
  if (paths.empty()) throw Error(ErrorKind::usage, "no inputs to load");
  std::vector<Input> inputs, sequences;
  for (const std::filesystem::path& path : paths) {
    const std::vector<Input> found = cloud_inputs(path);
    inputs.insert(inputs.end(), found.begin(), found.end());
  }
  std::ranges::copy_if(inputs, std::back_inserter(sequences), &Input::is_sequence);
  if (sequences.size() > 1) require_one_world(sequences);
  return inputs;
}

/// The inputs, folders of scans with a trajectory as one drive each.
std::vector<Source> open_sources(std::span<const std::filesystem::path> paths,
                                 const LoadOptions& options, const Executor& executor,
                                 ProgressSink& progress) {
  std::vector<std::filesystem::path> others;
  std::vector<Source> sources;
  for (const std::filesystem::path& path : paths) {
    std::optional<KittiSequence> drive;
    if (!options.trajectory.empty() || is_drive_by_itself(path))
      drive = open_frame_drive(drive_of(path, options), executor, progress);
    if (drive)
      sources.push_back({{path, true}, std::move(drive)});
    else
      others.push_back(path);
  }
  if (!others.empty() || paths.empty())
    for (const Input& input : list_inputs(others)) sources.push_back({input, {}});
  return sources;
}

Error usage(const std::string& message) { return {ErrorKind::usage, message}; }

/// What is wrong with options whatever the inputs are.
void require_sound(const LoadOptions& options) {
  if (options.scan_stride == 0) throw usage("a scan stride of 0");
  if (options.scan_count == 0) throw usage("a scan count of 0");
  const int sensor_fields = !options.sensor_x_field.empty() + !options.sensor_y_field.empty() +
                            !options.sensor_z_field.empty();
  if (sensor_fields != 0 && sensor_fields != 3)
    throw usage("the columns of the sensor position are three or none");
  if (options.viewpoint && !options.trajectory.empty())
    throw usage("a viewpoint and a trajectory both give the sensor position");
  if (options.viewpoint && !is_place(*options.viewpoint))
    throw usage("the viewpoint is not finite, or beyond 1e12 m");
  check_settings(options);
}

void require_options_that_fit(const LoadOptions& options, std::span<const Source> sources) {
  const auto is_sequence = [](const Source& source) { return source.input.is_sequence; };
  const bool any_drive =
      std::ranges::any_of(sources, [](const Source& source) { return source.drive.has_value(); });
  const bool any_sequence = std::ranges::any_of(sources, is_sequence);
  const bool any_file = !std::ranges::all_of(sources, is_sequence);
  const LoadOptions defaults;
  const bool chooses_scans = options.first_scan != defaults.first_scan ||
                             options.scan_count != defaults.scan_count ||
                             options.scan_stride != defaults.scan_stride;
  if (chooses_scans && !any_sequence)
    throw usage("scans are chosen, but no input is a sequence folder");
  if ((!options.sensor_x_field.empty() || !options.label_field.empty()) && !any_file)
    throw usage("columns are named, but no input is a file of points");
  if (!options.selection.is_all() && any_sequence)
    throw usage(
        "`extent`, `level` and `resolution` choose points of files, and an input is a drive");
  if (options.beams_from_poses && !any_sequence)
    throw usage("beams are to start at poses, but no input is a sequence folder");
  if (!options.boxes.empty() && !any_drive)
    throw usage("boxes are given, but no input is a folder of scans with times and a trajectory");
  const bool states_frames = options.points_in == PointsIn::sensor ||
                             options.sweep_points != SweepPoints::found ||
                             !options.scan_times.empty();
  if (states_frames && !any_drive)
    throw usage(
        "`points_in`, `sweep_points` and `scan_times` are for a folder of scans, one a file, with "
        "a `trajectory`; no input is one in the frame of its sensor");
  const bool any_recording = std::ranges::any_of(
      sources, [](const Source& source) { return is_recording(source.input.path); });
  if ((!options.topic.empty() || !options.poses_topic.empty()) && !any_recording)
    throw usage("`topic` and `poses_topic` are for a recording (MCAP, ROS bag); no input is one");
  const bool any_tree = std::ranges::any_of(
      sources, [](const Source& source) { return data_tree_of(source.input.path) != nullptr; });
  if (!options.scene.empty() && !any_tree)
    throw usage("`scene` is for a data root of nuScenes; no input is one");
  const auto is_of_packets = [](const Source& source) { return is_capture(source.input.path); };
  if (!options.packets_of.empty() && std::ranges::none_of(sources, is_of_packets))
    throw usage("`packets_of` is for a capture of packets (.pcap, .pcapng); no input is one");
  const bool states_origins = options.viewpoint || (!options.trajectory.empty() && !any_drive);
  if (states_origins && !any_file)
    throw usage("a sensor position is given, but every input has its own");
}

/// In whole steps of a file's coordinates, as its points are: headers may hold more digits.
Vec3d in_steps(Vec3d place, Vec3d step) {
  for (int axis = 0; axis < 3; ++axis)
    if (step[axis] > 0) place[axis] = std::round(place[axis] / step[axis]) * step[axis];
  return place;
}

/// Of an extent without points.
Error nothing_within(std::span<const Source> sources, const LoadOptions& options) {
  const std::filesystem::path& first = sources.front().input.path;
  std::string message = "no point of " + first.string();
  if (sources.size() > 1) message += " and " + std::to_string(sources.size() - 1) + " more inputs";
  message += " lies in the extent " +
             box_text(options.selection.extent->low, options.selection.extent->high);
  if (is_las(first)) {
    const LasFacts las = read_las_facts(first);
    message += "; " + first.string() + " has " +
               box_text(in_steps(las.box_min, las.scale), in_steps(las.box_max, las.scale)) +
               " by its header";
  }
  return {ErrorKind::data, message};
}

/// What is read, and the one coordinate system of all.
struct ReadParts {
  std::vector<CloudPart> parts;
  Crs crs;
};

ReadParts read_parts(std::span<const Source> sources, const LoadOptions& options,
                     const Executor& executor, ProgressSink& progress) {
  std::vector<CloudPart> parts;
  SharedCrs crs;
  std::size_t points = 0;
  std::uint32_t scans = 0;
  for (const Source& source : sources) {
    const std::filesystem::path& path = source.input.path;
    if (source.input.is_sequence) {
      const KittiSequence sequence =
          source.drive ? *source.drive : open_sequence(path, options, executor);
      parts.push_back(read_sequence_part(sequence, options, scans, executor, progress));
    } else {
      parts.push_back(read_file_part(path, options, progress, &executor));
    }
    crs.add(path, parts.back().cloud.crs);
    if (source.input.is_sequence) scans += static_cast<std::uint32_t>(parts.back().runs.size());
    points += parts.back().size();
    if (points > std::numeric_limits<std::uint32_t>::max())
      throw Error(ErrorKind::data,
                  path.string() + ": with it the cloud has more than 4294967295 points");
  }
  if (points == 0 && options.selection.extent) throw nothing_within(sources, options);
  if (const std::string warning = crs.warning(); !warning.empty()) progress.warn(warning);
  return {std::move(parts), crs.crs()};
}

/// Tells the parts of loading apart.
class LoadClock {
 public:
  explicit LoadClock(std::vector<LoadReport::PartTime>& parts) : parts_(parts) {}
  /// What was done since the last end.
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

/// Marks the points that are finite; gives their extents.
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

/// How many points have NaN in all three coordinates.
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

/// Makes what is not finite NaN: not known. Gives how many of the points that are kept have that.
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

/// What the inputs are called in a message about all of them.
std::string name_of(std::span<const std::filesystem::path> inputs) {
  return inputs.front().string() +
         (inputs.size() == 1 ? "" : " and " + std::to_string(inputs.size() - 1) + " more inputs");
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

/// The parts and what is known of their points on the way to one cloud.
struct Gathered {
  std::vector<CloudPart> parts;
  std::vector<Kept> kept = {};  ///< one a part
  Extents finite = {};          ///< of the points that are

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

/// Drops what is farther from the median than allowed; gives the extents of the rest.
Extents drop_far(Gathered& gathered, double max_distance_m, const Executor& executor) {
  const Extents& all = gathered.finite;
  if (!(all.low.x <= all.high.x)) return all;  // no points
  // Where the whole box is smaller than the distance no point is farther from any other.
  if (is_place(all.low) && is_place(all.high) && length(all.high - all.low) <= max_distance_m)
    return all;
  const Vec3d median = median_of(gathered);
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    const CloudPart& part = gathered.parts[p];
    executor.for_chunks(part.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
      part.for_each(begin, end, [&](std::size_t i, Vec3d world, const PartRun&) {
        if (!is_place(world) || !(length(world - median) <= max_distance_m))
          gathered.kept[p][i] = 0;
      });
    });
  }
  return gathered.extents(executor);
}

/// Moves the values that stay together, run by run: few are dropped of most clouds.
template <class T>
void keep_only(std::vector<T>& values, const Kept& kept) {
  if (values.empty()) return;
  const std::uint8_t* const flags = kept.data();
  const std::size_t size = values.size();
  // The first flag of a kind from `i` on; memchr looks at many at a time.
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

/// Each attribute by a thread, in place.
void keep_only(PointCloud& cloud, const Kept& kept, const Executor& executor) {
  std::vector<std::function<void()>> tasks = {[&] { keep_only(cloud.positions, kept); }};
  for_each_attribute([&](const auto& attribute) {
    auto& values = attribute.of(cloud);
    tasks.emplace_back([&values, &kept] { keep_only(values, kept); });
  });
  executor.for_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t) { tasks[task](); });
}

/// Throws data for a sensor position that is no place: a float of it would be infinite.
void require_sensor_places(const CloudPart& part, const Kept& kept) {
  for (std::size_t i = 0; i < part.world_sensors.size(); ++i) {
    if (kept[i] == 0 || !is_finite(part.world_sensors[i]) || is_place(part.world_sensors[i]))
      continue;
    throw Error(ErrorKind::data, part.runs.front().file.string() +
                                     ": the sensor position of point " + std::to_string(i) +
                                     " (from 0) is beyond 1e12 m; expected metres, or NaN " +
                                     "where it is not known");
  }
}

/// The part's cloud relative to `origin`, without the points that are dropped.
PointCloud localized(CloudPart&& part, const Kept& kept, Vec3d origin, const PointOrigins& origins,
                     const Executor& executor) {
  const std::size_t points = part.size();
  const bool has_sensors = origins.has_any(part);
  const bool has_kinds = has_sensors && !part.is_sequence;
  PointCloud cloud = std::move(part.cloud);
  // The part keeps the positions, since for_each() reads them there; those of sequences are
  // transformed in place, each read once, just before it is written. Likewise the kinds.
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

/// Adds flags, 1 or 0 each, to others; gives how many of the points had none. None at all: 0.
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

/// The points on the vehicle that carried the sensor, of those without a flag in `left_out`.
Kept own_body(const PointCloud& cloud, std::optional<double> radius_m, const Kept& left_out,
              const Executor& executor) {
  if (!radius_m) return find_own_body(cloud, {}, executor, left_out);
  if (*radius_m == 0) return {};
  if (!cloud.has_beams()) {
    throw Error(ErrorKind::usage,
                "points near their sensor are to be left out, but no point says where it was");
  }
  return points_within(cloud, *radius_m, executor);
}

/// Leaves out the points with a flag in `moving` and those of the vehicle: on it, and where it
/// drove. The cloud is gone through once, when all of them are known.
void leave_out(PointCloud& cloud, Kept moving, const LoadOptions& options, LoadReport& report,
               const Executor& executor) {
  Kept left_out;
  report.in_boxes = add_flags(moving, left_out);
  moving = {};
  report.own_body = add_flags(own_body(cloud, options.own_body_m, left_out, executor), left_out);
  DrivenPathOptions path;
  path.half_width_m = options.driven_path_m;
  report.driven_path = add_flags(find_in_driven_path(cloud, path, executor, left_out), left_out);
  if (report.in_boxes + report.own_body + report.driven_path == 0) return;
  for (std::uint8_t& flag : left_out) flag = flag == 0 ? 1 : 0;  // now of those that stay
  keep_only(cloud, left_out, executor);
}

/// Of the points that are kept, in the order of the cloud, those in boxes of moving objects, 1 or 0
/// each; empty where none is.
Kept in_boxes(const Gathered& gathered) {
  const auto has_boxes = [](const CloudPart& part) { return !part.in_boxes.empty(); };
  Kept flags;
  if (std::ranges::none_of(gathered.parts, has_boxes)) return flags;
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    const CloudPart& part = gathered.parts[p];
    for (std::size_t i = 0; i < part.size(); ++i)
      if (gathered.kept[p][i] != 0) flags.push_back(has_boxes(part) ? part.in_boxes[i] : 0);
  }
  return flags;
}

/// Finds what of the parts is finite, and counts it.
void look_at_parts(std::span<const Source> sources, const LoadOptions& options, Gathered& gathered,
                   LoadReport& report, const Executor& executor) {
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    CloudPart& part = gathered.parts[p];
    gathered.kept.emplace_back();
    gathered.finite += find_finite(part, gathered.kept.back(), executor);
    if (options.strict) require_all_finite(part, gathered.kept.back());
    report.points_read += part.size();
    if (part.is_sequence) {
      report.beams.push_back(part.beams.description());
      report.drives.push_back({sources[p].input.path, part.beams.sensor, part.runs.size(),
                               sources[p].drive ? sources[p].drive->facts : DriveFacts{}});
    }
    report.dropped_not_finite += count_dropped(gathered.kept.back());
    report.no_returns += count_no_returns(part, gathered.kept.back());
    report.unknown_intensities +=
        mark_unknown(part.cloud.intensities, gathered.kept.back(), executor);
  }
}

}  // namespace

std::pair<PointCloud, LoadReport> load_cloud(std::span<const std::filesystem::path> inputs,
                                             const LoadOptions& options, const Executor& executor,
                                             ProgressSink& progress) {
  require_sound(options);
  const std::vector<Source> sources = open_sources(inputs, options, executor, progress);
  require_options_that_fit(options, sources);
  const PointOrigins origins(options);
  LoadReport report;
  LoadClock clock(report.seconds);
  auto [parts, crs] = read_parts(sources, options, executor, progress);
  Gathered gathered{std::move(parts)};
  const std::optional<PlacedByTimes> placed =
      place_by_times(gathered.parts, options, executor, progress);
  const bool any_drive =
      std::ranges::any_of(sources, [](const Source& source) { return source.drive.has_value(); });
  require_used(options, placed.has_value() || any_drive, placed.has_value() || any_drive);
  Trajectory scan_poses = scan_poses_of(gathered.parts, placed);

  clock.end("read");
  look_at_parts(sources, options, gathered, report, executor);
  if (placed) {
    report.timed = placed->origins;
    report.drives.push_back({sources.front().input.path, {}, placed->origins.scans});
  }
  const Extents extents = drop_far(gathered, options.max_distance_m, executor);
  std::size_t dropped = 0;
  for (const Kept& kept : gathered.kept) dropped += count_dropped(kept);
  report.dropped_far = dropped - report.dropped_not_finite;
  report_dropped(name_of(inputs), report, options, progress);
  require_metres(name_of(inputs), extents.low, extents.high, crs, progress);
  const Vec3d origin = choose_origin(extents.low, extents.high);

  Kept moving = in_boxes(gathered);
  std::vector<PointCloud> clouds;
  for (std::size_t p = 0; p < gathered.parts.size(); ++p) {
    require_sensor_places(gathered.parts[p], gathered.kept[p]);
    clouds.push_back(
        localized(std::move(gathered.parts[p]), gathered.kept[p], origin, origins, executor));
    const Input& input = sources[p].input;
    if (!input.is_sequence) check_origins(clouds.back(), input.path, options, executor);
  }
  PointCloud cloud = joined(std::move(clouds), origin, std::move(scan_poses), progress);
  cloud.crs = std::move(crs);
  clock.end("place");
  // Before any point is taken away: where one was, its beam did return.
  if (options.empty_beams && options.selection.is_all())
    cloud.empty_beams = find_empty_beams(cloud, {}, executor);
  clock.end("find empty beams");
  leave_out(cloud, std::move(moving), options, report, executor);
  report_own_body(name_of(inputs), report, options, progress);
  clock.end("leave the vehicle out");
  report.origins = count_origins(cloud);
  return {std::move(cloud), report};
}

}  // namespace adasplats
