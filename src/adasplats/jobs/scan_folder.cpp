// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scan_folder.h"

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

/// Of the rays that a scan has; with fewer returns a place is hardly worth a drive.
constexpr double kMinShareOfReturns = 0.1;

/// The number that a file's name begins with, which is that of its scan, however many digits the
/// data set gives it; nothing for others.
std::optional<std::size_t> scan_of_file(const std::string& name) {
  const std::string file = std::filesystem::path(name).filename().string();
  return parse_number<std::size_t>(file.substr(0, file.find_first_not_of("0123456789")));
}

/// "1.25 GB".
std::string size_text(double bytes) {
  std::array<char, 32> text{};
  const bool is_large = bytes >= 1e9;
  std::snprintf(text.data(), text.size(), is_large ? "%.2f GB" : "%.2f MB",
                bytes / (is_large ? 1e9 : 1e6));
  return text.data();
}

}  // namespace

std::size_t keep_written_scans(ScanWriter& writer, const ResumableFolder& folder,
                               std::span<const ScanMotion> scans) {
  std::map<std::size_t, std::vector<std::string>> files;
  for (const auto& [name, digest] : folder.recorded())
    if (const auto scan = scan_of_file(name)) files[*scan].push_back(name);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    // Files of a scan are noted in one go, the main one last: where it is noted, all are.
    const std::string main_file = writer.main_file(i);
    if (main_file.empty() || !folder.recorded().contains(main_file)) return i;
    if (!folder.has(files[i])) return i;
    writer.keep(i, scans[i].reference);
  }
  return scans.size();
}

void ScanJournal::note(std::size_t points, std::span<const FileDigest> files) {
  if (points == 0 && folder_.recorded().empty()) {
    held_back_.insert(held_back_.end(), files.begin(), files.end());
    return;
  }
  if (!held_back_.empty()) folder_.record(held_back_);
  held_back_.clear();
  if (!files.empty()) folder_.record(files);
}

void require_disk_space(const std::filesystem::path& folder, ScanFormat format, std::size_t scans,
                        std::size_t rays_per_scan, int returns_per_ray) {
  std::error_code problem;
  const std::filesystem::space_info space = std::filesystem::space(folder, problem);
  if (problem) throw system_error(ErrorKind::io, folder, "cannot be looked at", problem.value());
  const ScanBytes bytes = scan_bytes(format);
  const double rays = static_cast<double>(scans) * static_cast<double>(rays_per_scan);
  const double least = rays * (kMinShareOfReturns * bytes.min_a_return + bytes.min_a_ray);
  const double most = rays * (returns_per_ray * bytes.max_a_return + bytes.max_a_ray);
  if (least <= static_cast<double>(space.available)) return;
  throw Error(ErrorKind::io, folder.string() + ": no room: " + std::to_string(scans) +
                                 " scans need " + size_text(least) + " if " +
                                 std::to_string(static_cast<int>(100 * kMinShareOfReturns)) +
                                 " % of the rays return, and up to " + size_text(most) + "; " +
                                 size_text(static_cast<double>(space.available)) + " are free");
}

void rethrow_with_what_is_kept(const ResumableFolder& folder) {
  try {
    throw;
  } catch (const Error& error) {
    const bool is_output =
        error.kind() == ErrorKind::io || error.kind() == ErrorKind::cannot_create;
    if (!is_output || folder.recorded().empty()) throw;
    throw Error(error.kind(), std::string(error.what()) + "; the whole scans before it stay in " +
                                  folder.path().string() + ", where the same command goes on");
  }
}

}  // namespace adasplats
