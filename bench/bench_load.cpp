// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// The cost of loading a drive: seconds of its parts, processor time and peak memory, with one
// thread and with several, each load in its own process; also the serial share, which does not get
// faster with threads (Amdahl). --beside alternates with the same program of another build. All
// programs must load the same bytes. The serial share needs an idle machine; ratios of processor
// time do not.
//   bench_load DRIVE [--trajectory FILE] [--rounds N] [--threads N] [--beside PROGRAM] [--once 1]
//              [--json FILE]
// --once loads once and prints the figures as a line of JSON.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/child_process.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/memory.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "common.h"

namespace adasplats {
namespace {

double seconds_of(timeval time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

template <class T>
void add_bytes(const std::vector<T>& values, std::uint32_t& hash) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  constexpr std::uint32_t kPrime = 16'777'619;  // FNV-1a
  for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) hash = (hash ^ bytes[i]) * kPrime;
}

/// Hash of all bytes of a cloud; its structs have no padding.
std::uint32_t fingerprint_of(const PointCloud& cloud) {
  std::uint32_t hash = 2'166'136'261;
  add_bytes(std::vector<Vec3d>{cloud.origin}, hash);
  add_bytes(cloud.positions, hash);
  for_each_attribute([&](const auto& attribute) { add_bytes(attribute.of(cloud), hash); });
  add_bytes(cloud.scan_poses, hash);
  add_bytes(cloud.empty_beams, hash);
  return hash;
}

nlohmann::json load_once(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  ProgressSink silent;
  LoadOptions load;
  load.empty_beams = true;
  load.trajectory = arguments.text("--trajectory");
  const Stopwatch watch;
  const std::filesystem::path input = arguments.input(0);
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

/// Output of a program with --once.
nlohmann::json figures_of(const std::string& program, const bench::Arguments& arguments,
                          int threads) {
  const std::filesystem::path log =
      std::filesystem::temp_directory_path() / ("bench_load." + std::to_string(::getpid()));
  ProgressSink silent;
  const ChildResult result =
      run_child({{program, arguments.input(0), "--once", "1", "--threads", std::to_string(threads),
                  "--trajectory", arguments.text("--trajectory")},
                 {},
                 log},
                silent);
  const std::string text = read_file(log);
  std::filesystem::remove(log);
  if (result.end != ChildEnd::done) throw std::runtime_error(program + ": " + text);
  return nlohmann::json::parse(text);
}

/// Figures of one program with a number of threads, by round.
struct Row {
  std::string program;
  int threads;
  std::map<std::string, std::vector<double>> rounds = {};

  double of(const std::string& name) const { return upper_median_of(std::vector(rounds.at(name))); }
};

/// Share of the time with one thread that does not get faster with more threads.
double serial_share(const Row& one, const Row& all, const std::string& name) {
  const double n = all.threads, left = all.of(name) / one.of(name);
  return std::clamp((left - 1 / n) / (1 - 1 / n), 0.0, 1.0);
}

std::vector<Row> measure(const bench::Arguments& arguments, const std::string& self, int rounds,
                         int threads) {
  std::vector<Row> rows;
  std::vector<std::string> programs = {self};
  if (arguments.has("--beside")) programs.push_back(arguments.text("--beside"));
  for (const std::string& program : programs)
    for (const int count : {1, threads}) rows.push_back({program, count});
  for (int round = 0; round < rounds; ++round)
    for (Row& row : rows) {
      const nlohmann::json figures = figures_of(row.program, arguments, row.threads);
      for (const auto& [name, value] : figures.items())
        row.rounds[name].push_back(value.get<double>());
    }
  return rows;
}

void run(const bench::Arguments& arguments, const std::string& self) {
  if (arguments.has("--once")) {
    std::printf("%s\n", load_once(arguments).dump().c_str());
    return;
  }
  const int threads = Executor(arguments.number("--threads", 0)).threads();
  const int rounds = std::max(1, arguments.number("--rounds", 5));
  const std::vector<Row> rows = measure(arguments, self, rounds, threads);
  for (const Row& row : rows)
    for (const double fingerprint : row.rounds.at("fingerprint"))
      if (fingerprint != rows.front().rounds.at("fingerprint").front())
        throw std::runtime_error(row.program + " loads different bytes");
  std::printf("medians of %d rounds; columns: ", rounds);
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
      std::printf("   ratios %.2f and %.2f", rows[0].of(name) / rows[2].of(name),
                  rows[1].of(name) / rows[3].of(name));
    std::printf("\n");
  }
  for (std::size_t k = 0; k + 1 < rows.size(); k += 2) {
    const double share = serial_share(rows[k], rows[k + 1], "seconds");
    figures[rows[k].program]["serial_share"] = share;
    std::printf("serial share %.3f, %.2f s with one thread: %s\n", share,
                share * rows[k].of("seconds"), rows[k].program.c_str());
  }
  if (!arguments.has("--json")) return;
  const nlohmann::ordered_json result = {
      {"provenance", to_json(provenance_of(threads))}, {"rounds", rounds}, {"figures", figures}};
  write_file(arguments.text("--json"), result.dump(2) + "\n");
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_load", [&] {
    adasplats::run({argc, argv,
                    "bench_load DRIVE [--trajectory FILE] [--rounds N] [--threads N] "
                    "[--beside PROGRAM] [--once 1] [--json FILE]",
                    1, 1},
                   argv[0]);
  });
}
