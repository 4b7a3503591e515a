// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/list_folder.h"

#include <dirent.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <string_view>
#include <system_error>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

struct CloseFolder {
  void operator()(DIR* folder) const { ::closedir(folder); }
};
using OpenFolder = std::unique_ptr<DIR, CloseFolder>;

std::vector<std::filesystem::path> entries_of(DIR* open, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  while (true) {
    errno = 0;
    const dirent* const entry = ::readdir(open);
    if (entry == nullptr) break;
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..") entries.push_back(folder / name);
  }
  if (errno != 0) throw system_error(ErrorKind::io, folder, "cannot be listed", errno);
  std::ranges::sort(entries);
  return entries;
}

}  // namespace

std::vector<std::filesystem::path> list_folder(const std::filesystem::path& folder) {
  const OpenFolder open(::opendir(folder.c_str()));
  if (!open) throw system_error(ErrorKind::no_input, folder, "cannot be listed", errno);
  return entries_of(open.get(), folder);
}

std::vector<std::filesystem::path> list_folder_if_any(const std::filesystem::path& folder) {
  const OpenFolder open(::opendir(folder.c_str()));
  if (open) return entries_of(open.get(), folder);
  if (errno != ENOENT && errno != ENOTDIR && errno != EACCES)
    throw system_error(ErrorKind::no_input, folder, "cannot be listed", errno);
  return {};
}

std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : list_folder(folder)) {
    std::error_code gone;  // or a broken link
    if (std::filesystem::is_regular_file(path, gone)) files.push_back(path);
    if (std::filesystem::symlink_status(path, gone).type() != std::filesystem::file_type::directory)
      continue;
    const std::vector<std::filesystem::path> deeper = files_below(path);
    files.insert(files.end(), deeper.begin(), deeper.end());
  }
  return files;
}

}  // namespace adasplats
