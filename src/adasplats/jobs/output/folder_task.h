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
/// task writes each file under a temporary name and renames it (AtomicFile), then notes its SHA-256
/// beside it; the run that finishes the folder takes these files. While tasks of this machine are
/// at work it does not get the folder, and while it has the folder tasks are refused. In a folder
/// that is finished a task finds its files done.
class FolderTask {
 public:
  /// `folder`: what the finished folder is called. Keys of its content that `content` lacks are not
  /// compared. Errors: no_input (nothing was begun), cannot_create (of another version or other
  /// settings, with the key that differs; a run has the folder).
  FolderTask(const std::filesystem::path& folder, const std::string& command,
             const nlohmann::ordered_json& content);
  ~FolderTask();
  FolderTask(const FolderTask&) = delete;
  FolderTask& operator=(const FolderTask&) = delete;

  /// The unfinished folder, or the finished one.
  const std::filesystem::path& path() const { return path_; }
  bool is_finished() const { return is_finished_; }
  /// Whether a file was recorded by the run or noted by a task and is still as it was then.
  bool has(const std::string& file) const;
  /// Whether the run recorded a file.
  bool is_recorded(const std::string& file) const { return recorded_.contains(file); }
  /// Throws data, with the file, where one that the run recorded is not as it was.
  void require(std::span<const std::string> files) const;
  /// Notes that a file is whole.
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
