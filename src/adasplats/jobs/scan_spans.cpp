// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scan_spans.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/output/unfinished_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSpansFolder = "spans";
constexpr const char* kSpansBegun = "spans/begun";
constexpr std::string_view kNoteEnding = ".sha256";
constexpr std::string_view kEmptyEnding = ".empty.sha256";

fs::path note_of_span(const fs::path& folder, std::size_t first, std::size_t count, bool is_empty) {
  std::string name = std::to_string(first) + "-" + std::to_string(count);
  name += is_empty ? kEmptyEnding : kNoteEnding;
  return folder / kSpansFolder / name;
}

std::set<fs::path> files_of_spans(const fs::path& folder) {
  std::set<fs::path> files;
  if (!fs::is_directory(folder / kSpansFolder)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kSpansFolder))
    files.insert(entry.path());
  return files;
}

bool are_as_noted(const fs::path& folder, const std::vector<FileDigest>& files) {
  return std::ranges::all_of(files, [&](const FileDigest& file) {
    std::error_code none;
    return fs::is_regular_file(folder / file.name, none) &&
           sha256_of_file(folder / file.name) == file.sha256;
  });
}

}  // namespace

void begin_spans(ResumableFolder& folder) {
  if (folder.has(kSpansBegun)) return;
  fs::create_directories(folder.path() / kSpansFolder);
  write_file_in_place(folder.path() / kSpansBegun, "");
  folder.record(std::string(kSpansBegun));
}

void note_span(const fs::path& folder, std::size_t first, std::size_t count,
               std::span<const FileDigest> files, bool is_empty) {
  write_digests(note_of_span(folder, first, count, is_empty), files);
}

bool has_span(const fs::path& folder, std::size_t first, std::size_t count) {
  for (const bool is_empty : {false, true}) {
    const auto noted = read_digests(note_of_span(folder, first, count, is_empty));
    if (noted && are_as_noted(folder, *noted)) return true;
  }
  return false;
}

void take_spans(ResumableFolder& folder) {
  std::vector<FileDigest> files;
  bool is_empty = true;
  for (const fs::path& note : files_of_spans(folder.path())) {
    const std::string name = note.filename().string();
    const auto noted = name.ends_with(kNoteEnding) ? read_digests(note) : std::nullopt;
    if (!noted) continue;
    is_empty = is_empty && name.ends_with(kEmptyEnding);
    for (const FileDigest& file : *noted) {
      const auto known = folder.recorded().find(file.name);
      if (known == folder.recorded().end() || known->second != file.sha256) files.push_back(file);
    }
  }
  if (!is_empty && !files.empty()) folder.record(files);
}

std::vector<std::string> aids_of_spans(const fs::path& folder) {
  std::vector<std::string> aids;
  const std::set<fs::path> files = files_of_spans(folder);
  aids.reserve(files.size() + 1);
  for (const fs::path& file : files)
    aids.push_back(std::string(kSpansFolder) + "/" + file.filename().string());
  if (!files.empty()) aids.emplace_back(kSpansFolder);  // behind what was in it
  return aids;
}

}  // namespace adasplats
