// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/io/base/sha256.h"

namespace adasplats {

// The unfinished folder of an output, as ResumableFolder and FolderTask share it.

/// The journal of an unfinished folder: lines "SHA-256  NAME", as sha256sum writes and checks them.
inline constexpr const char* kJournalFile = "journal.sha256";

/// The folder in which `folder` is filled: ".NAME.unfinished" in the same parent.
std::filesystem::path unfinished_of(const std::filesystem::path& folder);

/// SHA-256 by file.
using FileDigests = std::map<std::string, std::string>;

struct Journal {
  FileDigests files;
  std::string complete_lines;  ///< its text without an incomplete last line
  bool is_torn = false;        ///< the last line is incomplete (the machine may have stopped)
};

/// Nothing if there is no journal. Errors: data (line N is damaged), io.
std::optional<Journal> read_journal(const std::filesystem::path& unfinished);

/// The first key in which two contents differ, with both values; empty if they are equal. `earlier`
/// may have additional keys at the top level.
std::string difference_of_runs(const nlohmann::ordered_json& earlier,
                               const nlohmann::ordered_json& now);

/// The note of a task about a file that it has made: "NAME.sha256" next to the file, with one line.
/// So tasks of many machines need not share a journal.
std::filesystem::path note_of(const std::filesystem::path& file);
void write_note(const std::filesystem::path& file, const std::string& sha256);
/// The SHA-256 in a note; nothing if there is no note or it is damaged.
std::optional<std::string> read_note(const std::filesystem::path& file);

/// The same for many files, in one file: a line "SHA-256  NAME" for each, in order.
void write_digests(const std::filesystem::path& file, std::span<const FileDigest> digests);
/// Nothing if there is no such file or it is damaged.
std::optional<std::vector<FileDigest>> read_digests(const std::filesystem::path& file);

}  // namespace adasplats
