// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/av2_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/av2_drive.h"
#include "adasplats/cloud/load/av2_tables.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/tree_boxes.h"
#include "adasplats/dataset/tree_names.h"
#include "adasplats/dataset/writer_with_poses.h"
#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/arrow/arrow_writer.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::string_view kAv2Log = "00000000-0000-0000-0000-000000000001";
/// Position of up_lidar on the cars of Argoverse 2, without its tilt.
constexpr RigidTransform kAv2VehicleFromLidar = {{}, {1.35, 0, 1.64}};
constexpr std::size_t kMaxLasers = 256;

/// A word in the name of a class and its category; the first match counts.
constexpr std::pair<std::string_view, std::string_view> kAv2Categories[] = {
    {"motorcyclist", "MOTORCYCLIST"},
    {"motorcycl", "MOTORCYCLE"},
    {"bicyclist", "BICYCLIST"},
    {"rider", "BICYCLIST"},
    {"bicycl", "BICYCLE"},
    {"bus", "BUS"},
    {"rails", "RAILED_VEHICLE"},
    {"tram", "RAILED_VEHICLE"},
    {"trailer", "VEHICULAR_TRAILER"},
    {"truck", "TRUCK"},
    {"other-vehicle", "LARGE_VEHICLE"},
    {"person", "PEDESTRIAN"},
    {"pedestrian", "PEDESTRIAN"},
    {"car", "REGULAR_VEHICLE"},
    {"vehicle", "REGULAR_VEHICLE"},
    {"animal", "ANIMAL"},
    {"sign", "SIGN"}};

std::string category_of(const LabelScheme* labels, std::uint16_t class_id) {
  const SemanticClass* const known = labels == nullptr ? nullptr : labels->find(class_id);
  if (known != nullptr)
    for (const auto& [word, category] : kAv2Categories)
      if (lower_case(known->name).find(word) != std::string::npos) return std::string(category);
  return "UNKNOWN";
}

/// The times of the scans in nanoseconds. Errors: data.
std::vector<std::int64_t> stamps_of(const std::vector<double>& times_s) {
  constexpr double kEnd_s = 9.2e9;  // the year 2261: nanoseconds have 63 bits
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::vector<std::int64_t> stamps_ns;
  std::map<std::int64_t, std::size_t> scan_at;
  stamps_ns.reserve(times_s.size());
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const std::string scan = "argoverse2: the time of scan " + std::to_string(i) + " (from 0), " +
                             exact_text(times_s[i]) + " s, ";
    if (!(times_s[i] >= 0 && times_s[i] < kEnd_s))
      throw Error(ErrorKind::data,
                  scan + "is not between 0 and 9.2e9 s, which its nanoseconds can express");
    const double whole_s = std::floor(times_s[i]);
    stamps_ns.push_back(kSecond_ns * static_cast<std::int64_t>(whole_s) +
                        std::llround((times_s[i] - whole_s) * 1e9));
    const auto [other, is_new] = scan_at.emplace(stamps_ns.back(), i);
    if (!is_new)
      throw Error(ErrorKind::data, scan + "is that of scan " + std::to_string(other->second) +
                                       ", too; its files are named by the nanosecond");
  }
  return stamps_ns;
}

/// The columns of poses in tables.
struct Av2PoseColumns {
  std::vector<double> qw, qx, qy, qz, x, y, z;

  void add(const RigidTransform& pose) {
    const Quaternion q = quaternion_from_rotation(pose.rotation);
    for (const auto& [values, value] :
         {std::pair(&qw, q.w), std::pair(&qx, q.x), std::pair(&qy, q.y), std::pair(&qz, q.z),
          std::pair(&x, pose.translation.x), std::pair(&y, pose.translation.y),
          std::pair(&z, pose.translation.z)})
      values->push_back(value);
  }
  void move_to(Table& table) {
    table.rows = x.size();
    for (auto& [name, values] :
         {std::pair("qw", &qw), std::pair("qx", &qx), std::pair("qy", &qy), std::pair("qz", &qz),
          std::pair("tx_m", &x), std::pair("ty_m", &y), std::pair("tz_m", &z)})
      table.columns.push_back({name, std::move(*values)});
  }
};

/// The columns of annotations.
struct Av2BoxColumns {
  std::vector<std::int64_t> stamps_ns, points;
  std::vector<std::string> tracks, categories;
  std::vector<double> length, width, height;
  Av2PoseColumns vehicle_from_box;

  void add(const TreeBox& box, std::string category, const TimedPose& vehicle,
           std::int64_t stamp_ns) {
    stamps_ns.push_back(stamp_ns);
    tracks.push_back(uuid_of("object " + std::to_string(box.box.instance)));
    categories.push_back(std::move(category));
    length.push_back(box.box.size_m.x);
    width.push_back(box.box.size_m.y);
    height.push_back(box.box.size_m.z);
    vehicle_from_box.add(vehicle.world_from_sensor.inverse() * box.box.world_from_box);
    points.push_back(static_cast<std::int64_t>(box.points));
  }
  ArrowTable take() {
    ArrowTable table;
    table.texts = {{"track_uuid", std::move(tracks)}, {"category", std::move(categories)}};
    table.numbers.columns = {{"timestamp_ns", std::move(stamps_ns)},
                             {"length_m", std::move(length)},
                             {"width_m", std::move(width)},
                             {"height_m", std::move(height)}};
    vehicle_from_box.move_to(table.numbers);
    table.numbers.columns.push_back({"num_interior_pts", std::move(points)});
    return table;
  }
};

/// Reads the points of a written sweep.
std::vector<Vec3f> points_of_sweep(const std::filesystem::path& file) {
  const ArrowTable table = read_arrow_file(file);
  const Column& x = av2_column(file, table, "x");
  const Column& y = av2_column(file, table, "y");
  const Column& z = av2_column(file, table, "z");
  std::vector<Vec3f> points;
  points.reserve(table.numbers.rows);
  for (std::size_t i = 0; i < table.numbers.rows; ++i)
    points.push_back(vec_cast<float>(Vec3d{x.as_double(i), y.as_double(i), z.as_double(i)}));
  return points;
}

class Av2Writer final : public WriterWithPoses {
 public:
  Av2Writer(const std::filesystem::path& folder, const ScanWriterOptions& options)
      : WriterWithPoses(folder),
        options_(options),
        log_("train/" + std::string(kAv2Log) + "/"),
        stamps_ns_(stamps_of(options.drive.times_s)) {
    if (options.image_size.rings > kMaxLasers)
      throw Error(ErrorKind::usage, "argoverse2: the sensor has " +
                                        std::to_string(options.image_size.rings) +
                                        " rings, but laser_number has 8 bits; use another format");
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    encoded.files.push_back({main_file(index), arrow_file_bytes(sweep_of(index, scan))});
    return encoded;
  }
  std::string main_file(std::size_t index) const override {
    return log_ + "sensors/lidar/" + std::to_string(stamps_ns_.at(index)) + ".feather";
  }
  void finish() override {
    const Trajectory vehicle = mounted(trajectory(), kAv2VehicleFromLidar.inverse());
    std::vector<std::size_t> by_time(vehicle.size());
    std::iota(by_time.begin(), by_time.end(), std::size_t{0});
    std::ranges::sort(by_time, {}, [this](std::size_t i) { return stamps_ns_[i]; });
    std::vector<std::int64_t> stamps_ns;
    Av2PoseColumns city_from_vehicle;
    for (const std::size_t i : by_time) {
      stamps_ns.push_back(stamps_ns_[i]);
      city_from_vehicle.add(vehicle[i].world_from_sensor);
    }
    ArrowTable poses;
    poses.numbers.columns.push_back({"timestamp_ns", std::move(stamps_ns)});
    city_from_vehicle.move_to(poses.numbers);
    put("city_SE3_egovehicle.feather", arrow_file_bytes(poses));
    put("calibration/egovehicle_SE3_sensor.feather", arrow_file_bytes(mounts()));
    put_map(vehicle.empty() ? Vec3d{} : vehicle.front().world_from_sensor.translation);
    if (options_.boxes) put("annotations.feather", arrow_file_bytes(annotations(vehicle, by_time)));
    WriterWithPoses::finish();
  }

 private:
  ArrowTable sweep_of(std::size_t index, const ScanView& scan) const {
    std::vector<std::uint32_t> order(scan.size());
    std::iota(order.begin(), order.end(), 0U);
    if (options_.order != PointOrder::firing) order = driver_order(scan, FirstRing::top);
    const RigidTransform vehicle_from_world =
        (scan.world_from_sensor * kAv2VehicleFromLidar.inverse()).inverse();
    const std::vector<float> times_s = times_from_pose(scan);
    std::vector<float> x, y, z;
    std::vector<std::uint8_t> intensities, lasers;
    std::vector<std::int32_t> offsets_ns;
    for (const std::uint32_t i : order) {
      const Vec3f p = vec_cast<float>(vehicle_from_world * world_point_of(scan, i));
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
      const double share =
          scan.intensities.empty() ? 0 : double{scan.intensities[i]} / options_.full_intensity;
      intensities.push_back(static_cast<std::uint8_t>(
          std::isnan(share) ? 0 : std::lround(255 * std::clamp(share, 0.0, 1.0))));
      lasers.push_back(static_cast<std::uint8_t>(scan.rings.empty() ? 0 : scan.rings[i]));
      const double offset_s = times_s.empty() ? 0 : double{times_s[i]};
      if (!(std::fabs(offset_s) <= kAv2MaxOffset_s))
        throw Error(ErrorKind::data,
                    main_file(index) + ": a point is " + exact_text(offset_s) +
                        " s from the time of its scan, argoverse2 has at most 1 s");
      offsets_ns.push_back(static_cast<std::int32_t>(std::lround(offset_s / kNanosecond_s)));
    }
    ArrowTable table;
    table.numbers.rows = order.size();
    table.numbers.columns = {{"x", std::move(x)},
                             {"y", std::move(y)},
                             {"z", std::move(z)},
                             {"intensity", std::move(intensities)},
                             {"laser_number", std::move(lasers)},
                             {"offset_ns", std::move(offsets_ns)}};
    return table;
  }

  static ArrowTable mounts() {
    ArrowTable table;
    Av2PoseColumns vehicle_from_sensor;
    for (const std::string_view name : kAv2Sensors) {
      table.texts["sensor_name"].emplace_back(name);
      vehicle_from_sensor.add(kAv2VehicleFromLidar);
    }
    vehicle_from_sensor.move_to(table.numbers);
    return table;
  }

  ArrowTable annotations(const Trajectory& vehicle, std::span<const std::size_t> scans) const {
    Av2BoxColumns columns;
    for (const std::size_t i : scans) {
      Scan scan;  // an interrupted run left only the file
      scan.positions = points_of_sweep(folder() / main_file(i));
      scan.time_s = vehicle[i].time_s;
      scan.world_from_sensor = vehicle[i].world_from_sensor;
      for (const TreeBox& box : boxes_with_points(options_.boxes, i, scan, options_.labels))
        columns.add(box, category_of(options_.labels, box.box.class_id), vehicle[i], stamps_ns_[i]);
    }
    return columns.take();
  }

  /// A map without content: a drivable area without extent, unknown heights.
  void put_map(Vec3d at) const {
    using Av2Json = nlohmann::ordered_json;
    const Av2Json corner = {{"x", at.x}, {"y", at.y}, {"z", at.z}};
    const Av2Json area = {{"id", 1}, {"area_boundary", {corner, corner, corner}}};
    const std::string log(kAv2Log);
    put("map/log_map_archive_" + log + "____NONE_city_0.json",
        Av2Json({{"drivable_areas", {{"1", area}}},
                 {"lane_segments", Av2Json::object()},
                 {"pedestrian_crossings", Av2Json::object()}})
            .dump());
    put("map/" + log + "___img_Sim2_city.json",
        Av2Json({{"R", {1.0, 0.0, 0.0, 1.0}}, {"t", {-at.x, -at.y}}, {"s", 1.0}}).dump());
    const float unknown = std::nanf("");
    write_npy(folder() / log_ / ("map/" + log + "_ground_height_surface____NONE.npy"),
              {&unknown, 1}, 1, 1);
  }

  void put(const std::string& file, std::string_view bytes) const {
    const std::filesystem::path path = folder() / log_ / file;
    create_folder(path.parent_path());
    write_file(path, bytes);
  }

  ScanWriterOptions options_;
  std::string log_;
  std::vector<std::int64_t> stamps_ns_;  ///< of the scans
};

}  // namespace

std::unique_ptr<ScanWriter> make_av2_writer(const std::filesystem::path& folder,
                                            const ScanWriterOptions& options) {
  return std::make_unique<Av2Writer>(folder, options);
}

}  // namespace adasplats
