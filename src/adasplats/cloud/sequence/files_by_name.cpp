// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/files_by_name.h"

#include <algorithm>

#include "adasplats/core/error.h"

namespace adasplats {

std::vector<std::filesystem::path> files_by_name(const std::filesystem::path& folder,
                                                 const std::string& extension) {
  std::vector<std::filesystem::path> files;
  std::error_code problem;
  if (!std::filesystem::is_directory(folder, problem)) return files;
  std::filesystem::directory_iterator entry(folder, problem);
  for (; !problem && entry != std::filesystem::directory_iterator(); entry.increment(problem)) {
    const std::filesystem::path& path = entry->path();
    // A leading dot marks files that are being written or belong to some tool.
    if (path.extension() == extension && path.filename().string().front() != '.')
      files.push_back(path);
  }
  if (problem) throw system_error(ErrorKind::no_input, folder, "cannot be listed", problem.value());
  std::ranges::sort(files);
  return files;
}

std::optional<std::size_t> number_in_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  constexpr std::size_t kMaxDigits = 18;  // fits 64 bits
  if (stem.empty() || stem.size() > kMaxDigits) return std::nullopt;
  std::size_t number = 0;
  for (const char c : stem) {
    if (c < '0' || c > '9') return std::nullopt;
    number = 10 * number + static_cast<std::size_t>(c - '0');
  }
  return number;
}

}  // namespace adasplats
