// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "adasplats/jobs/output/unfinished_folder.h"

namespace adasplats {

/// One of many tasks that make files of a ResumableFolder which a run has begun and left
/// unfinished: any number at a time, on one machine or on several that share the file system. A
/// task writes each file under a temporary name and renames it (AtomicFile), then writes its
/// SHA-256 to a note next to it; the run that finishes the folder records these files. The folder
/// is locked: while tasks work on a machine, no run on it can open the folder, and vice versa. In a
/// finished folder all files are done.
class FolderTask {
 public:
  /// `folder`: the name of the finished folder. Keys that `content` lacks are not compared. Errors:
  /// no_input (no run has begun the folder), cannot_create (another version or other settings, with
  /// the key that differs; a run is using the folder).
  FolderTask(const std::filesystem::path& folder, const std::string& command,
             const nlohmann::ordered_json& content);
  ~FolderTask();
  FolderTask(const FolderTask&) = delete;
  FolderTask& operator=(const FolderTask&) = delete;

  /// The unfinished folder, or the finished one.
  const std::filesystem::path& path() const { return path_; }
  bool is_finished() const { return is_finished_; }
  /// Whether a file was recorded by the run or noted by a task and is unchanged since.
  bool has(const std::string& file) const;
  /// Whether the run recorded a file.
  bool is_recorded(const std::string& file) const { return recorded_.contains(file); }
  /// Throws data, with the file, if one that the run recorded has changed.
  void require(std::span<const std::string> files) const;
  /// Notes that a file is complete.
  void record(const std::string& file);

 private:
  void open_unfinished(const std::string& wanted);
  void open_finished(const std::string& wanted);

  std::filesystem::path folder_;
  std::filesystem::path path_;
  FileDigests recorded_;
  bool is_finished_ = false;
  int lock_ = -1;  ///< descriptor of the unfinished folder, locked with other tasks
};

}  // namespace adasplats
