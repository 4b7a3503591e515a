// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_writer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adasplats/core/words.h"
#include "adasplats/dataset/av2_writer.h"
#include "adasplats/dataset/kitti_raw_writer.h"
#include "adasplats/dataset/mcap_writer.h"
#include "adasplats/dataset/nuscenes_writer.h"
#include "adasplats/dataset/packet_writer.h"
#include "adasplats/dataset/pandaset_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/dataset/writer_with_poses.h"

namespace adasplats {
namespace {

class SequenceWriter final : public ScanWriter {
 public:
  SequenceWriter(const std::filesystem::path& folder, const std::string& name, PointOrder order)
      : ScanWriter(folder),
        sequence_("sequences/" + name + "/"),
        order_(order),
        writer_(folder / sequence_, folder / "poses" / (name + ".txt")) {}

  EncodedScan encode(std::size_t index, const ScanView& scan) const override {
    EncodedScan encoded = order_ == PointOrder::firing
                              ? SemanticKittiWriter::encode(index, scan)
                              : SemanticKittiWriter::encode(index, scan, kitti_order(scan));
    for (EncodedFile& file : encoded.files) file.name = sequence_ + file.name;
    return encoded;
  }
  void append(std::size_t index, const EncodedScan& scan) override {
    writer_.note_written(index, scan);
  }
  std::string main_file(std::size_t index) const override {
    return sequence_ + "velodyne/" + scan_name(index) + ".bin";
  }
  void keep(std::size_t index, const TimedPose& pose) override { writer_.keep_scan(index, pose); }
  void finish() override { writer_.finish(); }

 private:
  std::string sequence_;
  PointOrder order_;
  SemanticKittiWriter writer_;
};

/// A scan with its velocities, if they are wanted.
class WithVelocities {
 public:
  WithVelocities(const ScanView& scan, std::size_t index, const VelocitiesOfScan& velocities)
      : scan_(scan) {
    if (velocities) velocities_ = velocities(index, scan);
    scan_.velocities = velocities_;
  }
  WithVelocities(const WithVelocities&) = delete;
  WithVelocities& operator=(const WithVelocities&) = delete;
  const ScanView& scan() const { return scan_; }

 private:
  ScanView scan_;
  std::vector<Vec3f> velocities_;
};

/// Separate files for every scan.
class FileWriter final : public WriterWithPoses {
 public:
  FileWriter(std::filesystem::path folder, ScanFormat format, const ScanWriterOptions& options)
      : WriterWithPoses(std::move(folder)), format_(format), options_(options) {}

  EncodedScan encode(std::size_t index, const ScanView& given) const override {
    const WithVelocities with(given, index, options_.velocities);
    const ScanView& scan = with.scan();
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    const std::string stem = scan_name(index);
    encoded.files =
        format_ == ScanFormat::range_image
            ? encode_range_image(stem, range_image(scan, options_.image_size), options_.labels)
            : encode_scan_files(format_, stem, scan, options_.full_intensity);
    // encode_scan_files() returns the main file first.
    std::rotate(encoded.files.begin(), encoded.files.begin() + 1, encoded.files.end());
    return encoded;
  }
  std::string main_file(std::size_t index) const override {
    const std::string stem = scan_name(index);
    if (format_ == ScanFormat::range_image) return stem + "_range.npy";
    return stem + "." + std::string(word_of(format_, kScanFormats));
  }

 private:
  ScanFormat format_;
  ScanWriterOptions options_;
};

/// Writes all scans as messages of one file.
class MessageWriter final : public WriterWithPoses {
 public:
  MessageWriter(std::filesystem::path folder, double later_s, const ScanWriterOptions& options)
      : WriterWithPoses(std::move(folder)),
        later_s_(later_s),
        writer_(this->folder() / "scans.mcap",
                {later_s, options.labels == nullptr ? std::string_view() : options.labels->name(),
                 options.mount, options.driver, options.packets}),
        velocities_(options.velocities) {}

  EncodedScan encode(std::size_t index, const ScanView& given) const override {
    const WithVelocities with(given, index, velocities_);
    const ScanView& scan = with.scan();
    EncodedScan encoded;
    encoded.pose = {scan.time_s + later_s_, scan.world_from_sensor};
    encoded.points = scan.size();
    encoded.messages = writer_.messages(scan);
    return encoded;
  }
  void append(std::size_t index, const EncodedScan& scan) override {
    writer_.append(scan.messages);
    WriterWithPoses::append(index, scan);
  }
  std::string main_file(std::size_t /*index*/) const override { return ""; }
  void finish() override {
    writer_.finish();
    WriterWithPoses::finish();
  }

 private:
  double later_s_;
  McapWriter writer_;
  VelocitiesOfScan velocities_;
};

}  // namespace

double ros_delay_s(const DriveSpan& drive) {
  const double first_s = drive.begin_s() - 0.5 * drive.turn_s;
  return drive.begin_s() >= 0 && first_s < 0 ? std::ceil(-first_s) : 0;
}

void ScanWriter::write(std::size_t index, const ScanView& scan) {
  const EncodedScan encoded = encode(index, scan);
  write_encoded(folder_, encoded.files, FileWrites::atomic);
  append(index, encoded);
}

std::unique_ptr<ScanWriter> make_sequence_writer(const std::filesystem::path& folder,
                                                 const std::string& name, PointOrder order) {
  return std::make_unique<SequenceWriter>(folder, name, order);
}

std::unique_ptr<ScanWriter> make_scan_writer(const std::filesystem::path& folder, ScanFormat format,
                                             const ScanWriterOptions& options) {
  if (format == ScanFormat::semantickitti) return make_sequence_writer(folder, "00", options.order);
  if (format == ScanFormat::kitti_raw) return make_kitti_raw_writer(folder, options);
  if (format == ScanFormat::pandaset) return make_pandaset_writer(folder, options);
  if (format == ScanFormat::nuscenes) return make_nuscenes_writer(folder, options);
  if (format == ScanFormat::argoverse2) return make_av2_writer(folder, options);
  if (format == ScanFormat::pcap) return make_packet_writer(folder, options);
  if (format == ScanFormat::mcap)
    return std::make_unique<MessageWriter>(folder, ros_delay_s(options.drive), options);
  return std::make_unique<FileWriter>(folder, format, options);
}

}  // namespace adasplats
