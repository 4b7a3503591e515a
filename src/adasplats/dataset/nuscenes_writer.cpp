// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/nuscenes_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/nuscenes_categories.h"
#include "adasplats/dataset/nuscenes_tables.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/writer_with_poses.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "nuScenes' files are little-endian");

using NuscenesPoint = std::array<float, 5>;

/// Number of scans per sample: nuScenes has two samples per second.
std::size_t sample_step(const DriveSpan& drive) {
  constexpr double kSample_s = 0.5;
  if (!(drive.apart_s() > kSample_s / 1e6)) return 1;
  return static_cast<std::size_t>(std::max(1L, std::lround(kSample_s / drive.apart_s())));
}

std::string nuscenes_points(const ScanView& scan, std::span<const std::uint32_t> order,
                            std::size_t rings) {
  std::string bytes(order.size() * sizeof(NuscenesPoint), '\0');
  char* to = bytes.data();
  for (const std::uint32_t i : order) {
    const Vec3f p = scan.positions[i];
    const float measured = scan.intensities.empty() ? 0.0F : scan.intensities[i];
    const std::size_t ring = scan.rings.empty() ? 0 : scan.rings[i];
    // Our rings are numbered from the top.
    const std::size_t from_below = ring < rings ? rings - 1 - ring : ring;
    const NuscenesPoint point = {-p.y, p.x, p.z, std::isnan(measured) ? 0.0F : measured,
                                 static_cast<float>(from_below)};
    std::memcpy(to, point.data(), sizeof(point));
    to += sizeof(point);
  }
  return bytes;
}

/// Reads the points of a written file, in our axes.
std::vector<Vec3f> points_of_file(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  std::vector<Vec3f> points(bytes.size() / sizeof(NuscenesPoint));
  for (std::size_t i = 0; i < points.size(); ++i) {
    NuscenesPoint point;
    std::memcpy(point.data(), bytes.data() + i * sizeof(point), sizeof(point));
    points[i] = {point[1], -point[0], point[2]};
  }
  return points;
}

class NuscenesWriter final : public WriterWithPoses {
 public:
  NuscenesWriter(const std::filesystem::path& folder, const ScanWriterOptions& options)
      : WriterWithPoses(folder), options_(options), step_(sample_step(options.drive)) {
    if (options_.labels == nullptr) return;
    for (const SemanticClass& known : options_.labels->classes()) {
      if (categories_.size() <= known.id) categories_.resize(known.id + std::size_t{1});
      categories_[known.id] = nuscenes_category(known.name);
    }
  }

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    encoded.has_classes = is_sample(index) && !categories_.empty() && !scan.classes.empty();
    std::vector<std::uint32_t> order(scan.size());
    std::iota(order.begin(), order.end(), 0U);
    if (options_.order != PointOrder::firing) order = driver_order(scan, FirstRing::bottom);
    if (encoded.has_classes)
      encoded.files.push_back({class_file(index), categories_of(scan, order)});
    encoded.files.push_back(
        {main_file(index), nuscenes_points(scan, order, options_.image_size.rings)});
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
    return (is_sample(index) ? "samples/LIDAR_TOP/" : "sweeps/LIDAR_TOP/") + scan_name(index) +
           ".pcd.bin";
  }
  void finish() override {
    std::vector<NuscenesFrame> frames;
    for (std::size_t i = 0; i < trajectory().size(); ++i) frames.push_back(frame(i));
    create_folder(folder() / "maps");
    constexpr std::array<std::uint8_t, 3> kBlack = {};
    write_png(folder() / kNuscenesMap, 1, 1, kBlack);
    write_nuscenes_tables(folder(), frames, options_.labels);
    WriterWithPoses::finish();
  }

 private:
  bool is_sample(std::size_t index) const { return index % step_ == 0; }

  static std::string class_file(std::size_t index) {
    return std::string("lidarseg/") + kNuscenesVersion + "/" + scan_name(index) + "_lidarseg.bin";
  }

  std::string categories_of(const ScanView& scan, std::span<const std::uint32_t> order) const {
    std::string bytes;
    for (const std::uint32_t i : order) {
      const std::uint16_t id = scan.classes[i];
      bytes += static_cast<char>(id < categories_.size() ? categories_[id] : 0);
    }
    return bytes;
  }

  NuscenesFrame frame(std::size_t index) const {
    const TimedPose& pose = trajectory()[index];
    NuscenesFrame frame{pose, main_file(index), "", is_sample(index), {}};
    if (!frame.is_key) return frame;
    if (!with_classes_.empty()) {
      frame.classes_file = class_file(index);
      // Every sample needs one, even without returns.
      if (!with_classes_.contains(index)) write_file(folder() / frame.classes_file, "");
    }
    if (!options_.boxes) return frame;
    Scan scan;  // an interrupted run left only the file
    scan.positions = points_of_file(folder() / frame.points_file);
    scan.time_s = pose.time_s;
    scan.world_from_sensor = pose.world_from_sensor;
    frame.boxes = boxes_with_points(options_.boxes, index, scan, options_.labels);
    return frame;
  }

  ScanWriterOptions options_;
  std::size_t step_;
  std::vector<std::uint8_t> categories_;  ///< by class
  std::set<std::size_t> with_classes_;    ///< scans
};

}  // namespace

std::unique_ptr<ScanWriter> make_nuscenes_writer(const std::filesystem::path& folder,
                                                 const ScanWriterOptions& options) {
  return std::make_unique<NuscenesWriter>(folder, options);
}

}  // namespace adasplats
