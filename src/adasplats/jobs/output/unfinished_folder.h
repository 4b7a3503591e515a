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

// What ResumableFolder and FolderTask know alike of the folder that an output is made in.

/// Of an unfinished folder: lines "SHA-256  NAME", as sha256sum writes and checks them.
inline constexpr const char* kJournalFile = "journal.sha256";

/// Where `folder` is filled: ".NAME.unfinished" beside it.
std::filesystem::path unfinished_of(const std::filesystem::path& folder);

/// SHA-256 by file.
using FileDigests = std::map<std::string, std::string>;

struct Journal {
  FileDigests files;
  std::string whole_lines;  ///< its text without a last line that was cut short
  bool is_torn = false;     ///< power may fail within a line
};

/// Nothing where there is none. Errors: data (line N is damaged), io.
std::optional<Journal> read_journal(const std::filesystem::path& unfinished);

/// The first key in which two objects differ, with both values; empty where they are equal.
/// `there` may have more keys at the top.
std::string difference_of_runs(const nlohmann::ordered_json& there,
                               const nlohmann::ordered_json& here);

/// What a task notes of a file that it has made, beside the file: "NAME.sha256" with one line, so
/// that tasks of many machines need not write into one journal.
std::filesystem::path note_of(const std::filesystem::path& file);
void write_note(const std::filesystem::path& file, const std::string& sha256);
/// The SHA-256 that a note says; nothing where there is none, or it is damaged.
std::optional<std::string> read_note(const std::filesystem::path& file);

/// The same for many files at once, in a file of its own: a line "SHA-256  NAME" each, in order.
void write_digests(const std::filesystem::path& file, std::span<const FileDigest> digests);
/// Nothing where there is none, or it is damaged.
std::optional<std::vector<FileDigest>> read_digests(const std::filesystem::path& file);

}  // namespace adasplats
