// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/output/resumable_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/output/output_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
// Lines "SHA-256  NAME", as sha256sum writes and checks them.
constexpr const char* kJournalFile = "journal.sha256";
constexpr std::size_t kDigits = 64;

Error cannot_resume(const fs::path& unfinished, const std::string& reason) {
  return Error(ErrorKind::cannot_create, unfinished.string() +
                                             ": cannot go on with what is there: " + reason +
                                             "; remove it to start anew");
}

/// Temporary files that a killed process left.
bool is_temporary(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(".adasplats-") && name.ends_with(".tmp");
}

void remove_temporaries(const fs::path& folder) {
  std::set<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && is_temporary(entry.path())) found.insert(entry.path());
  for (const fs::path& file : found) fs::remove(file);
}

std::string shown(const Json* value) {
  if (value == nullptr) return "nothing";
  std::string text = value->dump(-1, ' ', false, Json::error_handler_t::replace);
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

const Json* find(const Json& object, const std::string& key) {
  const auto found = object.find(key);
  return found != object.end() ? &*found : nullptr;
}

/// The first key in which two objects differ, with both values; empty where they are equal.
/// `there` may have more keys at the top.
std::string difference(const Json& there, const Json& here, bool more_allowed) {
  std::set<std::string> keys;
  for (const auto& [key, value] : here.items()) keys.insert(key);
  if (!more_allowed)
    for (const auto& [key, value] : there.items()) keys.insert(key);
  for (const std::string& key : keys) {
    const Json* const a = find(there, key);
    const Json* const b = find(here, key);
    if (a != nullptr && b != nullptr && *a == *b) continue;
    if (a != nullptr && b != nullptr && a->is_object() && b->is_object())
      return key + "." + difference(*a, *b, false);
    return key + " was " + shown(a) + " and is " + shown(b);
  }
  return "";
}

std::string relative_name(const fs::path& file, const fs::path& folder) {
  return file.lexically_relative(folder).generic_string();
}

fs::path unfinished_of(const fs::path& folder) {
  return folder.parent_path() / ("." + folder.filename().string() + ".unfinished");
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
    take_over();
    const fs::path journal = unfinished_ / kJournalFile;
    journal_ = open(journal.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (journal_ < 0) throw system_error(ErrorKind::cannot_create, journal, "cannot create", errno);
  } catch (...) {
    close(lock_);
    throw;
  }
}

void ResumableFolder::take_over() {
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
  const std::string differs = difference(there, Json::parse(wanted), true);
  if (!differs.empty()) throw cannot_resume(unfinished_, "it is of another run: " + differs);
  read_journal();
}

void ResumableFolder::read_journal() {
  const fs::path file = unfinished_ / kJournalFile;
  if (!fs::exists(file)) return;
  std::string text = read_file(file);
  // Power may fail within a line.
  const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  const bool is_torn = whole != text.size();
  text.resize(whole);
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    ++line_number;
    if (line.size() < kDigits + 3 || line.compare(kDigits, 2, "  ") != 0 ||
        line.find_first_not_of("0123456789abcdef") != kDigits)
      throw cannot_resume(unfinished_, std::string(kJournalFile) + ":" +
                                           std::to_string(line_number) + " is damaged");
    recorded_[line.substr(kDigits + 2)] = line.substr(0, kDigits);
    begin = end + 1;
  }
  if (is_torn) write_file(file, text);
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

void ResumableFolder::commit(const Json& summary, std::span<const std::string> aids) {
  for (const std::string& aid : aids) fs::remove(unfinished_ / aid);
  Json content = *content_;
  content.update(summary);
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(unfinished_))
    if (entry.is_regular_file()) names.insert(relative_name(entry.path(), unfinished_));
  Json outputs = Json::object();
  for (const std::string& name : names) {
    if (name == kContentFile || name == kJournalFile) continue;
    const auto found = recorded_.find(name);
    outputs[name] = found != recorded_.end() ? found->second : sha256_of_file(unfinished_ / name);
  }
  content["outputs"] = outputs;
  write_file(unfinished_ / kContentFile, content_text(command_, content));
  // One call for all files: each by itself would wait for the disk as often as there are files.
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
