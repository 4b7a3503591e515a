// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Million points per second of reading LAS and LAZ files: all of read_las() (from the file to
// columns) and its decoder alone (from chunks to records, only LAZ), for several numbers of
// threads, and LASzip's reader if its library is installed (liblaszip8 of Debian 13;
// single-threaded). All alternate in rounds; the first round, which brings the files into memory,
// is not counted. LASzip must find the same coordinates.
//
//   bench_laz FILE... [--threads A,B] [--rounds N] [--laszip LIBRARY] [--json FILE]

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/laz_layout.h"
#include "adasplats/io/laz/packed_chunk.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "common.h"

namespace adasplats {
namespace {

/// The reading functions of LASzip's interface; they return 0 on success.
class Laszip {
 public:
  /// nullopt if the library is missing.
  static std::optional<Laszip> open(const std::string& library) {
    void* const handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) return std::nullopt;
    return Laszip(handle);
  }

  /// Reads all points; returns the sum of their coordinates.
  double read(const std::filesystem::path& file, std::uint64_t points) const {
    void* reader = nullptr;
    std::int32_t is_compressed = 0;
    require(create_(&reader) == 0 && open_(reader, file.c_str(), &is_compressed) == 0, file);
    double sum = 0;
    double coordinates[3] = {};
    for (std::uint64_t i = 0; i < points; ++i) {
      require(read_(reader) == 0 && coordinates_(reader, coordinates) == 0, file);
      sum += coordinates[0] + coordinates[1] + coordinates[2];
    }
    close_(reader);
    destroy_(reader);
    return sum;
  }

 private:
  explicit Laszip(void* handle) {
    find(handle, "laszip_create", create_);
    find(handle, "laszip_open_reader", open_);
    find(handle, "laszip_read_point", read_);
    find(handle, "laszip_get_coordinates", coordinates_);
    find(handle, "laszip_close_reader", close_);
    find(handle, "laszip_destroy", destroy_);
  }
  template <class Function>
  static void find(void* handle, const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(::dlsym(handle, name));
    if (function == nullptr) throw std::runtime_error(std::string("LASzip lacks ") + name);
  }
  static void require(bool good, const std::filesystem::path& file) {
    if (!good) throw std::runtime_error("LASzip cannot read " + file.string());
  }

  std::int32_t (*create_)(void**) = nullptr;
  std::int32_t (*open_)(void*, const char*, std::int32_t*) = nullptr;
  std::int32_t (*read_)(void*) = nullptr;
  std::int32_t (*coordinates_)(void*, double*) = nullptr;
  std::int32_t (*close_)(void*) = nullptr;
  std::int32_t (*destroy_)(void*) = nullptr;
};

double sum_of(const Table& table) {
  double sum = 0;
  for (const char* const name : {"x", "y", "z"})
    for (const double value : std::get<std::vector<double>>(table.find(name)->values)) sum += value;
  return sum;
}

/// Decodes every chunk into records, which are dropped; returns the number of complete ones.
std::uint64_t unpack(const std::filesystem::path& file, const Executor& executor) {
  const LazLayout layout = read_laz_layout(file, false);
  const std::string bytes = read_file(file);
  const std::span<const std::byte> all(reinterpret_cast<const std::byte*>(bytes.data()),
                                       bytes.size());
  return executor.sum_chunks(
      layout.chunks.size(), 1, std::uint64_t{0}, [&](std::size_t begin, std::size_t end) {
        std::uint64_t complete = 0;
        for (std::size_t k = begin; k < end; ++k) {
          const LazChunk& chunk = layout.chunks[k];
          const auto points = static_cast<std::size_t>(chunk.points);
          std::vector<std::byte> records(points * layout.packing.record_bytes);
          const auto decoder = make_packed_chunk(
              layout.packing, all.subspan(static_cast<std::size_t>(chunk.offset_bytes),
                                          static_cast<std::size_t>(chunk.bytes)));
          complete += decoder->decode(records.data(), points);
        }
        return complete;
      });
}

/// One reader of a file.
struct Contender {
  std::string name;
  int threads;
  std::function<void()> read;
  std::vector<double> seconds = {};

  double median_s() { return upper_median_of(seconds); }
};

std::vector<Contender> contenders_of(const std::filesystem::path& file, const LasFacts& facts,
                                     const std::vector<std::unique_ptr<Executor>>& executors,
                                     const std::optional<Laszip>& laszip) {
  std::vector<Contender> contenders;
  const double expected = sum_of(read_las(file));
  const bool is_packed = file.extension() == ".laz";
  for (const auto& executor : executors) {
    const Executor& threads = *executor;
    contenders.push_back({"read_las", threads.threads(), [&file, &threads, points = facts.points] {
                            LasReadOptions options;
                            options.executor = &threads;
                            if (read_las(file, options).rows > points)
                              throw std::runtime_error("too many points");
                          }});
    if (!is_packed) continue;
    contenders.push_back({"decoder", threads.threads(), [&file, &threads, points = facts.points] {
                            if (unpack(file, threads) != points)
                              throw std::runtime_error("points are missing");
                          }});
  }
  if (laszip)
    contenders.push_back({"LASzip", 1, [&file, &laszip, expected, points = facts.points] {
                            const double sum = laszip->read(file, points);
                            if (!(std::fabs(sum - expected) <= 1e-9 * std::fabs(expected)))
                              throw std::runtime_error("LASzip returns other coordinates");
                          }});
  return contenders;
}

nlohmann::ordered_json measure(const std::filesystem::path& file, int rounds,
                               const std::vector<std::unique_ptr<Executor>>& executors,
                               const std::optional<Laszip>& laszip) {
  const LasFacts facts = read_las_facts(file);
  std::vector<Contender> contenders = contenders_of(file, facts, executors, laszip);
  // Small files are read repeatedly, so that a round takes at least 0.1 s.
  constexpr double kMin_s = 0.1;
  for (int round = -1; round < rounds; ++round)
    for (Contender& contender : contenders) {
      int times = 0;
      const Stopwatch watch;
      do {
        contender.read();
        ++times;
      } while (watch.seconds() < kMin_s);
      if (round >= 0) contender.seconds.push_back(watch.seconds() / times);
    }
  nlohmann::ordered_json json = {{"file", file.filename().string()},
                                 {"points", facts.points},
                                 {"point_format", facts.point_format},
                                 {"bytes", std::filesystem::file_size(file)},
                                 {"million_points_per_second", nlohmann::ordered_json::object()}};
  std::printf("%s: %llu points, format %zu\n", file.filename().c_str(),
              static_cast<unsigned long long>(facts.points), facts.point_format);
  for (Contender& contender : contenders) {
    const double rate = 1e-6 * static_cast<double>(facts.points) / contender.median_s();
    std::printf("  %-10s %d thread%s  %8.2f M points/s\n", contender.name.c_str(),
                contender.threads, contender.threads == 1 ? " " : "s", rate);
    json["million_points_per_second"][contender.name][std::to_string(contender.threads)] = rate;
  }
  return json;
}

void run(const bench::Arguments& arguments) {
  const int rounds = std::max(1, arguments.number("--rounds", 5));
  const std::string library = arguments.text("--laszip", "liblaszip.so.8");
  const std::optional<Laszip> laszip = Laszip::open(library);
  if (!laszip) std::printf("LASzip skipped: %s not found\n", library.c_str());
  std::vector<std::unique_ptr<Executor>> executors;
  std::istringstream counts(arguments.text("--threads", "1,2"));
  for (std::string count; std::getline(counts, count, ',');)
    executors.push_back(std::make_unique<Executor>(std::stoi(count)));
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const std::filesystem::path file : arguments.inputs())
    files.push_back(measure(file, rounds, executors, laszip));
  if (!arguments.has("--json")) return;
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(2))},
                                         {"rounds", rounds},
                                         {"laszip", laszip.has_value()},
                                         {"files", files}};
  write_file(arguments.text("--json"), result.dump(2) + "\n");
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_laz", [&] {
    adasplats::run(
        {argc, argv,
         "bench_laz FILE... [--threads A,B] [--rounds N] [--laszip LIBRARY] [--json FILE]", 1,
         1000});
  });
}
