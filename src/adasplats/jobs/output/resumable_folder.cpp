// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/resumable_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/output/unfinished_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Error cannot_resume(const fs::path& unfinished, const std::string& reason) {
  return Error(ErrorKind::cannot_create, unfinished.string() + ": cannot be resumed: " + reason +
                                             "; remove it to start again");
}

/// Whether a killed process left a temporary file.
bool is_temporary(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(".adasplats-") && name.ends_with(".tmp");
}

void remove_temporaries(const fs::path& folder) {
  for (const fs::path& file : files_below(folder))
    if (is_temporary(file)) fs::remove(file);
}

std::string relative_name(const fs::path& file, const fs::path& folder) {
  return file.lexically_relative(folder).generic_string();
}

}  // namespace

ResumableFolder::ResumableFolder(const fs::path& folder, bool overwrite, std::string command,
                                 const Json& content)
    : folder_(checked_output_folder(folder, overwrite, command)),
      unfinished_(unfinished_of(folder_)),
      command_(std::move(command)),
      content_(std::make_unique<Json>(content)),
      lock_(create_and_lock(unfinished_, folder_)) {
  try {
    resume();
    const fs::path journal = unfinished_ / kJournalFile;
    journal_ = open(journal.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (journal_ < 0) throw system_error(ErrorKind::cannot_create, journal, "cannot create", errno);
  } catch (...) {
    close(lock_);
    throw;
  }
}

void ResumableFolder::resume() {
  remove_temporaries(unfinished_);
  const fs::path file = unfinished_ / kContentFile;
  const std::string wanted = content_text(command_, *content_);
  if (!fs::exists(file)) {
    if (!fs::is_empty(unfinished_))
      throw cannot_resume(unfinished_, std::string("it has no ") + kContentFile);
    write_file(file, wanted);
    return;
  }
  const Json there = Json::parse(read_file(file), nullptr, false);
  if (!there.is_object())
    throw cannot_resume(unfinished_, std::string(kContentFile) + " is damaged");
  const std::string differs = difference_of_runs(there, Json::parse(wanted));
  if (!differs.empty())
    throw cannot_resume(unfinished_, "it was begun with other inputs or settings: " + differs);
  resume_journal();
}

void ResumableFolder::resume_journal() {
  std::optional<Journal> journal;
  try {
    journal = read_journal(unfinished_);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::data) throw;
    throw cannot_resume(unfinished_, error.what());
  }
  if (!journal) return;
  recorded_ = std::move(journal->files);
  if (journal->is_torn) write_file(unfinished_ / kJournalFile, journal->complete_lines);
}

ResumableFolder::~ResumableFolder() {
  if (lock_ < 0) return;
  close(journal_);
  std::error_code ignored;  // a destructor must not throw
  if (recorded_.empty()) fs::remove_all(unfinished_, ignored);
  close(lock_);
}

bool ResumableFolder::has(std::span<const std::string> files) const {
  for (const std::string& file : files) {
    const auto found = recorded_.find(file);
    if (found == recorded_.end() || !fs::is_regular_file(unfinished_ / file)) return false;
    if (sha256_of_file(unfinished_ / file) != found->second) return false;
  }
  return true;
}

void ResumableFolder::record(std::span<const std::string> files) {
  std::vector<FileDigest> digests;
  for (const std::string& file : files)
    digests.push_back({file, sha256_of_file(unfinished_ / file)});
  record(digests);
}

void ResumableFolder::record(std::span<const FileDigest> files) {
  std::string lines;
  for (const auto& [name, digest] : files) {
    recorded_[name] = digest;
    lines.append(digest).append("  ").append(name).append("\n");
  }
  const fs::path journal = unfinished_ / kJournalFile;
  const ssize_t put = write(journal_, lines.data(), lines.size());
  if (put < 0) throw system_error(ErrorKind::io, journal, "cannot be written", errno);
  if (static_cast<std::size_t>(put) != lines.size())
    throw system_error(ErrorKind::io, journal, "cannot be written", ENOSPC);
}

bool ResumableFolder::take(const std::string& file) {
  const auto noted = read_note(unfinished_ / file);
  if (!noted || !fs::is_regular_file(unfinished_ / file)) return false;
  if (sha256_of_file(unfinished_ / file) != *noted) return false;
  const FileDigest digest{file, *noted};
  record(std::span(&digest, 1));
  return true;
}

void ResumableFolder::discard() {
  recorded_.clear();
  if (ftruncate(journal_, 0) != 0)
    throw system_error(ErrorKind::io, unfinished_ / kJournalFile, "cannot be emptied", errno);
}

/// Removes the notes of all recorded files and the temporary files of killed tasks.
void ResumableFolder::remove_notes() {
  for (const auto& [file, digest] : recorded_) fs::remove(note_of(unfinished_ / file));
  remove_temporaries(unfinished_);
}

void ResumableFolder::commit(const Json& summary, std::span<const std::string> unneeded) {
  for (const std::string& file : unneeded) fs::remove(unfinished_ / file);
  remove_notes();
  Json content = *content_;
  content.update(summary);
  std::set<std::string> names;
  for (const fs::path& file : files_below(unfinished_))
    names.insert(relative_name(file, unfinished_));
  Json outputs = Json::object();
  for (const std::string& name : names) {
    if (name == kContentFile || name == kJournalFile) continue;
    const auto found = recorded_.find(name);
    outputs[name] = found != recorded_.end() ? found->second : sha256_of_file(unfinished_ / name);
  }
  content["outputs"] = outputs;
  write_file(unfinished_ / kContentFile, content_text(command_, content));
  // One call for all files: flushing each would wait for the disk once per file.
  if (syncfs(lock_) != 0)
    throw system_error(ErrorKind::io, unfinished_, "cannot be flushed to disk", errno);
  close(journal_);
  journal_ = -1;
  fs::remove(unfinished_ / kJournalFile);
  put_in_place(unfinished_, folder_);
  close(lock_);
  lock_ = -1;
}

}  // namespace adasplats
