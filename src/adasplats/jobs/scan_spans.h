// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

// What tasks note of the spans of scans that they have written, in "spans/FIRST-COUNT.sha256" of
// the unfinished folder: the SHA-256 of every file, of each scan the main one last. A span
// without any return is ".empty.sha256": a drive of nothing else is an error, as in one run.

/// Makes the folder one that tasks can go on with.
void begin_spans(ResumableFolder& folder);

void note_span(const std::filesystem::path& folder, std::size_t first, std::size_t count,
               std::span<const FileDigest> files, bool is_empty);
/// Whether a span was noted and its files are still as they were then.
bool has_span(const std::filesystem::path& folder, std::size_t first, std::size_t count);

/// Records what tasks have written.
void take_spans(ResumableFolder& folder);
/// What is no part of the finished folder.
std::vector<std::string> aids_of_spans(const std::filesystem::path& folder);

}  // namespace adasplats
