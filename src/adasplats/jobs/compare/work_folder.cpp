// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/compare/work_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/output/output_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr std::streamsize kPartBytes = 1 << 20;

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) {
    throw system_error(ErrorKind::cannot_create, folder, "cannot create the folder",
                       failure.value());
  }
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  std::error_code failure;
  if (!fs::is_regular_file(b, failure) || fs::file_size(a) != fs::file_size(b)) return false;
  std::ifstream left(a, std::ios::binary), right(b, std::ios::binary);
  std::vector<char> left_part(kPartBytes), right_part(kPartBytes);
  while (left && right) {
    left.read(left_part.data(), kPartBytes);
    right.read(right_part.data(), kPartBytes);
    if (left.gcount() != right.gcount() ||
        !std::equal(left_part.begin(), left_part.begin() + left.gcount(), right_part.begin())) {
      return false;
    }
  }
  return left.eof() && right.eof();
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
    write_file(folder_ / kContentFile, content_text("compare", {{"title", title}}));
    // Behind it: a run that is killed between them must not meet a foreign folder next time.
    make_folder(work());
    make_folder(pictures());
  } catch (...) {
    close(lock_);
    throw;
  }
}

WorkFolder::~WorkFolder() { close(lock_); }

void write_if_changed(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path fresh = file.parent_path() / ("new-" + file.filename().string());
  write(fresh);
  if (same_bytes(fresh, file)) {
    fs::remove(fresh);
  } else {
    fs::rename(fresh, file);
  }
}

}  // namespace adasplats
