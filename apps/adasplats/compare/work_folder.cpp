// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/work_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>

#include "adasplats/core/error.h"
#include "adasplats/io/atomic_file.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr const char* kContentFile = "adasplats.json";

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) {
    throw system_error(ErrorKind::cannot_create, folder, "cannot create the folder",
                       failure.value());
  }
}

/// Refuses a folder with anything but a comparison of the same data in it.
void check_content(const fs::path& folder, const std::string& title) {
  if (fs::is_empty(folder)) return;
  const fs::path file = folder / kContentFile;
  const Json content =
      fs::is_regular_file(file) ? Json::parse(read_file(file), nullptr, false) : Json();
  if (!content.is_object() || content.value("command", Json()) != "compare") {
    throw Error(ErrorKind::cannot_create,
                folder.string() + ": the folder is not empty and no comparison is in it");
  }
  if (content.value("title", Json()) != title) {
    throw Error(ErrorKind::cannot_create, folder.string() + ": holds a comparison of " +
                                              content.value("title", Json()).dump() + ", not of '" +
                                              title + "'");
  }
}

}  // namespace

WorkFolder::WorkFolder(const fs::path& folder, const std::string& title) : folder_(folder) {
  make_folder(folder_);
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw system_error(ErrorKind::cannot_create, folder_, "cannot open", errno);
  try {
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      throw Error(ErrorKind::cannot_create, folder_.string() + ": another run works in it");
    }
    check_content(folder_, title);
    make_folder(work());
    make_folder(folder_ / "pictures");
    const Json content = {{"program", "adasplats"},
                          {"version", ADASPLATS_VERSION},
                          {"command", "compare"},
                          {"title", title}};
    write_file(folder_ / kContentFile,
               content.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  } catch (...) {
    close(lock_);
    throw;
  }
}

WorkFolder::~WorkFolder() { close(lock_); }

}  // namespace adasplats::app
