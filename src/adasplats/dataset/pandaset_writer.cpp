// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/pandaset_writer.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/oxts_records.h"
#include "adasplats/dataset/pandaset_frames.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/tree_names.h"
#include "adasplats/dataset/writer_with_poses.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

using PandaJson = nlohmann::ordered_json;

constexpr const char* kPandaSequence = "001/";

PandaJson pose_json(const RigidTransform& world_from_sensor) {
  const RigidTransform pose = world_from_sensor * kSensorFromRightForward;
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  const Vec3d t = pose.translation;
  return {{"position", {{"x", t.x}, {"y", t.y}, {"z", t.z}}},
          {"heading", {{"w", q.w}, {"x", q.x}, {"y", q.y}, {"z", q.z}}}};
}

class PandaSetWriter final : public WriterWithPoses {
 public:
  PandaSetWriter(const std::filesystem::path& folder, const ScanWriterOptions& options)
      : WriterWithPoses(folder), options_(options) {
    constexpr std::size_t kMinDigits = 2;
    const std::size_t last = std::max<std::size_t>(options.drive.times_s.size(), 1) - 1;
    digits_ = std::max(kMinDigits, std::to_string(last).size());
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    encoded.has_classes = !scan.classes.empty();
    std::vector<std::uint32_t> order(scan.size());
    std::iota(order.begin(), order.end(), 0U);
    if (options_.order != PointOrder::firing) order = driver_order(scan, FirstRing::top);
    if (encoded.has_classes)
      encoded.files.push_back({class_file(index), pandaset_classes(scan, order)});
    if (options_.boxes)
      encoded.files.push_back(
          {kPandaSequence + ("annotations/cuboids/" + name(index)),
           pandaset_cuboids(boxes_with_points(options_.boxes, index, scan, options_.labels))});
    encoded.files.push_back({main_file(index), pandaset_points(scan, order)});
    return encoded;
  }
  void append(std::size_t index, const EncodedScan& scan) override {
    if (scan.has_classes) with_classes_.insert(index);
    WriterWithPoses::append(index, scan);
  }
  void keep(std::size_t index, const TimedPose& pose) override {
    if (std::filesystem::exists(folder() / class_file(index))) with_classes_.insert(index);
    WriterWithPoses::keep(index, pose);
  }
  std::string main_file(std::size_t index) const override {
    return kPandaSequence + ("lidar/" + name(index));
  }
  void finish() override {
    PandaJson poses = PandaJson::array(), times = poses, places = poses;
    const OxtsRecords records(trajectory());
    for (std::size_t i = 0; i < trajectory().size(); ++i) {
      poses.push_back(pose_json(trajectory()[i].world_from_sensor));
      times.push_back(trajectory()[i].time_s);
      const OxtsPlace place = records.place(i);
      places.push_back({{"lat", place.latitude_deg},
                        {"long", place.longitude_deg},
                        {"height", place.altitude_m},
                        {"xvel", place.velocity_m_s.x},
                        {"yvel", place.velocity_m_s.y}});
    }
    put("lidar/poses.json", poses);
    put("lidar/timestamps.json", times);
    put("meta/gps.json", places);
    put("meta/timestamps.json", times);
    if (!with_classes_.empty()) finish_classes();
    WriterWithPoses::finish();
  }

 private:
  std::string name(std::size_t index) const { return padded_number(index, digits_) + ".pkl.gz"; }
  std::string class_file(std::size_t index) const {
    return kPandaSequence + ("annotations/semseg/" + name(index));
  }
  void put(const std::string& file, const PandaJson& json) const {
    const std::filesystem::path path = folder() / kPandaSequence / file;
    create_folder(path.parent_path());
    write_file(path, json.dump());
  }
  void finish_classes() const {
    // Readers expect the n-th file to be the n-th scan, so scans without returns need one, too.
    for (std::size_t i = 0; i < trajectory().size(); ++i)
      if (!with_classes_.contains(i))
        write_file(folder() / class_file(i), pandaset_classes(ScanView(), {}));
    PandaJson names = PandaJson::object();
    if (options_.labels != nullptr)
      for (const SemanticClass& known : options_.labels->classes())
        names[std::to_string(known.id)] = known.name;
    put("annotations/semseg/classes.json", names);
  }

  ScanWriterOptions options_;
  std::size_t digits_ = 2;
  std::set<std::size_t> with_classes_;  ///< scans
};

}  // namespace

std::unique_ptr<ScanWriter> make_pandaset_writer(const std::filesystem::path& folder,
                                                 const ScanWriterOptions& options) {
  return std::make_unique<PandaSetWriter>(folder, options);
}

}  // namespace adasplats
