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

/// One of the files that a scan becomes.
struct EncodedFile {
  std::string name;  ///< relative to the folder of the data set
  std::string bytes;
};

/// A scan as the bytes that are written of it, and what the files of all scans need to know.
struct EncodedScan {
  std::vector<EncodedFile> files;            ///< of its own
  std::vector<McapMessage> messages;         ///< for a file of all scans
  std::vector<PacketReturn> packet_returns;  ///< of every firing, column by column
  TimedPose pose;
  std::size_t points = 0;
  bool has_classes = false;
};

/// How files come into being.
enum class FileWrites : bool {
  atomic,    ///< as AtomicFile has it: where others may look into the folder
  in_place,  ///< write_file_in_place(): in a folder that gets its name when it is whole
};

/// Writes files into `folder`, which exists; folders in it are made. Several threads may call it at
/// once. Errors: cannot_create, io.
void write_encoded(const std::filesystem::path& folder, std::span<const EncodedFile> files,
                   FileWrites how);

}  // namespace adasplats
