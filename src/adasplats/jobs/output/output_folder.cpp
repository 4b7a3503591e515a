// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Error cannot_create(const fs::path& path, const std::string& reason) {
  return Error(ErrorKind::cannot_create, path.string() + ": " + reason);
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void check_parent(const fs::path& path) {
  const fs::path parent = parent_of(path);
  std::error_code failure;
  if (!fs::is_directory(parent, failure)) {
    throw cannot_create(path, "cannot create: no such folder: " + parent.string());
  }
  if (access(parent.c_str(), W_OK | X_OK) != 0) {
    throw system_error(ErrorKind::cannot_create, path, "cannot create", errno);
  }
}

/// The folder's name without a trailing slash, so that it has a parent and a name.
fs::path without_slash(const fs::path& folder) {
  const fs::path normal = folder.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

/// The command that wrote a folder, by its adasplats.json; empty where there is none.
std::string writer_of(const fs::path& folder) {
  const fs::path file = folder / kContentFile;
  std::error_code failure;
  if (!fs::is_regular_file(file, failure)) return "";
  const Json content = Json::parse(read_file(file), nullptr, false);
  const auto command = content.is_object() ? content.find("command") : content.end();
  return command != content.end() && command->is_string() ? command->get<std::string>() : "";
}

void check_replaceable(const fs::path& folder, bool overwrite, const std::string& command) {
  std::error_code failure;
  const fs::file_status status = fs::status(folder, failure);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) throw cannot_create(folder, "exists and is not a folder");
  if (fs::is_empty(folder, failure)) return;
  if (!overwrite) {
    throw cannot_create(folder, "the folder is not empty (`overwrite` replaces earlier output)");
  }
  // Replacing removes everything in the folder, so it must be output of this command.
  if (writer_of(folder) != command) {
    throw cannot_create(folder, std::string("not replaced: it has no ") + kContentFile +
                                    " by 'adasplats " + command + "'");
  }
}

}  // namespace

void check_output_file(const fs::path& file) {
  check_parent(file);
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw cannot_create(file, fs::is_directory(status) ? "is a folder" : "is not a regular file");
  }
}

fs::path checked_output_folder(const fs::path& folder, bool overwrite, const std::string& command) {
  fs::path named = without_slash(folder);
  if (named.empty() || named.filename() == "." || named.filename() == "..") {
    throw cannot_create(folder, "the folder needs a name; . and .. are not possible");
  }
  check_parent(named);
  check_replaceable(named, overwrite, command);
  return named;
}

int create_and_lock(const fs::path& partial, const fs::path& folder) {
  std::error_code failure;
  const bool is_new = fs::create_directory(partial, failure);
  const int lock = open(partial.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock < 0) {
    const int reason = errno;
    if (is_new) fs::remove(partial, failure);
    throw system_error(ErrorKind::cannot_create, partial, "cannot create", reason);
  }
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    close(lock);
    throw cannot_create(folder, "another process is writing it (" + partial.string() + ")");
  }
  return lock;
}

std::string content_text(const std::string& command, const Json& content) {
  Json json;
  json["program"] = "adasplats";
  json["version"] = ADASPLATS_VERSION;
  json["command"] = command;
  json.update(content);
  // File names need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void put_in_place(const fs::path& partial, const fs::path& folder) {
  const fs::path old = parent_of(folder) / ("." + folder.filename().string() + ".replaced");
  std::error_code failure;
  fs::remove_all(old, failure);
  fs::rename(folder, old, failure);  // fails where there is no older folder
  fs::rename(partial, folder, failure);
  if (failure) {
    const int reason = failure.value();
    fs::rename(old, folder, failure);
    throw system_error(ErrorKind::cannot_create, folder, "cannot create", reason);
  }
  fs::remove_all(old, failure);
  if (failure)
    throw system_error(ErrorKind::io, old, "the replaced folder cannot be removed",
                       failure.value());
}

OutputFolder::OutputFolder(const fs::path& folder, bool overwrite, const std::string& command,
                           const Json& content)
    : folder_(checked_output_folder(folder, overwrite, command)),
      partial_(parent_of(folder_) / ("." + folder_.filename().string() + ".partial")),
      lock_(create_and_lock(partial_, folder_)) {
  try {
    for (const fs::path& left_over : list_folder(partial_)) fs::remove_all(left_over);
    write_file(partial_ / kContentFile, content_text(command, content));
  } catch (...) {
    std::error_code failure;
    fs::remove_all(partial_, failure);
    close(lock_);
    throw;
  }
}

OutputFolder::~OutputFolder() {
  if (lock_ < 0) return;
  std::error_code ignored;  // a destructor must not throw
  fs::remove_all(partial_, ignored);
  close(lock_);
}

void OutputFolder::commit() {
  put_in_place(partial_, folder_);
  close(lock_);
  lock_ = -1;
}

}  // namespace adasplats
