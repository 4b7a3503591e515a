// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/folder_task.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/output_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The content of a folder, which must match `wanted`. Errors: cannot_create.
Json require_same_content(const fs::path& folder, const std::string& wanted) {
  Json there = Json::parse(read_file(folder / kContentFile), nullptr, false);
  if (!there.is_object())
    throw Error(ErrorKind::cannot_create,
                folder.string() + ": " + std::string(kContentFile) + " is damaged");
  const std::string differs = difference_of_runs(there, Json::parse(wanted));
  if (!differs.empty())
    throw Error(ErrorKind::cannot_create, folder.string() + ": planned with other settings: " +
                                              differs + "; run `plan` again with these");
  return there;
}

}  // namespace

FolderTask::FolderTask(const fs::path& folder, const std::string& command, const Json& content)
    : folder_(folder.lexically_normal()) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  const std::string wanted = content_text(command, content);
  std::error_code none;
  if (fs::exists(unfinished_of(folder_) / kContentFile, none))
    open_unfinished(wanted);
  else
    open_finished(wanted);
}

void FolderTask::open_unfinished(const std::string& wanted) {
  path_ = unfinished_of(folder_);
  lock_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw system_error(ErrorKind::no_input, path_, "cannot be opened", errno);
  try {
    if (flock(lock_, LOCK_SH | LOCK_NB) != 0)
      throw Error(ErrorKind::cannot_create,
                  folder_.string() + ": another process is writing it (" + path_.string() + ")");
    require_same_content(path_, wanted);
    if (auto journal = read_journal(path_)) recorded_ = std::move(journal->files);
  } catch (...) {
    close(lock_);
    throw;
  }
}

void FolderTask::open_finished(const std::string& wanted) {
  std::error_code none;
  if (!fs::exists(folder_ / kContentFile, none))
    throw Error(ErrorKind::no_input, folder_.string() + ": no tasks are planned; run `plan` first");
  path_ = folder_;
  is_finished_ = true;
  const Json content = require_same_content(path_, wanted);
  const auto outputs = content.find("outputs");
  if (outputs != content.end() && outputs->is_object())
    for (const auto& [file, digest] : outputs->items())
      if (digest.is_string()) recorded_[file] = digest.get<std::string>();
}

FolderTask::~FolderTask() {
  if (lock_ >= 0) close(lock_);
}

bool FolderTask::has(const std::string& file) const {
  std::error_code none;
  if (!fs::is_regular_file(path_ / file, none)) return false;
  const auto found = recorded_.find(file);
  const auto noted = read_note(path_ / file);
  if (found == recorded_.end() && !noted) return false;
  const std::string digest = sha256_of_file(path_ / file);
  return (found != recorded_.end() && found->second == digest) || noted == digest;
}

void FolderTask::require(std::span<const std::string> files) const {
  for (const std::string& file : files) {
    const auto found = recorded_.find(file);
    std::error_code none;
    if (found == recorded_.end() || !fs::is_regular_file(path_ / file, none) ||
        sha256_of_file(path_ / file) != found->second)
      throw Error(ErrorKind::data,
                  (path_ / file).string() + ": the file has changed; run `plan` again");
  }
}

void FolderTask::record(const std::string& file) {
  write_note(path_ / file, sha256_of_file(path_ / file));
}

}  // namespace adasplats
