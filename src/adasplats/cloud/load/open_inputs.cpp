// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/open_inputs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/cloud/load/box_files.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/rig_of_drive.h"
#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/packets/capture_reader.h"

namespace adasplats {

namespace {

std::vector<CloudInput> list_inputs(std::span<const std::filesystem::path> paths) {
  std::vector<CloudInput> inputs, sequences;
  for (const std::filesystem::path& path : paths) {
    const std::vector<CloudInput> found = cloud_inputs(path);
    inputs.insert(inputs.end(), found.begin(), found.end());
  }
  std::ranges::copy_if(inputs, std::back_inserter(sequences), &CloudInput::is_sequence);
  if (sequences.size() > 1) require_distinct_starts(sequences);
  return inputs;
}

/// The rig of a file with the sensor that `topic` names or all, or of a drive of several sensors
/// (rig_of_drive()); nothing for other inputs.
std::optional<Rig> rig_of(const std::filesystem::path& input, const LoadOptions& options,
                          ProgressSink& progress) {
  if (!is_rig(input)) {
    if (!options.topic.empty()) return std::nullopt;
    return rig_of_drive(input, options, progress);
  }
  Rig rig = read_rig(input);
  require_no_settings(rig, options);
  if (!options.topic.empty()) {
    rig.sensors = {rig.sensors[rig.index_of(options.topic)]};
    rig.sensors.front().is_in_model = true;
  }
  return rig;
}

/// Throws data for sensors without a common time.
void require_common_time(const KittiSequence& first, const KittiSequence& other) {
  if (!first.has_times || !other.has_times) return;
  const auto begin_s = [](const KittiSequence& drive) { return drive.trajectory.front().time_s; };
  const auto end_s = [](const KittiSequence& drive) { return drive.trajectory.back().time_s; };
  if (begin_s(other) <= end_s(first) && begin_s(first) <= end_s(other)) return;
  const auto span = [&](const KittiSequence& drive) {
    return exact_text(begin_s(drive)) + " to " + exact_text(end_s(drive)) + " s";
  };
  throw Error(ErrorKind::data,
              "sensor '" + other.rig_sensor + "': its scans are of " + span(other) +
                  ", those of '" + first.rig_sensor + "' of " + span(first) +
                  ": their clocks differ (set time_offset_s in the rig file), or they are of two "
                  "drives");
}

/// Opens the sensors of a rig.
std::vector<OpenInput> opened_sensors(const Rig& rig, const Executor& executor,
                                      ProgressSink& progress) {
  std::vector<OpenInput> inputs;
  for (const RigSensor& sensor : rig.sensors) {
    KittiSequence drive = open_rig_sensor(sensor, executor, progress);
    inputs.push_back({{sensor.folder, true}, std::move(drive), true});
    require_common_time(*inputs.front().sequence, *inputs.back().sequence);
  }
  return inputs;
}

/// Opens the inputs; a folder of scans with a trajectory is one drive.
std::vector<OpenInput> opened(std::span<const std::filesystem::path> paths,
                              const LoadOptions& options, const Executor& executor,
                              ProgressSink& progress) {
  std::vector<std::filesystem::path> others;
  std::vector<OpenInput> inputs;
  for (const std::filesystem::path& path : paths) {
    std::optional<KittiSequence> drive;
    if (!options.trajectory.empty() || is_self_contained_drive(path))
      drive = open_drive(drive_of(path, options), executor, progress);
    if (drive)
      inputs.push_back({{path, true}, std::move(drive), true});
    else
      others.push_back(path);
  }
  if (!others.empty())
    for (const CloudInput& input : list_inputs(others)) inputs.push_back({input, {}, false});
  return inputs;
}

Error usage(const std::string& message) { return {ErrorKind::usage, message}; }

/// Checks the options that are invalid for any input.
void require_sound(const LoadOptions& options) {
  if (options.scan_stride == 0) throw usage("the scan stride is 0; expected 1 or more");
  if (options.scan_count == 0) throw usage("the scan count is 0; expected 1 or more");
  const int sensor_fields = !options.sensor_x_field.empty() + !options.sensor_y_field.empty() +
                            !options.sensor_z_field.empty();
  if (sensor_fields != 0 && sensor_fields != 3)
    throw usage("the sensor position needs all three columns (x, y and z) or none");
  if (options.viewpoint && !options.trajectory.empty())
    throw usage(
        "`viewpoint` and `trajectory` both give the sensor position; give only one of them");
  if (options.viewpoint && !is_valid_position(*options.viewpoint))
    throw usage("`viewpoint` is not finite, or beyond 1e12 m");
  check_settings(options);
}

void require_drive_of_boxes(const LoadOptions& options, std::span<const OpenInput> inputs) {
  if (options.boxes.empty()) return;
  const auto is_drive = [](const OpenInput& input) {
    return input.is_frame_drive || input.input.is_sequence;
  };
  const auto drives = std::ranges::count_if(inputs, is_drive);
  if (drives == 0) throw usage("`boxes` needs a drive: scans with poses; no input is one");
  if (drives > 1 && is_of_numbered_scans(options.boxes))
    throw usage(options.boxes.string() +
                ": KITTI's tracklets are of one drive, but several inputs are drives");
}

void require_applicable_options(const LoadOptions& options, std::span<const OpenInput> inputs) {
  const auto is_sequence = [](const OpenInput& input) { return input.input.is_sequence; };
  const bool any_drive = std::ranges::any_of(inputs, &OpenInput::is_frame_drive);
  const bool any_sequence = std::ranges::any_of(inputs, is_sequence);
  const bool any_file = !std::ranges::all_of(inputs, is_sequence);
  const LoadOptions defaults;
  const bool chooses_scans = options.first_scan != defaults.first_scan ||
                             options.scan_count != defaults.scan_count ||
                             options.scan_stride != defaults.scan_stride;
  if (chooses_scans && !any_sequence)
    throw usage("a choice of scans needs a sequence folder; no input is one");
  if ((!options.sensor_x_field.empty() || !options.label_field.empty()) && !any_file)
    throw usage("names of columns need a point file; no input is one");
  if (!options.selection.is_all() && any_sequence)
    throw usage(
        "`extent`, `level` and `resolution` select points of files; they do not apply to drives");
  if (options.beams_from_poses && !any_sequence)
    throw usage("`beams_from_poses` needs a sequence folder; no input is one");
  require_drive_of_boxes(options, inputs);
  const bool states_frames = options.points_in == PointsIn::sensor ||
                             options.sweep_points != SweepPoints::found ||
                             !options.scan_times.empty();
  if (states_frames && !any_drive)
    throw usage(
        "`points_in`, `sweep_points` and `scan_times` need a folder of scans (one per file) in the "
        "sensor frame with a `trajectory`; no input is one");
  const bool any_recording = std::ranges::any_of(
      inputs, [](const OpenInput& input) { return is_recording(input.input.path); });
  if (!options.poses_topic.empty() && !any_recording)
    throw usage("`poses_topic` needs a recording (MCAP, ROS bag); no input is one");
  const auto tree_of = [](const OpenInput& input) { return data_tree_of(input.input.path); };
  const bool any_tree = std::ranges::any_of(
      inputs, [&](const OpenInput& input) { return tree_of(input) != nullptr; });
  if (!options.scene.empty() && !any_tree)
    throw usage("`scene` needs a nuScenes data root; no input is one");
  const bool has_packets = any_recording || std::ranges::any_of(inputs, [](const OpenInput& input) {
                             return is_capture(input.input.path);
                           });
  const bool any_sensors = std::ranges::any_of(inputs, [&](const OpenInput& input) {
    return tree_of(input) != nullptr && !tree_of(input)->sensors.empty();
  });
  if (!options.topic.empty() && !has_packets && !any_sensors)
    throw usage(
        "`topic` needs a recording, a packet capture or a data set of several LiDARs; no input is "
        "one");
  if (!options.packet_sensor.empty() && !has_packets)
    throw usage("`packet_sensor` needs a packet capture or a recording; no input is one");
  const bool states_origins = options.viewpoint || (!options.trajectory.empty() && !any_drive);
  if (states_origins && !any_file)
    throw usage(
        "`viewpoint` and `trajectory` need point files; all inputs are drives, which use the pose "
        "of each scan");
}

/// Throws data if there are several stations and each is in its own frame.
void require_registered(std::span<const OpenInput> inputs) {
  const auto is_own = [](const OpenInput& input) { return is_ptx_in_own_frame(input.input.path); };
  if (inputs.size() < 2 || !std::ranges::all_of(inputs, is_own)) return;
  throw Error(ErrorKind::data,
              inputs[0].input.path.string() + " and " + inputs[1].input.path.string() +
                  (inputs.size() > 2 ? " and " + std::to_string(inputs.size() - 2) + " more" : "") +
                  ": all stations have the identity matrix: each is in its own frame; register "
                  "them, or give only one");
}

/// Rounded to the steps of a file's coordinates, as its points are: headers may have more digits.
Vec3d in_steps(Vec3d place, Vec3d step) {
  for (int axis = 0; axis < 3; ++axis)
    if (step[axis] > 0) place[axis] = std::round(place[axis] / step[axis]) * step[axis];
  return place;
}

/// The name of the inputs in messages about all of them.
std::string name_of(std::span<const std::filesystem::path> inputs) {
  return inputs.front().string() +
         (inputs.size() == 1 ? "" : " and " + std::to_string(inputs.size() - 1) + " more inputs");
}

}  // namespace

OpenInputs::OpenInputs(std::span<const std::filesystem::path> inputs, const LoadOptions& options,
                       const Executor& executor, ProgressSink& progress)
    : options_(options) {
  require_sound(options);
  if (inputs.empty()) throw usage("no inputs to load");
  name_ = name_of(inputs);
  const auto file = std::ranges::find_if(inputs, is_rig);
  if (file != inputs.end() && inputs.size() > 1)
    throw usage(file->string() + ": is a rig; other inputs cannot be joined with it");
  if (inputs.size() == 1) rig_ = rig_of(inputs[0], options, progress);
  if (rig_) {
    inputs_ = opened_sensors(*rig_, executor, progress);
    options_.topic.clear();
    return;
  }
  inputs_ = opened(inputs, options, executor, progress);
  require_applicable_options(options, inputs_);
  require_registered(inputs_);
  for (OpenInput& input : inputs_)
    if (input.input.is_sequence && !input.sequence) {
      input.sequence = open_sequence(input.input.path, options, executor);
      add_boxes(options, {}, *input.sequence, executor, progress);
    }
}

bool OpenInputs::are_drives() const {
  return std::ranges::all_of(inputs_,
                             [](const OpenInput& input) { return input.input.is_sequence; });
}

std::size_t OpenInputs::chosen_scans(std::size_t input) const {
  const std::size_t scans = inputs_.at(input).sequence->scans.size();
  if (options_.first_scan >= scans) return 0;
  return std::min(options_.scan_count,
                  (scans - options_.first_scan - 1) / options_.scan_stride + 1);
}

std::size_t OpenInputs::thin_scans(std::size_t every, std::size_t min_scans) {
  std::size_t longest = 0;
  for (std::size_t k = 0; k < inputs_.size(); ++k)
    if (inputs_[k].sequence) longest = std::max(longest, chosen_scans(k));
  every = std::clamp(longest / min_scans, std::size_t{1}, every);
  options_.scan_stride *= every;
  return every;
}

/// Sensor positions of all scans of all drives outside the piece.
PathBeyond OpenInputs::path_beyond(const InputPiece& piece) const {
  PathBeyond beyond;
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    if (!inputs_[k].sequence) continue;
    const Trajectory& poses = inputs_[k].sequence->trajectory;
    const std::size_t scans = chosen_scans(k);
    for (std::size_t scan = 0; scan < scans; ++scan) {
      const bool is_before = k < piece.input || (k == piece.input && scan < piece.first);
      if (!is_before && k == piece.input && scan - piece.first < piece.count) continue;
      const std::size_t pose = options_.first_scan + scan * options_.scan_stride;
      (is_before ? beyond.before : beyond.after)
          .push_back(poses[pose].world_from_sensor.translation);
    }
  }
  return beyond;
}

Error OpenInputs::empty_extent_error() const {
  const std::filesystem::path& first = inputs_.front().input.path;
  std::string message = "no point of " + first.string();
  if (inputs_.size() > 1) message += " and " + std::to_string(inputs_.size() - 1) + " more inputs";
  message += " is in the extent " +
             box_text(options_.selection.extent->low, options_.selection.extent->high);
  if (is_las(first)) {
    const LasFacts las = read_las_facts(first);
    message += "; the header of " + first.string() + " has the box " +
               box_text(in_steps(las.box_min, las.scale), in_steps(las.box_max, las.scale));
  }
  return {ErrorKind::data, message};
}

namespace {

/// One scan of a file.
struct ScanPart {
  std::uint64_t begin = 0;  ///< its first record
  Vec3d sensor_sum;         ///< of the sensor positions, world coordinates
  std::size_t sensors = 0;  ///< that were measured
};

/// The scans of a file, in the order of its records.
class ScansOfFile {
 public:
  /// Adds the next records; false if they have no scan numbers, or these do not ascend.
  bool add(const CloudPart& part) {
    const std::vector<std::uint32_t>& numbers = part.cloud.scan_indices;
    if (numbers.size() != part.size() || part.world_sensors.size() != part.size()) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i, ++records_) {
      if (scans_.empty() || numbers[i] != last_) {
        if (!scans_.empty() && numbers[i] < last_) {
          is_shuffled_ = true;
          return false;
        }
        scans_.push_back({records_, {}, 0});
        last_ = numbers[i];
      }
      if (!is_measured(part, i)) continue;
      scans_.back().sensor_sum = scans_.back().sensor_sum + part.world_sensors[i];
      ++scans_.back().sensors;
    }
    return true;
  }

  bool is_shuffled() const { return is_shuffled_; }
  std::uint64_t records() const { return records_; }
  /// Records of the longest scan.
  std::uint64_t longest() const {
    std::uint64_t longest = 0;
    for (std::size_t scan = 0; scan < scans_.size(); ++scan)
      longest = std::max(longest, end_of(scan) - scans_[scan].begin);
    return longest;
  }

  /// Pieces of whole scans, each with the path beyond.
  std::vector<InputPiece> pieces(std::size_t input, std::uint64_t max_records) const {
    std::vector<InputPiece> pieces;
    for (std::size_t scan = 0; scan < scans_.size();) {
      const std::size_t first = scan++;
      while (scan < scans_.size() && end_of(scan) - scans_[first].begin <= max_records) ++scan;
      InputPiece piece = {
          input, scans_[first].begin, end_of(scan - 1) - scans_[first].begin, true, {}};
      add_places(0, first, piece.beyond.before);
      add_places(scan, scans_.size(), piece.beyond.after);
      pieces.push_back(std::move(piece));
    }
    return pieces;
  }

 private:
  static bool is_measured(const CloudPart& part, std::size_t i) {
    const std::vector<OriginKind>& kinds = part.cloud.origin_kinds;
    return is_valid_position(part.world_sensors[i]) &&
           (kinds.empty() || kinds[i] == OriginKind::measured);
  }
  std::uint64_t end_of(std::size_t scan) const {
    return scan + 1 < scans_.size() ? scans_[scan + 1].begin : records_;
  }
  void add_places(std::size_t begin, std::size_t end, std::vector<Vec3d>& places) const {
    for (std::size_t k = begin; k < end; ++k)
      if (scans_[k].sensors > 0)
        places.push_back(scans_[k].sensor_sum / static_cast<double>(scans_[k].sensors));
  }

  std::vector<ScanPart> scans_;
  std::uint32_t last_ = 0;
  std::uint64_t records_ = 0;
  bool is_shuffled_ = false;
};

/// Warns that pieces of a file do not have whole scans.
void warn_of_cut_scans(const std::filesystem::path& file, const std::string& why,
                       ProgressSink& progress) {
  progress.warn(
      file.string() + ": " + why +
      "; it is read in parts, so empty beams are not found, and traffic in the driven path "
      "is removed only along the path of each part");
}

/// Pieces of whole scans; none if the file has no scans.
std::vector<InputPiece> pieces_by_scans(const std::filesystem::path& file, std::size_t input,
                                        std::uint64_t all, std::uint64_t records,
                                        const LoadOptions& options, const Executor& executor,
                                        ProgressSink& progress) {
  ScansOfFile scans;
  ProgressSink quiet;  // warnings about the file follow when its points are loaded
  for (std::uint64_t first = 0; first < all; first += records) {
    LoadOptions part = options;
    part.selection.records = RecordSpan{first, records};
    if (scans.add(read_file_part(file, part, quiet, &executor))) continue;
    if (scans.is_shuffled())
      warn_of_cut_scans(file, "its points are not ordered by scan", progress);
    return {};
  }
  if (scans.records() != all) {
    warn_of_cut_scans(file, "some of its records are left out", progress);
    return {};
  }
  if (scans.longest() > 2 * records) {
    warn_of_cut_scans(file,
                      "one of its scans has " + std::to_string(scans.longest()) +
                          " points, more than twice the size of a piece",
                      progress);
    return {};
  }
  return scans.pieces(input, records);
}

}  // namespace

std::vector<InputPiece> file_pieces(const OpenInputs& inputs, std::uint64_t records,
                                    const Executor& executor, ProgressSink& progress) {
  std::vector<InputPiece> pieces;
  for (std::size_t k = 0; k < inputs.inputs().size(); ++k) {
    const CloudInput& input = inputs.inputs()[k].input;
    if (input.is_sequence) throw std::logic_error("file_pieces: a drive");
    const LoadOptions& options = inputs.options();
    const std::optional<std::uint64_t> all = random_access_records(input.path, options.salvage);
    if (!all || *all <= records) {
      pieces.push_back({.input = k});
      continue;
    }
    std::vector<InputPiece> own;
    if (options.selection.is_all())
      own = pieces_by_scans(input.path, k, *all, records, options, executor, progress);
    for (std::uint64_t first = 0; own.empty() && first < *all; first += records)
      pieces.push_back({k, first, records, false, {}});
    std::ranges::move(own, std::back_inserter(pieces));
  }
  return pieces;
}

}  // namespace adasplats
