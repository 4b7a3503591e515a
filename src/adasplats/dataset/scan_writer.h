// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/range_image.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/simulate/scan/scan.h"

namespace adasplats {

struct ScanWriterOptions {
  ImageSize image_size;                 ///< of range images (image_size_of)
  double full_intensity = 1.0;          ///< LAS: what becomes its largest intensity
  const LabelScheme* labels = nullptr;  ///< colours of range images; outlives the writer
};

/// Writes the scans of one drive into a folder.
class ScanWriter {
 public:
  ScanWriter() = default;
  virtual ~ScanWriter() = default;
  ScanWriter(const ScanWriter&) = delete;
  ScanWriter& operator=(const ScanWriter&) = delete;

  /// Writes scan number `index`; one call at a time, in the order of the numbers.
  virtual void write(std::size_t index, const Scan& scan) = 0;
  /// Writes what all scans have in common. To be called once, last.
  virtual void finish() = 0;
};

/// A writer into `folder`, which exists. semantickitti: FOLDER/sequences/00 as SemanticKittiWriter;
/// range_image: files of write_range_image(); mcap: FOLDER/scans.mcap as McapWriter; else
/// NNNNNN.EXT of scan_files.h. All but semantickitti have poses.csv beside them. Errors:
/// cannot_create, io; mcap: data (times that ROS cannot express).
std::unique_ptr<ScanWriter> make_scan_writer(const std::filesystem::path& folder, ScanFormat format,
                                             const ScanWriterOptions& options = {});

}  // namespace adasplats
