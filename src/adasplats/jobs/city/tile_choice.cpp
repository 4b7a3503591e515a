// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/tile_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/point_format.h"
#include "adasplats/jobs/city/tile_workers.h"
#include "adasplats/jobs/provenance/machine.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Scans of a drive, or places in a file, that are looked at.
constexpr std::uint64_t kSamples = 24;
constexpr std::uint64_t kSampledRecords = 50'000;

/// No file has more points than that for its size; LAZ has the fewest bytes a point, 2 or more
/// (kMaxPointsPerByte is for broken ones).
double max_points_of_file(const fs::path& file) {
  std::error_code problem;
  const auto bytes = static_cast<double>(fs::file_size(file, problem));
  if (problem) return 0;
  const std::string extension = lower_case(file.extension().string());
  if (extension == ".bin" && !is_octree_part(file)) return bytes / 16;
  if (extension == ".las" || extension == ".ply") return bytes / 12;
  return bytes / 2;
}

void add(const PointCloud& cloud, double weight, PlaceEstimate& place) {
  const TileGrid grid = {PlaceEstimate::kCell_m};
  for (std::size_t i = 0; i < cloud.size(); ++i)
    place.cells[grid.tile_of(cloud.world(i))] += weight;
  place.points += weight * static_cast<double>(cloud.size());
}

/// Where to look at one input, and what share of it that is.
struct Sample {
  std::vector<InputPiece> pieces;
  double share = 1;
};

Sample sample_of(const OpenInputs& inputs, std::size_t k) {
  const bool is_drive = inputs.inputs()[k].input.is_sequence;
  const std::optional<std::uint64_t> all =
      is_drive ? inputs.chosen_scans(k)
               : random_access_records(inputs.inputs()[k].input.path, inputs.options().salvage);
  const std::uint64_t size = is_drive ? 1 : kSampledRecords;
  if (!all || *all <= kSamples * size) return {{{.input = k}}, 1};
  Sample sample;
  for (std::uint64_t n = 0; n < kSamples; ++n)
    sample.pieces.push_back({k, n * (*all - size) / (kSamples - 1), size, false, {}});
  sample.share = static_cast<double>(kSamples * size) / static_cast<double>(*all);
  return sample;
}

/// A memory that modelling takes from.
struct MemoryLimit {
  double limit_gb = 0;
  double bytes_a_point = 0;
  double shared_by = 1;  ///< GPUs of this size
  bool of_gpu = false;

  double need_gb(double points) const { return points * bytes_a_point / 1e9; }
  bool fits(double points) const { return need_gb(points) <= limit_gb; }
  /// How many tiles of so many points fit at a time.
  double tiles(double points) const {
    return shared_by * std::floor(limit_gb / std::max(need_gb(points), 1e-9));
  }
};

/// The memory of the machine and of the smallest GPU; none if unknown. A GPU that the user did not
/// ask for counts if its memory is limited: the CPU replaces it where it is too small.
std::vector<MemoryLimit> limits_of(const CityJob& job, const Session& session) {
  std::vector<MemoryLimit> limits;
  double memory_gb = job.memory.memory_gb;
  if (memory_gb == 0) memory_gb = 0.75 * static_cast<double>(usable_memory_bytes()) / 1e9;
  if (memory_gb > 0) limits.push_back({memory_gb, kModelBytesAPoint, 1, false});
  double gpu_gb = 0;
  for (const GpuDevice& gpu : session.device.gpus) {
    if (session.device.is_automatic && gpu_memory_limit(gpu.index) == 0) continue;
    const double usable_gb = static_cast<double>(usable_gpu_memory(gpu.index)) / 1e9;
    gpu_gb = gpu_gb == 0 ? usable_gb : std::min(gpu_gb, usable_gb);
  }
  if (gpu_gb > 0)
    limits.push_back(
        {gpu_gb, kGpuModelBytesAPoint, static_cast<double>(session.device.gpus.size()), true});
  return limits;
}

TileAdvice one_piece(double points, const MemoryLimit& limit) {
  return {0, points, limit.need_gb(points), limit.limit_gb, 0, limit.of_gpu};
}

}  // namespace

double PlaceEstimate::max_points_of_tile(double tile_m, double halo_m) const {
  const TileGrid grid = {tile_m}, own = {kCell_m};
  std::map<TileKey, double> tiles;
  const auto near = static_cast<std::int32_t>(std::ceil(halo_m / tile_m));
  for (const auto& [cell, count] : cells) {
    const GroundBox square = own.box_of(cell);
    const TileKey home = grid.tile_of({square.low_x, square.low_y, 0});
    for (TileKey tile = {home.x - near, 0}; tile.x <= home.x + near; ++tile.x)
      for (tile.y = home.y - near; tile.y <= home.y + near; ++tile.y) {
        const GroundBox reach = grid.box_of(tile).grown(halo_m);
        if (square.low_x < reach.high_x && square.high_x > reach.low_x &&
            square.low_y < reach.high_y && square.high_y > reach.low_y)
          tiles[tile] += count;
      }
  }
  double most = 0;
  for (const auto& [tile, count] : tiles) most = std::max(most, count);
  return most;
}

double max_points_of(std::span<const fs::path> inputs) {
  double points = 0;
  for (const fs::path& input : inputs) {
    std::error_code problem;
    if (!fs::is_directory(input, problem)) {
      points += max_points_of_file(input);
      continue;
    }
    for (const fs::path& file : files_below(input)) points += max_points_of_file(file);
  }
  return points;
}

PlaceEstimate estimate_place(const OpenInputs& inputs, Session& session) {
  PlaceEstimate place;
  ProgressSink quiet;  // reading the inputs reports their warnings
  std::vector<Sample> samples;
  std::size_t pieces = 0, done = 0;
  for (std::size_t k = 0; k < inputs.inputs().size(); ++k) {
    samples.push_back(sample_of(inputs, k));
    pieces += samples.back().pieces.size();
  }
  session.progress.begin_step("points by place", pieces);
  for (const Sample& sample : samples) {
    for (const InputPiece& piece : sample.pieces) {
      add(inputs.load(piece, session.executor, quiet).first, 1 / sample.share, place);
      session.progress.advance(++done);
    }
  }
  session.progress.end_step();
  return place;
}

TileAdvice advise_tiles(const CityJob& job, Session& session) {
  const std::vector<MemoryLimit> limits = limits_of(job, session);
  const auto fits = [&](double points) {
    return std::ranges::all_of(limits, [&](const MemoryLimit& one) { return one.fits(points); });
  };
  const double most = max_points_of(job.inputs);
  if (limits.empty() || fits(most))
    return one_piece(most, limits.empty() ? MemoryLimit{} : limits.front());
  LoadOptions load = job.load;
  load.empty_beams = false;
  load.own_body_m = 0;   // cannot be estimated from single scans
  load.max_dropped = 1;  // nor whether too much of the whole is dropped
  const OpenInputs inputs(job.inputs, load, session.executor, session.progress);
  const PlaceEstimate place = estimate_place(inputs, session);
  // The memory that is scarcest for one piece is the one to name.
  const MemoryLimit& scarcest = *std::ranges::max_element(
      limits, {}, [](const MemoryLimit& one) { return one.bytes_a_point / one.limit_gb; });
  TileAdvice advice = one_piece(place.points, scarcest);
  if (fits(place.points)) return advice;
  const auto wanted = static_cast<double>(tiles_at_once(session));
  double points = 0;  // of the smallest tile tried
  for (const double at_once : {wanted, 1.0}) {
    for (const double tile_m : {64.0, 32.0, 16.0}) {
      points = place.max_points_of_tile(tile_m, job.tiles.halo_m);
      double fitting = wanted;
      for (const MemoryLimit& one : limits) fitting = std::min(fitting, one.tiles(points));
      if (fitting < at_once) continue;
      advice.tile_m = tile_m;
      advice.at_once = fitting < wanted ? static_cast<std::size_t>(fitting) : 0;
      return advice;
    }
  }
  const double need_gb = scarcest.need_gb(points);
  throw Error(ErrorKind::data, job.inputs.front().string() + ": about " +
                                   decimal_text(std::round(place.points / 1e6)) +
                                   " million points; modelling even tiles of 16 m takes about " +
                                   decimal_text(std::ceil(need_gb * 10) / 10) +
                                   " GB, more than the " + decimal_text(scarcest.limit_gb) +
                                   " GB of " + (scarcest.of_gpu ? "the GPU" : "`memory`"));
}

}  // namespace adasplats
