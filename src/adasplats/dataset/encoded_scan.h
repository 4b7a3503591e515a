// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/sensors/packet_sensor.h"

namespace adasplats {

/// One of the files of a scan.
struct EncodedFile {
  std::string name;  ///< relative to the folder of the data set
  std::string bytes;
};

/// A scan encoded as bytes, and its data for files common to all scans.
struct EncodedScan {
  std::vector<EncodedFile> files;            ///< of this scan only
  std::vector<McapMessage> messages;         ///< for the file of all scans
  std::vector<PacketReturn> packet_returns;  ///< of every firing, column by column
  TimedPose pose;
  std::size_t points = 0;
  bool has_classes = false;
};

/// How files are written.
enum class FileWrites : bool {
  atomic,    ///< by AtomicFile: for folders that others may read meanwhile
  in_place,  ///< by write_file_in_place(): for folders that are renamed when complete
};

/// Writes files into `folder`, which must exist; creates subfolders. Thread-safe. Errors:
/// cannot_create, io.
void write_encoded(const std::filesystem::path& folder, std::span<const EncodedFile> files,
                   FileWrites how);

}  // namespace adasplats
