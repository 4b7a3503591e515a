// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "adasplats/cloud/load/box_collector.h"
#include "adasplats/cloud/load/box_files.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Scans by the numbers in their names.
std::map<std::size_t, TimedPose> scans_by_number(const fs::path& file, const BoxDrive& drive) {
  std::map<std::size_t, TimedPose> scans;
  for (std::size_t k = 0; k < drive.scans.size() && k < drive.poses.size(); ++k) {
    if (drive.scans[k].extension() == ".txt")
      throw Error(ErrorKind::data, file.string() +
                                       ": tracklets number the scans of a synchronised drive "
                                       "(_sync, .bin), but the scans are " +
                                       drive.scans[k].string());
    if (const auto number = number_in_name(drive.scans[k])) scans.emplace(*number, drive.poses[k]);
  }
  if (scans.empty())
    throw Error(ErrorKind::data,
                file.string() +
                    ": tracklets are in the sensor frame of numbered scans; read them with the "
                    "KITTI raw drive that they belong to");
  return scans;
}

/// Reads the tracklets of a file.
class TrackletReader {
 public:
  TrackletReader(const fs::path& file, const BoxDrive& drive)
      : file_(file), text_(read_file(file)), scans_(scans_by_number(file, drive)), boxes_(file) {}

  BoxContent read() {
    const pugi::xml_parse_result parsed =
        document_.load_buffer(text_.data(), text_.size(),
                              pugi::parse_default | pugi::parse_trim_pcdata, pugi::encoding_utf8);
    if (!parsed)
      throw Error(ErrorKind::data, file_.string() + ":" + line_at(parsed.offset) +
                                       ": no well-formed XML: " + parsed.description());
    const pugi::xml_node tracklets = document_.child("boost_serialization").child("tracklets");
    if (!tracklets)
      throw Error(ErrorKind::data, file_.string() +
                                       ": has no <tracklets> in <boost_serialization>, expected "
                                       "tracklet_labels.xml of a KITTI raw drive");
    require_count(tracklets);
    for (const pugi::xml_node item : tracklets.children("item")) read_tracklet(item);
    return boxes_.take(true);
  }

 private:
  std::string line_at(std::ptrdiff_t offset) const {
    const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
    return std::to_string(1 + std::count(text_.begin(), end, '\n'));
  }
  std::string place_of(const pugi::xml_node& node) const {
    return file_.string() + ":" + line_at(node.offset_debug()) + ": tracklet " +
           std::to_string(tracklet_) + ": ";
  }
  Error fault(const pugi::xml_node& node, const std::string& what) const {
    return {ErrorKind::data, place_of(node) + what};
  }

  double number(const pugi::xml_node& node, const char* name) const {
    const std::string_view text = node.child(name).text().get();
    const auto value = parse_number<double>(text);
    if (value && std::isfinite(*value)) return *value;
    throw fault(node,
                "<" + std::string(name) + "> is " + shown(text) + ", expected a finite number");
  }

  /// A damaged file may lack the last items.
  void require_count(const pugi::xml_node& list) const {
    const auto all = list.children("item");
    const auto items = static_cast<double>(std::distance(all.begin(), all.end()));
    const double count = number(list, "count");
    if (count != items)
      throw fault(list, "<count> is " + exact_text(count) + ", but <" + list.name() + "> has " +
                            exact_text(items) + " items");
  }

  std::size_t first_frame(const pugi::xml_node& tracklet) const {
    const std::string_view text = tracklet.child("first_frame").text().get();
    const auto frame = parse_number<std::uint32_t>(text);
    if (!frame)
      throw fault(tracklet, "<first_frame> is " + shown(text) + ", expected a number from 0");
    return *frame;
  }

  void read_tracklet(const pugi::xml_node& tracklet) {
    ++tracklet_;
    const Vec3d size = {number(tracklet, "l"), number(tracklet, "w"), number(tracklet, "h")};
    const std::string label = tracklet.child("objectType").text().get();
    const pugi::xml_node poses = tracklet.child("poses");
    if (!poses) throw fault(tracklet, "has no <poses>");
    require_count(poses);
    std::size_t frame = first_frame(tracklet);
    for (const pugi::xml_node pose : poses.children("item"))
      add_box(pose, frame++, 0.5 * size, label);
  }

  void add_box(const pugi::xml_node& pose, std::size_t frame, Vec3d half_size,
               const std::string& label) {
    // Some scans of KITTI's drives are missing.
    if (frame < scans_.begin()->first || frame > scans_.rbegin()->first)
      throw fault(pose, "is in frame " + std::to_string(frame) + ", but the drive has the scans " +
                            std::to_string(scans_.begin()->first) + " to " +
                            std::to_string(scans_.rbegin()->first));
    const RigidTransform scan_from_foot = {
        rotation_from_yaw_pitch_roll(number(pose, "rz"), number(pose, "ry"), number(pose, "rx")),
        {number(pose, "tx"), number(pose, "ty"), number(pose, "tz")}};
    const auto scan = scans_.find(frame);
    if (scan == scans_.end()) return;
    const RigidTransform foot = scan->second.world_from_sensor * scan_from_foot;
    boxes_.add(tracklet_, label,
               {scan->second.time_s, foot * Vec3d{0, 0, half_size.z}, half_size,
                yaw_of_box(foot.rotation)},
               {}, [&] { return place_of(pose); });
  }

  fs::path file_;
  std::string text_;
  std::map<std::size_t, TimedPose> scans_;
  BoxCollector boxes_;
  pugi::xml_document document_;
  std::uint64_t tracklet_ = 0;  ///< from 1
};

}  // namespace

BoxContent read_kitti_tracklets(const fs::path& file, const BoxDrive& drive) {
  return TrackletReader(file, drive).read();
}

}  // namespace adasplats
