// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "adasplats/io/bags/recording.h"

namespace adasplats {

/// "drive.mcap" for "drive.mcap.zstd" (or .zst), a file that is compressed as a whole, as by ROS 2
/// bags with `compression_mode: file`; other paths unchanged.
std::filesystem::path without_packing(const std::filesystem::path& path);

using OpenRecordingFile =
    std::function<std::unique_ptr<RecordingFile>(const std::filesystem::path& path)>;

/// Opens a file that is compressed with zstd as a whole: decompresses it into a temporary folder
/// (TMPDIR or the system's), which is removed with the result. Errors: those of `open`, naming the
/// compressed file; data (damaged, or larger than 256 times its size and a gigabyte), io (the disk
/// is full but for a twentieth), unavailable (no zstd).
std::unique_ptr<RecordingFile> open_packed_recording(const std::filesystem::path& path,
                                                     const OpenRecordingFile& open);

/// A file with individually compressed messages, as in ROS 2 bags with `compression_mode: message`.
/// Errors of its calls: data (a message that is damaged or has no size), unavailable.
std::unique_ptr<RecordingFile> with_packed_messages(std::unique_ptr<RecordingFile> file,
                                                    std::string packing,
                                                    const std::filesystem::path& path);

}  // namespace adasplats
