// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Scans a second that become files, without any casting: a revolution of an HDL-64 (144,000 rays,
// 110,000 returns with intensity, class, ring, time and range) again and again, in every format.
//
//   bench_writers FOLDER [--scans N] [--threads A,B] [--formats A,B] [--atomic] [--no-hash]
//
// FOLDER is made and removed; in /dev/shm it measures the processor, elsewhere the disk as well.
// Without --atomic and with hashes: what 'adasplats simulate' does. Prints JSON.

#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/stopwatch.h"
#include "adasplats/core/words.h"
#include "adasplats/dataset/parallel_scan_writer.h"

namespace adasplats {
namespace {

struct Options {
  std::filesystem::path folder;
  std::size_t scans = 200;
  std::vector<std::string> threads = {"1", "2"};
  std::vector<std::string> formats;
  bool atomic = false;
  bool hashed = true;
};

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

Options parse(int argc, char** argv) {
  Options options;
  for (const auto& [word, format] : kScanFormats) options.formats.emplace_back(word);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--atomic") {
      options.atomic = true;
    } else if (word == "--no-hash") {
      options.hashed = false;
    } else if (word == "--scans" && i + 1 < argc) {
      options.scans = std::stoul(argv[++i]);
    } else if (word == "--threads" && i + 1 < argc) {
      options.threads = parts_of(argv[++i]);
    } else if (word == "--formats" && i + 1 < argc) {
      options.formats = parts_of(argv[++i]);
    } else {
      options.folder = word;
    }
  }
  if (options.folder.empty())
    throw std::runtime_error(
        "usage: bench_writers FOLDER [--scans N] [--threads A,B] [--formats A,B] [--atomic] "
        "[--no-hash]");
  return options;
}

constexpr std::size_t kRings = 64, kColumns = 2250, kReturns = 110000;

/// Ranges that change slowly from column to column, as those of streets do, with noise of 2 cm.
Scan synthetic_scan() {
  Scan scan;
  scan.rays = kRings * kColumns;
  std::uint32_t noise = 1;
  for (std::size_t i = 0; i < kReturns; ++i) {
    const std::size_t firing = i * scan.rays / kReturns;
    const std::size_t ring = firing / kColumns, column = firing % kColumns;
    noise = noise * 1664525U + 1013904223U;
    const float azimuth = 6.2831853F * static_cast<float>(column) / kColumns;
    const float elevation = 0.035F - 0.0073F * static_cast<float>(ring);
    const float range =
        12 + 8 * std::sin(3 * azimuth) + 0.02F * static_cast<float>(noise >> 24) / 256;
    scan.positions.push_back({range * std::cos(elevation) * std::cos(azimuth),
                              range * std::cos(elevation) * std::sin(azimuth),
                              range * std::sin(elevation)});
    scan.ranges_m.push_back(range);
    scan.intensities.push_back(static_cast<float>(noise >> 16) / 65536);
    scan.classes.push_back(static_cast<std::uint16_t>(40 + column / 250));
    scan.rings.push_back(static_cast<std::uint16_t>(ring));
    scan.columns.push_back(static_cast<std::uint32_t>(column));
    scan.times_s.push_back(0.1F * static_cast<float>(column) / kColumns);
  }
  return scan;
}

std::uintmax_t bytes_in(const std::filesystem::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

/// Of this process, all threads: what other work on the machine leaves as it is.
struct CpuTime {
  double user_s, system_s;
};
CpuTime cpu_time() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {seconds(used.ru_utime), seconds(used.ru_stime)};
}

nlohmann::ordered_json measure(const Options& options, ScanFormat format, int threads,
                               const Scan& scan) {
  std::filesystem::remove_all(options.folder);
  std::filesystem::create_directories(options.folder);
  ScanWriterOptions writing;
  writing.image_size = {kRings, kColumns};
  writing.labels = &semantickitti_labels();
  const Stopwatch watch;
  const CpuTime before = cpu_time();
  const auto writer = make_scan_writer(options.folder, format, writing);
  ParallelWriteOptions parallel;
  parallel.threads = threads;
  parallel.writes = options.atomic ? FileWrites::atomic : FileWrites::in_place;
  parallel.hashed = options.hashed;
  ParallelScanWriter files(*writer, parallel);
  for (std::size_t i = 0; i < options.scans; ++i) {
    ScanView next = scan;
    next.time_s = 0.1 * static_cast<double>(i);
    files.write(i, {next, nullptr});
  }
  files.finish();
  const double seconds = watch.seconds();
  const CpuTime after = cpu_time();
  const auto scans = static_cast<double>(options.scans);
  nlohmann::ordered_json json = {
      {"format", word_of(format, kScanFormats)},
      {"threads", threads},
      {"scans_per_second", scans / seconds},
      {"user_ms_per_scan", 1e3 * (after.user_s - before.user_s) / scans},
      {"system_ms_per_scan", 1e3 * (after.system_s - before.system_s) / scans},
      {"bytes_per_scan", bytes_in(options.folder) / options.scans}};
  std::filesystem::remove_all(options.folder);
  return json;
}

void run(const Options& options) {
  const Scan scan = synthetic_scan();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::string& name : options.formats) {
    for (const auto& [word, format] : kScanFormats) {
      if (word != name) continue;
      for (const std::string& threads : options.threads)
        rows.push_back(measure(options, format, std::stoi(threads), scan));
    }
  }
  const nlohmann::ordered_json json = {{"rays", scan.rays},        {"returns", scan.size()},
                                       {"scans", options.scans},   {"atomic", options.atomic},
                                       {"hashed", options.hashed}, {"rows", rows}};
  std::printf("%s\n", json.dump(2).c_str());
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  try {
    adasplats::run(adasplats::parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_writers: %s\n", error.what());
    return 1;
  }
}
