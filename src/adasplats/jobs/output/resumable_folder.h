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

/// An output folder that appears whole or not at all, whose making can be interrupted at any moment
/// and goes on where it stopped. It is filled beside its place under the name ".NAME.unfinished",
/// where a journal says which files are whole, with their SHA-256; commit() renames it. So files in
/// it need neither temporary names nor to be flushed one by one. Tasks of other processes can make
/// files in it meanwhile (FolderTask), while none has it as a ResumableFolder.
class ResumableFolder {
 public:
  /// `content` says what the folder is made of and how: all that its files depend on. It goes into
  /// adasplats.json as OutputFolder's does, and the same for `overwrite`. What an earlier process
  /// left unfinished is taken over if it was made of the same.
  /// Errors: cannot_create (another process fills the folder; the unfinished one is of another run,
  /// with the key that differs, or is damaged), io.
  ResumableFolder(const std::filesystem::path& folder, bool overwrite, std::string command,
                  const nlohmann::ordered_json& content);
  /// Leaves what was recorded for another process; nothing, if nothing was.
  ~ResumableFolder();
  ResumableFolder(const ResumableFolder&) = delete;
  ResumableFolder& operator=(const ResumableFolder&) = delete;

  /// Where to write to.
  const std::filesystem::path& path() const { return unfinished_; }
  /// Whether files, named relative to path(), were recorded and are still as they were then.
  bool has(std::span<const std::string> files) const;
  bool has(const std::string& file) const { return has(std::span(&file, 1)); }
  /// Notes that files are whole, one after another; to be called when they are on disk.
  void record(std::span<const std::string> files);
  void record(const std::string& file) { record(std::span(&file, 1)); }
  /// The same where their SHA-256 is known.
  void record(std::span<const FileDigest> files);
  /// Records a file that a task made (FolderTask::record); false where none did, or it is not as
  /// the task noted.
  bool take(const std::string& file);
  /// Leaves nothing for another process: what was made is of no use.
  void discard() { recorded_.clear(); }
  /// SHA-256 of what was recorded, by name.
  const std::map<std::string, std::string>& recorded() const { return recorded_; }

  /// Removes the files `aids`, adds `summary` and the SHA-256 of every file, as "outputs", to
  /// adasplats.json, flushes all of it to the disk and gives the folder its name.
  void commit(const nlohmann::ordered_json& summary, std::span<const std::string> aids);

 private:
  void take_over();
  void take_over_journal();
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
