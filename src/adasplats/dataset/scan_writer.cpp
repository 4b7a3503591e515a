// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_writer.h"

#include <stdexcept>
#include <utility>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/dataset/mcap_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/semantickitti_writer.h"

namespace adasplats {
namespace {

class SequenceWriter final : public ScanWriter {
 public:
  explicit SequenceWriter(const std::filesystem::path& folder)
      : writer_(folder / "sequences" / "00") {}
  void write(std::size_t index, const Scan& scan) override { writer_.write_scan(index, scan); }
  void finish() override { writer_.finish(); }

 private:
  SemanticKittiWriter writer_;
};

/// Files of their own for every scan, and poses.csv.
class FileWriter final : public ScanWriter {
 public:
  FileWriter(std::filesystem::path folder, ScanFormat format, const ScanWriterOptions& options)
      : folder_(std::move(folder)), format_(format), options_(options) {}

  void write(std::size_t index, const Scan& scan) override {
    write_file_of(scan_name(index), scan);
    trajectory_.push_back({scan.time_s, scan.world_from_sensor});
  }
  void finish() override { write_trajectory_csv(folder_ / "poses.csv", trajectory_); }

 private:
  void write_file_of(const std::string& stem, const Scan& scan) const {
    switch (format_) {
      case ScanFormat::ply: return write_scan_ply(folder_ / (stem + ".ply"), scan);
      case ScanFormat::npy: return write_scan_npy(folder_ / (stem + ".npy"), scan);
      case ScanFormat::npz: return write_scan_npz(folder_ / (stem + ".npz"), scan);
      case ScanFormat::pcd: return write_scan_pcd(folder_ / (stem + ".pcd"), scan);
      case ScanFormat::las:
        return write_scan_las(folder_ / (stem + ".las"), scan, options_.full_intensity);
      case ScanFormat::range_image:
        return write_range_image(folder_, stem, range_image(scan, options_.image_size),
                                 options_.labels);
      case ScanFormat::semantickitti:
      case ScanFormat::mcap: break;
    }
    throw std::logic_error("ScanWriter: no format of single files");
  }

  std::filesystem::path folder_;
  ScanFormat format_;
  ScanWriterOptions options_;
  Trajectory trajectory_;
};

/// All scans as messages of one file, and poses.csv.
class MessageWriter final : public ScanWriter {
 public:
  explicit MessageWriter(std::filesystem::path folder)
      : folder_(std::move(folder)), writer_(folder_ / "scans.mcap") {}

  void write(std::size_t /*index*/, const Scan& scan) override {
    writer_.write(scan);
    trajectory_.push_back({scan.time_s, scan.world_from_sensor});
  }
  void finish() override {
    writer_.finish();
    write_trajectory_csv(folder_ / "poses.csv", trajectory_);
  }

 private:
  std::filesystem::path folder_;
  McapWriter writer_;
  Trajectory trajectory_;
};

}  // namespace

std::unique_ptr<ScanWriter> make_scan_writer(const std::filesystem::path& folder, ScanFormat format,
                                             const ScanWriterOptions& options) {
  if (format == ScanFormat::semantickitti) return std::make_unique<SequenceWriter>(folder);
  if (format == ScanFormat::mcap) return std::make_unique<MessageWriter>(folder);
  return std::make_unique<FileWriter>(folder, format, options);
}

}  // namespace adasplats
