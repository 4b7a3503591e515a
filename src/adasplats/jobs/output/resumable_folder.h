// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "adasplats/io/base/sha256.h"

namespace adasplats {

/// An output folder that appears complete or not at all. A run that fills it can be interrupted at
/// any moment and resumed. It is filled under the name ".NAME.unfinished" in the same parent; a
/// journal lists the complete files with their SHA-256; commit() renames the folder. So its files
/// need no temporary names and are not flushed one by one. While no process has it open as a
/// ResumableFolder, tasks of other processes can add files (FolderTask).
class ResumableFolder {
 public:
  /// `content`: inputs and settings, everything that the files depend on. It is written to
  /// adasplats.json; this and `overwrite` are as for OutputFolder. An unfinished folder of an
  /// earlier process with the same content is resumed. Errors: cannot_create (another process is
  /// filling the folder; the unfinished one has other content, with the key that differs, or is
  /// damaged), io.
  ResumableFolder(const std::filesystem::path& folder, bool overwrite, std::string command,
                  const nlohmann::ordered_json& content);
  /// Leaves recorded files for another process; if there are none, removes the folder.
  ~ResumableFolder();
  ResumableFolder(const ResumableFolder&) = delete;
  ResumableFolder& operator=(const ResumableFolder&) = delete;

  /// Where to write to.
  const std::filesystem::path& path() const { return unfinished_; }
  /// Whether files, named relative to path(), were recorded and are unchanged since.
  bool has(std::span<const std::string> files) const;
  bool has(const std::string& file) const { return has(std::span(&file, 1)); }
  /// Records complete files, in order; to be called when they are on disk.
  void record(std::span<const std::string> files);
  void record(const std::string& file) { record(std::span(&file, 1)); }
  /// The same with known SHA-256.
  void record(std::span<const FileDigest> files);
  /// Records a file that a task made (FolderTask::record). Returns false if no task made it or it
  /// has changed since.
  bool take(const std::string& file);
  /// Leaves nothing for another process: not even files that cannot be removed count as recorded.
  /// Errors: io.
  void discard();
  /// SHA-256 of the recorded files, by name.
  const std::map<std::string, std::string>& recorded() const { return recorded_; }

  /// Removes the files `unneeded`, adds `summary` and "outputs", the SHA-256 of every file, to
  /// adasplats.json, flushes everything to the disk and renames the folder.
  void commit(const nlohmann::ordered_json& summary, std::span<const std::string> unneeded);

 private:
  void resume();
  void resume_journal();
  void remove_notes();

  std::filesystem::path folder_;
  std::filesystem::path unfinished_;
  std::string command_;
  std::unique_ptr<nlohmann::ordered_json> content_;  ///< never null
  std::map<std::string, std::string> recorded_;      ///< SHA-256 by file
  int lock_ = -1;     ///< descriptor of the unfinished folder, locked
  int journal_ = -1;  ///< descriptor, at its end
};

}  // namespace adasplats
