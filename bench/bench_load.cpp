// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// What loading a drive costs: seconds of its parts, processor time and peak memory, with one thread
// and with several, each load in a process of its own, and from both the share that does not get
// faster with threads (Amdahl). With --beside the same program of another build takes turns.
// All of them have to load the very same bytes. Shares need a machine that does nothing else;
// ratios of processor time do not.
//   bench_load DRIVE [--trajectory FILE] [--rounds N] [--threads N] [--beside PROGRAM] [--json
//   FILE]

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/child_process.h"
#include "adasplats/core/memory.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/provenance.h"

namespace adasplats {

namespace {

struct Options {
  std::string drive;
  int rounds = 5;
  int threads = 0;
  bool once = false;  ///< loads once and prints the figures as a line of JSON
  std::string trajectory, beside, json;
};

double seconds_of(timeval time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

template <class T>
void add_bytes(const std::vector<T>& values, std::uint32_t& hash) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  constexpr std::uint32_t kPrime = 16'777'619;  // FNV-1a
  for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) hash = (hash ^ bytes[i]) * kPrime;
}

/// Of every byte of a cloud; no struct of it has gaps.
std::uint32_t fingerprint_of(const PointCloud& cloud) {
  std::uint32_t hash = 2'166'136'261;
  add_bytes(std::vector<Vec3d>{cloud.origin}, hash);
  add_bytes(cloud.positions, hash);
  for_each_attribute([&](const auto& attribute) { add_bytes(attribute.of(cloud), hash); });
  add_bytes(cloud.scan_poses, hash);
  add_bytes(cloud.empty_beams, hash);
  return hash;
}

nlohmann::json loaded_once(const Options& options) {
  const Executor executor(options.threads);
  ProgressSink silent;
  LoadOptions load;
  load.empty_beams = true;
  load.trajectory = options.trajectory;
  const Stopwatch watch;
  const std::filesystem::path input = options.drive;
  const auto [cloud, report] = load_cloud({&input, 1}, load, executor, silent);
  nlohmann::json figures = {{"seconds", watch.seconds()}};
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  figures["processor seconds"] = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  figures["of these the system's"] = seconds_of(used.ru_stime);
  figures["page faults"] = used.ru_minflt;
  figures["peak memory, MB"] = static_cast<double>(peak_memory_bytes()) / 1e6;
  for (const LoadReport::PartTime& part : report.seconds) figures[part.name] = part.seconds;
  figures["points"] = cloud.size();
  figures["empty beams"] = cloud.empty_beams.size();
  figures["fingerprint"] = fingerprint_of(cloud);
  return figures;
}

/// What a program's `--once` says.
nlohmann::json figures_of(const std::string& program, const Options& options, int threads) {
  const std::filesystem::path log =
      std::filesystem::temp_directory_path() / ("bench_load." + std::to_string(::getpid()));
  ProgressSink silent;
  const ChildResult result =
      run_child({{program, options.drive, "--once", "1", "--threads", std::to_string(threads),
                  "--trajectory", options.trajectory},
                 {},
                 log},
                silent);
  const std::string text = read_file(log);
  std::filesystem::remove(log);
  if (result.end != ChildEnd::done) throw std::runtime_error(program + ": " + text);
  return nlohmann::json::parse(text);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Medians of the rounds of one program with so many threads.
struct Row {
  std::string program;
  int threads;
  std::map<std::string, std::vector<double>> rounds = {};

  double of(const std::string& name) const { return median(rounds.at(name)); }
};

/// Of the time with one thread what `threads` of them do not share.
double serial_share(const Row& one, const Row& all, const std::string& name) {
  const double n = all.threads, left = all.of(name) / one.of(name);
  return std::clamp((left - 1 / n) / (1 - 1 / n), 0.0, 1.0);
}

std::vector<Row> measured(const Options& options, const std::string& self, int threads) {
  std::vector<Row> rows;
  std::vector<std::string> programs = {self};
  if (!options.beside.empty()) programs.push_back(options.beside);
  for (const std::string& program : programs)
    for (const int count : {1, threads}) rows.push_back({program, count});
  for (int round = 0; round < options.rounds; ++round)
    for (Row& row : rows) {
      const nlohmann::json figures = figures_of(row.program, options, row.threads);
      for (const auto& [name, value] : figures.items())
        row.rounds[name].push_back(value.get<double>());
    }
  return rows;
}

void run(const Options& options, const std::string& self) {
  if (options.once) {
    std::printf("%s\n", loaded_once(options).dump().c_str());
    return;
  }
  const int threads = Executor(options.threads).threads();
  const std::vector<Row> rows = measured(options, self, threads);
  for (const Row& row : rows)
    for (const double fingerprint : row.rounds.at("fingerprint"))
      if (fingerprint != rows.front().rounds.at("fingerprint").front())
        throw std::runtime_error(row.program + " loads other bytes");
  std::printf("medians of %d rounds; columns: ", options.rounds);
  for (const Row& row : rows) std::printf("[%s, %d threads] ", row.program.c_str(), row.threads);
  std::printf("\n");
  nlohmann::ordered_json figures;
  for (const auto& [name, values] : rows.front().rounds) {
    std::printf("%-24s", name.c_str());
    for (const Row& row : rows) {
      std::printf(" %14.3f", row.of(name));
      figures[row.program][std::to_string(row.threads)][name] = row.of(name);
    }
    if (rows.size() == 4 && rows[2].of(name) > 0 && rows[3].of(name) > 0)
      std::printf("   %.2f and %.2f of before", rows[0].of(name) / rows[2].of(name),
                  rows[1].of(name) / rows[3].of(name));
    std::printf("\n");
  }
  for (std::size_t k = 0; k + 1 < rows.size(); k += 2) {
    const double share = serial_share(rows[k], rows[k + 1], "seconds");
    figures[rows[k].program]["serial_share"] = share;
    std::printf("serial share %.3f, %.2f s of one thread's: %s\n", share,
                share * rows[k].of("seconds"), rows[k].program.c_str());
  }
  if (options.json.empty()) return;
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(threads))},
                                         {"rounds", options.rounds},
                                         {"figures", figures}};
  write_file(options.json, result.dump(2) + "\n");
}

Options parse(int argc, char** argv) {
  if (argc < 2) throw std::runtime_error("which drive?");
  Options options;
  options.drive = argv[1];
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (i + 1 >= argc) throw std::runtime_error(word + " is unknown or needs a value");
    const std::string value = argv[++i];
    if (word == "--rounds") {
      options.rounds = std::max(1, std::stoi(value));
    } else if (word == "--threads") {
      options.threads = std::stoi(value);
    } else if (word == "--once") {
      options.once = value != "0";
    } else if (word == "--trajectory") {
      options.trajectory = value;
    } else if (word == "--beside") {
      options.beside = value;
    } else if (word == "--json") {
      options.json = value;
    } else {
      throw std::runtime_error("unknown option " + word);
    }
  }
  return options;
}

}  // namespace

}  // namespace adasplats

int main(int argc, char** argv) {
  try {
    adasplats::run(adasplats::parse(argc, argv), argv[0]);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_load: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
