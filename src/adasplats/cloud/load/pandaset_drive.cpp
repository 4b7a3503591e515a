// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/pandaset_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/load/world_drive.h"
#include "adasplats/cloud/poses/quaternion_order.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/json_table.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/pickle/data_frame.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPandar64 = 0, kPandarGt = 1;  // indices in kPandaSetSensors

Error panda_fault(const fs::path& file, const std::string& what) {
  return {ErrorKind::data, file.string() + ": " + what};
}

const Column& panda_column(const fs::path& file, const Table& table, std::string_view name) {
  const Column* const column = table.find(name);
  if (column == nullptr)
    throw panda_fault(file, "has no column of numbers '" + std::string(name) + "'");
  return *column;
}

/// One frame per pose. Errors: data if one is missing or has no pose.
std::vector<fs::path> frames_of_poses(const fs::path& folder, std::size_t poses,
                                      const fs::path& poses_file) {
  const std::map<std::size_t, fs::path> frames = pandaset_frames(folder);
  const std::string has = poses_file.string() + " has " + std::to_string(poses) + " poses";
  std::vector<fs::path> files;
  for (std::size_t k = 0; k < poses; ++k) {
    const auto found = frames.find(k);
    if (found == frames.end()) {
      const std::string number = std::to_string(k);
      throw panda_fault(folder / (std::string(number.size() < 2 ? 1 : 0, '0') + number + ".pkl.gz"),
                        "this frame is missing; " + has);
    }
    files.push_back(found->second);
  }
  if (frames.size() > poses)
    throw panda_fault(frames.rbegin()->second, "this frame has no pose; " + has);
  return files;
}

/// The poses of the frames at their times.
Trajectory read_panda_poses(const fs::path& lidar) {
  const fs::path poses_file = lidar / "poses.json", times_file = lidar / "timestamps.json";
  const std::vector<double> times_s = pandaset_times(times_file);
  Trajectory poses;
  std::vector<PlacedQuaternion> placed;
  for_each_json_row(poses_file, [&](const JsonRow& row) {
    const JsonRow at = row.object("position"), heading = row.object("heading");
    const RigidTransform pose = {
        row.rotation({heading.real("w"), heading.real("x"), heading.real("y"), heading.real("z")},
                     "heading"),
        {at.real("x"), at.real("y"), at.real("z")}};
    placed.push_back({pose.translation, quaternion_from_rotation(pose.rotation)});
    poses.push_back({poses.size() < times_s.size() ? times_s[poses.size()] : 0, pose});
  });
  if (poses.empty()) throw panda_fault(poses_file, "holds no poses");
  if (poses.size() != times_s.size())
    throw panda_fault(times_file, std::to_string(times_s.size()) + " times, but " +
                                      poses_file.string() + " has " + std::to_string(poses.size()) +
                                      " poses");
  const std::string objection = quaternion_order_problem(placed);
  if (!objection.empty()) throw panda_fault(poses_file, objection);
  return poses;
}

/// The number of each row's LiDAR: 0 (Pandar64) or 1 (PandarGT).
std::vector<std::size_t> sensors_of_rows(const fs::path& file, const Table& table) {
  const Column& sensor = panda_column(file, table, "d");
  std::vector<std::size_t> sensors;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const double number = sensor.as_double(row);
    if (number != 0 && number != 1)
      throw panda_fault(file, "column 'd' of point " + std::to_string(row) + " is " +
                                  exact_text(number) + ", expected 0 (Pandar64) or 1 (PandarGT)");
    sensors.push_back(number == 0 ? kPandar64 : kPandarGt);
  }
  return sensors;
}

/// Reads the points of one LiDAR.
class PandaFrames final : public ScanSource {
 public:
  /// `classes`: the label file of each frame; empty: no labels.
  explicit PandaFrames(std::size_t sensor, std::map<fs::path, fs::path> classes = {},
                       std::optional<IntensityScale> scale = {})
      : sensor_(sensor), classes_(std::move(classes)), scale_(scale) {}

  FileScan read(const fs::path& file) const override {
    const Table table = read_data_frame(file);
    const Column& x = panda_column(file, table, "x");
    const Column& y = panda_column(file, table, "y");
    const Column& z = panda_column(file, table, "z");
    const Column& intensity = panda_column(file, table, "i");
    const Column& time = panda_column(file, table, "t");
    const std::vector<std::size_t> rows = own_rows(file, table);
    FileScan scan;
    scan.left_out = table.rows - rows.size();
    for (const std::size_t row : rows) {
      scan.positions.push_back({x.as_double(row), y.as_double(row), z.as_double(row)});
      scan.times.push_back(time.as_double(row));
      scan.intensities.push_back(static_cast<float>(intensity.as_double(row)));
    }
    if (!classes_.empty()) scan.classes = read_classes(classes_.at(file), rows, table.rows);
    if (scale_) scan.intensities = scale_->scaled(std::move(scan.intensities), file);
    return scan;
  }

 private:
  std::vector<std::size_t> own_rows(const fs::path& file, const Table& table) const {
    const std::vector<std::size_t> sensors = sensors_of_rows(file, table);
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < sensors.size(); ++row)
      if (sensors[row] == sensor_) rows.push_back(row);
    return rows;
  }

  static std::vector<std::uint16_t> read_classes(const fs::path& file,
                                                 const std::vector<std::size_t>& rows,
                                                 std::size_t points) {
    const Table table = read_data_frame(file);
    if (table.rows != points)
      throw panda_fault(
          file, std::to_string(table.rows) + " labels for " + std::to_string(points) + " points");
    const Column& labels = panda_column(file, table, "class");
    std::vector<std::uint16_t> classes;
    for (const std::size_t row : rows) {
      const double id = labels.as_double(row);
      if (!(id >= 0 && id <= 0xffff) || id != std::trunc(id))
        throw panda_fault(file, "the class of point " + std::to_string(row) + " is " +
                                    exact_text(id) + ", expected a whole number from 0 to 65535");
      classes.push_back(static_cast<std::uint16_t>(id));
    }
    return classes;
  }

  std::size_t sensor_;
  std::map<fs::path, fs::path> classes_;
  std::optional<IntensityScale> scale_;
};

std::map<fs::path, fs::path> class_files_of(const DriveInput& drive,
                                            const std::vector<fs::path>& files) {
  std::map<fs::path, fs::path> classes;
  const fs::path folder = drive.folder / "annotations" / "semseg";
  const std::map<std::size_t, fs::path> labels = pandaset_frames(folder);
  if (!drive.with_classes || labels.empty()) return classes;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto found = labels.find(k);
    if (found == labels.end())
      throw panda_fault(folder / files[k].filename(),
                        "the labels of this frame are missing; other frames have labels");
    classes.emplace(files[k], found->second);
  }
  return classes;
}

/// From the frame of the PandarGT (x forward) to that of the Pandar64 (x right, y forward), as in
/// docs/static_extrinsic_calibration.yaml of pandaset-devkit 59be180 (front_gt). There the axes of
/// the Pandar64 are turned by half a turn about z.
RigidTransform pandar64_from_pandargt() {
  return MountSettings{{0.000451, 0.605646, -0.301525}, {90, 0, 0}}.transform();
}

/// Sets the mount of the PandarGT; its description.
std::string mount_pandargt(const DriveInput& drive, WorldFrames& frames, const Executor& executor,
                           ProgressSink& progress) {
  WorldFrames spinning = frames;
  spinning.source = std::make_shared<PandaFrames>(kPandar64);
  const std::optional<Recognition> pandar64 = recognize_in_world(spinning, executor, progress);
  if (!pandar64)
    progress.warn(drive.folder.string() +
                  ": the Pandar64 is not recognised, so the poses are assumed to be its own, and "
                  "the mount of the PandarGT is relative to them; if they are not, give `mount`");
  frames.own_mount = pandar64_from_pandargt();
  if (pandar64) frames.own_mount = pandar64->vehicle_from_sensor * *frames.own_mount;
  frames.is_stated = true;
  const Vec3d at = frames.own_mount->translation;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "pandargt at %.3f, %.3f, %.3f m in the trajectory's frame (mounted on %s as "
                "PandaSet's devkit publishes, each point at its own time)",
                at.x, at.y, at.z,
                pandar64 ? pandar64->cones.sensor.c_str() : "a Pandar64 at the poses");
  return text.data();
}

/// The LiDAR that `topic` names, or else the Pandar64.
std::size_t sensor_of(const DriveInput& drive) {
  return drive.topic == kPandaSetSensors[kPandarGt] ? kPandarGt : kPandar64;
}

/// Scans of a LiDAR without classes, and its mount on the vehicle unless it is to be recognised.
WorldFrames world_frames_of(const DriveInput& drive, std::size_t sensor) {
  const fs::path lidar = drive.folder / "lidar";
  WorldFrames frames;
  frames.poses_file = lidar / "poses.json";
  frames.vehicle = read_panda_poses(lidar);
  frames.files = frames_of_poses(lidar, frames.vehicle.size(), frames.poses_file);
  for (const TimedPose& pose : frames.vehicle) frames.stamps_s.push_back(pose.time_s);
  // The poses are at one end of the Pandar64's sweeps; the PandarGT begins half a sweep earlier.
  constexpr double kSweep_s = 0.1;
  for (std::size_t sweep = 0; sweep <= sensor; ++sweep)
    frames.vehicle = with_extrapolated_ends(std::move(frames.vehicle), kSweep_s);
  for (TimedPose& pose : frames.vehicle) pose.time_s -= drive.time_offset_s.value_or(0);
  frames.is_stated = drive.given_mount().has_value();
  frames.others =
      sensor == kPandar64 ? "points of the PandarGT (d = 1)" : "points of the Pandar64 (d = 0)";
  frames.own_mount = drive.given_mount().value_or(MountSettings{}).transform();
  return frames;
}

}  // namespace

std::map<std::size_t, fs::path> pandaset_frames(const fs::path& folder) {
  std::map<std::size_t, fs::path> frames;
  for (const char* extension : {".gz", ".pkl"}) {
    for (const fs::path& file : files_by_name(folder, extension)) {
      const bool is_packed = file.extension() == ".gz";
      if (is_packed && file.stem().extension() != ".pkl") continue;
      const auto number = number_in_name(is_packed ? file.stem() : file.filename());
      if (!number) continue;
      const auto [twin, is_new] = frames.emplace(*number, file);
      if (!is_new) throw panda_fault(file, "has the same frame number as " + twin->second.string());
    }
  }
  return frames;
}

std::vector<double> pandaset_times(const fs::path& file) {
  std::vector<double> times_s;
  for_each_json_row(file, [&](const JsonRow& row) {
    if (!times_s.empty() && !(row.real() > times_s.back()))
      throw row.fault("the time is not after the previous one");
    times_s.push_back(row.real());
  });
  return times_s;
}

bool is_pandaset_rig(const fs::path& folder) {
  constexpr std::ptrdiff_t kMinPoints = 1000;
  const std::map<std::size_t, fs::path> frames = pandaset_frames(folder / "lidar");
  if (frames.empty()) return false;
  for (const std::size_t k : {std::size_t{0}, frames.size() / 2, frames.size() - 1}) {
    const fs::path& file = std::next(frames.begin(), static_cast<std::ptrdiff_t>(k))->second;
    const std::vector<std::size_t> sensors = sensors_of_rows(file, read_data_frame(file));
    for (const std::size_t sensor : {kPandar64, kPandarGt})
      if (std::ranges::count(sensors, sensor) < kMinPoints) return false;
  }
  return true;
}

bool is_pandaset_sequence(const fs::path& folder) {
  std::error_code ignored;  // an unreadable folder is not a sequence
  return std::ranges::any_of(
      std::initializer_list<const char*>{"poses.json", "timestamps.json", "00.pkl.gz"},
      [&](const char* name) { return fs::is_regular_file(folder / "lidar" / name, ignored); });
}

ClassNames pandaset_class_names(const fs::path& folder) {
  const fs::path file = folder / "annotations" / "semseg" / "classes.json";
  ClassNames names;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return names;
  for_each_json_text(file, [&](const std::string& key, const std::string& name) {
    const auto id = parse_number<std::uint16_t>(key);
    if (!id) throw panda_fault(file, "'" + key + "' is not a class number");
    names.emplace_back(*id, name);
  });
  return names;
}

KittiSequence open_pandaset_drive(const DriveInput& drive, const Executor& executor,
                                  ProgressSink& progress) {
  const std::size_t sensor = sensor_of(drive);
  WorldFrames frames = world_frames_of(drive, sensor);
  std::string mounted;
  if (sensor == kPandarGt && !frames.is_stated)
    mounted = mount_pandargt(drive, frames, executor, progress);

  std::map<fs::path, fs::path> classes = class_files_of(drive, frames.files);
  const bool has_classes = !classes.empty();
  const IntensityScale scale = scale_of_scans(PandaFrames(sensor), frames.files);
  frames.source = std::make_shared<PandaFrames>(sensor, std::move(classes), scale);
  auto sequence = open_world_frames(drive, frames, executor, progress);
  if (!mounted.empty()) sequence->beams.recognised = mounted;
  if (!drive.topic.empty()) sequence->facts.left_out.clear();  // as chosen
  sequence->facts.points_in = "world (as PandaSet has them)";
  sequence->facts.intensities = scale.description();
  sequence->facts.labels = has_classes ? "of all scans" : "none";
  report_drive(*sequence, progress);
  return std::move(*sequence);
}

}  // namespace adasplats
