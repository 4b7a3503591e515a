// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/passing_rays.h"

#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/splats/rays/measured_ray.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRaysHeader = "adasplats rays 1";

void add(PointCloud& rays, Vec3f sensor, Vec3f end) {
  rays.sensor_positions.push_back(sensor);
  rays.positions.push_back(end);
}

/// Calls visit(chunk's rays, i) for each ray of a cloud, and joins the chunks in order.
template <class Visit>
RaysByTile by_tile(std::size_t count, const Executor& executor, const Visit& visit) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<RaysByTile> parts(chunks);
  executor.for_chunks(chunks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk)
      for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
        visit(parts[chunk], i);
  });
  RaysByTile all;
  for (RaysByTile& part : parts)
    for (auto& [tile, rays] : part) append(all[tile], std::move(rays));
  return all;
}

}  // namespace

std::vector<TileKey> TileSet::touched(const GroundBox& ground) const {
  const TileKey low = grid.tile_of({ground.low_x, ground.low_y, 0});
  const TileKey high = grid.tile_of({ground.high_x, ground.high_y, 0});
  std::vector<TileKey> found;
  for (TileKey tile = low; tile.x <= high.x; ++tile.x)
    for (tile.y = low.y; tile.y <= high.y; ++tile.y)
      if (tiles.contains(tile)) found.push_back(tile);
  return found;
}

std::set<TileKey> TileSet::crossed(Vec3d from, Vec3d to) const {
  std::set<TileKey> found;
  const auto low =
      grid.tile_of({std::min(from.x, to.x) - halo_m, std::min(from.y, to.y) - halo_m, 0});
  const auto high =
      grid.tile_of({std::max(from.x, to.x) + halo_m, std::max(from.y, to.y) + halo_m, 0});
  for (TileKey tile = low; tile.x <= high.x; ++tile.x)
    for (tile.y = low.y; tile.y <= high.y; ++tile.y)
      if (tiles.contains(tile) && reach_of(tile).is_crossed(from, to)) found.insert(tile);
  return found;
}

RaysByTile passing_rays(const PointCloud& cloud, const TileSet& tiles, double min_range_m,
                        const Executor& executor) {
  if (!cloud.has_beams()) return {};
  return by_tile(cloud.size(), executor, [&](RaysByTile& rays, std::size_t i) {
    const Vec3f end = cloud.positions[i], sensor = cloud.sensor_positions[i];
    if (!is_beam(cloud.origin_kind(i)) || !has_measured_ray(sensor, end, min_range_m)) return;
    const Vec3d from = cloud.origin + vec_cast<double>(sensor), to = cloud.world(i);
    for (const TileKey tile : tiles.crossed(from, to))
      if (!tiles.reach_of(tile).contains(to)) add(rays[tile], sensor, end);
  });
}

RaysByTile crossing_rays(const PointCloud& ends, const TileSet& tiles, const Executor& executor) {
  return by_tile(ends.size(), executor, [&](RaysByTile& rays, std::size_t i) {
    const Vec3d from = ends.origin + vec_cast<double>(ends.sensor_positions[i]);
    for (const TileKey tile : tiles.crossed(from, ends.world(i)))
      add(rays[tile], ends.sensor_positions[i], ends.positions[i]);
  });
}

std::string rays_file_of(TileKey from, RaySort sort) {
  return "rays/" + name_of(from) + (sort == RaySort::passing ? ".passing" : ".empty");
}

/// Format: a line "adasplats rays 1 TILES", a line "X Y COUNT" per tile, then for each tile the
/// ends and the sensor positions.
void write_rays(const fs::path& file, const RaysByTile& rays) {
  std::string text = std::string(kRaysHeader) + " " + std::to_string(rays.size()) + "\n";
  for (const auto& [tile, own] : rays)
    text += std::to_string(tile.x) + " " + std::to_string(tile.y) + " " +
            std::to_string(own.size()) + "\n";
  for (const auto& [tile, own] : rays)
    for (const auto* values : {&own.positions, &own.sensor_positions})
      text.append(reinterpret_cast<const char*>(values->data()), values->size() * sizeof(Vec3f));
  write_file_in_place(file, text);
}

RayFiles::RayFiles(const fs::path& folder, const std::set<TileKey>& tiles, RaySort sort) {
  for (const TileKey from : tiles) {
    const fs::path file = folder / rays_file_of(from, sort);
    if (!fs::exists(file)) continue;
    InputFile in(file);
    LineReader lines(in);
    const auto fail = [&](const char* what) {
      throw Error(ErrorKind::data, file.string() + ": damaged: " + what);
    };
    const std::string first(lines.next().value_or(""));
    if (!first.starts_with(kRaysHeader)) fail("not a file of rays");
    std::size_t count = 0;
    std::istringstream(first.substr(kRaysHeader.size())) >> count;
    std::vector<std::pair<TileKey, std::size_t>> heads;
    for (std::size_t k = 0; k < count; ++k) {
      TileKey tile;
      std::size_t rays = 0;
      std::istringstream line{std::string(lines.next().value_or(""))};
      if (!(line >> tile.x >> tile.y >> rays)) fail("the file ends within its header");
      heads.emplace_back(tile, rays);
    }
    std::uint64_t at = in.offset();
    const std::uint64_t size = in.size_bytes();
    for (const auto& [tile, rays] : heads) {
      if (rays > (size - at) / (2 * sizeof(Vec3f))) fail("the file ends within its rays");
      blocks_[tile].push_back({from, file, at, rays});
      at += 2 * rays * sizeof(Vec3f);
    }
    if (at != size) fail("data follow the rays");
  }
}

std::vector<TileKey> RayFiles::sources(TileKey tile) const {
  std::vector<TileKey> tiles;
  const auto found = blocks_.find(tile);
  if (found != blocks_.end())
    for (const Block& block : found->second) tiles.push_back(block.from);
  return tiles;
}

std::vector<TileKey> RayFiles::targets() const {
  std::vector<TileKey> tiles;
  for (const auto& [tile, blocks] : blocks_) tiles.push_back(tile);
  return tiles;
}

PointCloud RayFiles::read(TileKey tile) const {
  PointCloud all;
  const auto found = blocks_.find(tile);
  if (found == blocks_.end()) return all;
  for (const Block& block : found->second) {
    const InputDescriptor in(block.file);
    std::uint64_t at = block.at;
    for (auto* values : {&all.positions, &all.sensor_positions}) {
      const std::size_t before = values->size();
      values->resize(before + block.rays);
      in.read_at(at, std::as_writable_bytes(std::span(*values).subspan(before)));
      at += block.rays * sizeof(Vec3f);
    }
  }
  return all;
}

}  // namespace adasplats
