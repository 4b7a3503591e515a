// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "adasplats/io/bags/recording.h"

namespace adasplats {

/// "drive.mcap" of "drive.mcap.zstd" (or .zst), a file that is packed as a whole, as ROS 2 bags
/// with `compression_mode: file` are; another path as it is.
std::filesystem::path without_packing(const std::filesystem::path& path);

using OpenRecordingFile =
    std::function<std::unique_ptr<RecordingFile>(const std::filesystem::path& path)>;

/// Opens a file that is packed with zstd as a whole: it is unpacked piece by piece into a temporary
/// folder (the system's, or that of TMPDIR), which goes with the result. Errors: those of `open`,
/// which name the packed file; data (broken, or unpacking to more than 256 times its size and a
/// gigabyte), io (no room, of which a twentieth is left free), unavailable (no zstd).
std::unique_ptr<RecordingFile> open_packed_recording(const std::filesystem::path& path,
                                                     const OpenRecordingFile& open);

/// A file whose messages are packed one by one, as ROS 2 bags with `compression_mode: message` are.
/// Errors of its calls: data (a message that is broken or does not say its size), unavailable.
std::unique_ptr<RecordingFile> with_packed_messages(std::unique_ptr<RecordingFile> file,
                                                    std::string packing,
                                                    const std::filesystem::path& path);

}  // namespace adasplats
