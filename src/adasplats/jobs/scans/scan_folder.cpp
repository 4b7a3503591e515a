// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/scan_folder.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/output/unfinished_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Of the rays of a scan: the fewest returns that a useful simulation has.
constexpr double kMinShareOfReturns = 0.1;

constexpr const char* kSpansFolder = "spans";
constexpr const char* kSpansBegun = "spans/begun";
constexpr std::string_view kNoteEnding = ".sha256";
constexpr std::string_view kEmptyEnding = ".empty.sha256";

ParallelWriteOptions recorder_options(ParallelWriteOptions options, const Session& session) {
  options.threads = session.executor.threads();
  options.writes = FileWrites::in_place;
  options.hashed = true;
  return options;
}

/// The number at the beginning of a file's name, which is that of its scan or its time; nothing for
/// other files.
std::optional<std::size_t> scan_of_file(const std::string& name) {
  const std::string file = fs::path(name).filename().string();
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

/// "12.3".
std::string decimetres(double metres) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f", metres);
  return text.data();
}

fs::path note_of_span(const fs::path& folder, std::size_t first, std::size_t count, bool is_empty) {
  std::string name = std::to_string(first) + "-" + std::to_string(count);
  name += is_empty ? kEmptyEnding : kNoteEnding;
  return folder / kSpansFolder / name;
}

std::set<fs::path> files_of_spans(const fs::path& folder) {
  const std::vector<fs::path> files = list_folder_if_any(folder / kSpansFolder);
  return {files.begin(), files.end()};
}

bool are_unchanged(const fs::path& folder, const std::vector<FileDigest>& files) {
  return std::ranges::all_of(files, [&](const FileDigest& file) {
    std::error_code none;
    return fs::is_regular_file(folder / file.name, none) &&
           sha256_of_file(folder / file.name) == file.sha256;
  });
}

}  // namespace

ScanRecorder::ScanRecorder(ScanWriter& writer, ParallelWriteOptions options, std::size_t done,
                           Session& session)
    : session_(session),
      files_(writer, recorder_options(std::move(options), session)),
      done_(done) {}

ReportTimes ScanRecorder::record(ScanSimulator& simulator, std::span<const ScanMotion> scans,
                                 std::size_t first, std::size_t count, std::uint64_t number,
                                 const SensorOfRig& sensor) {
  return simulator.run_held(scans.subspan(first, count), number,
                            [&](std::size_t i, HeldScan&& held) {
                              rays_ += held.scan.rays;
                              hits_ += held.scan.size();
                              files_.write(sensor.number(first + i), std::move(held));
                              session_.progress.advance(++done_);
                            });
}

std::size_t keep_written_scans(ScanWriter& writer, const ResumableFolder& folder,
                               std::span<const ScanMotion> scans, const SensorOfRig& sensor) {
  std::map<std::size_t, std::vector<std::string>> files;
  for (const auto& [name, digest] : folder.recorded())
    if (const auto scan = scan_of_file(name); scan && name.starts_with(sensor.folder))
      files[*scan].push_back(name);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    // The files of a scan are recorded together, the main one last: if it is there, all are.
    const std::string main_file = writer.main_file(sensor.number(i));
    if (main_file.empty() || !folder.recorded().contains(main_file)) return i;
    const std::size_t number = *scan_of_file(main_file);
    if (!folder.has(files[number]) || (number != i && !folder.has(files[i]))) return i;
    writer.keep(sensor.number(i), scans[i].reference);
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

void require_disk_space(const fs::path& folder, ScanFormat format, std::size_t scans,
                        std::size_t rays_per_scan, int returns_per_ray) {
  std::error_code problem;
  const fs::space_info space = fs::space(folder, problem);
  if (problem)
    throw system_error(ErrorKind::io, folder, "cannot read the free disk space", problem.value());
  const ScanBytes bytes = scan_bytes(format);
  const double rays = static_cast<double>(scans) * static_cast<double>(rays_per_scan);
  const double min_bytes = rays * (kMinShareOfReturns * bytes.min_a_return + bytes.min_a_ray);
  const double max_bytes = rays * (returns_per_ray * bytes.max_a_return + bytes.max_a_ray);
  if (min_bytes <= static_cast<double>(space.available)) return;
  throw Error(ErrorKind::io, folder.string() + ": not enough disk space: " + std::to_string(scans) +
                                 " scans need " + size_text(min_bytes) + " if " +
                                 std::to_string(static_cast<int>(100 * kMinShareOfReturns)) +
                                 " % of the rays return, and up to " + size_text(max_bytes) + "; " +
                                 size_text(static_cast<double>(space.available)) + " are free");
}

void throw_no_returns(std::size_t rays, const ScanScene& scene, std::span<const ScanMotion> scans,
                      const LidarModel& sensor, const std::string& question) {
  const auto [low, high] = scene.middle_box();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const ScanMotion& scan : scans) {
    const Vec3d at = scan.reference.world_from_sensor.translation;
    nearest_m = std::min(nearest_m, length(max(max(low - at, at - high), Vec3d{})));
  }
  throw Error(ErrorKind::data, "no returns: none of " + std::to_string(rays) + " rays in " +
                                   std::to_string(scans.size()) +
                                   " scans hit anything; the sensor is at least " +
                                   decimetres(nearest_m) + " m from the model's box and measures " +
                                   decimetres(sensor.min_range_m) + " to " +
                                   decimetres(sensor.max_range_m) + " m (" + question + ")");
}

void rethrow_with_kept_scans(const ResumableFolder& folder) {
  try {
    throw;
  } catch (const Error& error) {
    const bool is_output =
        error.kind() == ErrorKind::io || error.kind() == ErrorKind::cannot_create;
    if (!is_output || folder.recorded().empty()) throw;
    throw Error(error.kind(), std::string(error.what()) + "; the scans written so far stay in " +
                                  folder.path().string() + "; the same command resumes there");
  }
}

void begin_spans(ResumableFolder& folder) {
  if (folder.has(kSpansBegun)) return;
  fs::create_directories(folder.path() / kSpansFolder);
  write_file_in_place(folder.path() / kSpansBegun, "");
  folder.record(std::string(kSpansBegun));
}

void note_span(const fs::path& folder, std::size_t first, std::size_t count,
               std::span<const FileDigest> files, bool is_empty) {
  write_digests(note_of_span(folder, first, count, is_empty), files);
}

bool has_span(const fs::path& folder, std::size_t first, std::size_t count) {
  for (const bool is_empty : {false, true}) {
    const auto noted = read_digests(note_of_span(folder, first, count, is_empty));
    if (noted && are_unchanged(folder, *noted)) return true;
  }
  return false;
}

void record_spans(ResumableFolder& folder) {
  std::vector<FileDigest> files;
  bool is_empty = true;
  for (const fs::path& note : files_of_spans(folder.path())) {
    const std::string name = note.filename().string();
    const auto noted = name.ends_with(kNoteEnding) ? read_digests(note) : std::nullopt;
    if (!noted) continue;
    is_empty = is_empty && name.ends_with(kEmptyEnding);
    for (const FileDigest& file : *noted) {
      const auto recorded = folder.recorded().find(file.name);
      if (recorded == folder.recorded().end() || recorded->second != file.sha256)
        files.push_back(file);
    }
  }
  if (!is_empty && !files.empty()) folder.record(files);
}

std::vector<std::string> span_note_files(const fs::path& folder) {
  std::vector<std::string> notes;
  const std::set<fs::path> files = files_of_spans(folder);
  notes.reserve(files.size() + 1);
  for (const fs::path& file : files)
    notes.push_back(std::string(kSpansFolder) + "/" + file.filename().string());
  if (!files.empty()) notes.emplace_back(kSpansFolder);  // after its content
  return notes;
}

}  // namespace adasplats
