// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/tile_points.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/line_reader.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPointsHeader = "adasplats points 1 ";

/// The names of a cloud's attributes, each preceded by a space.
std::string attributes_of(const PointCloud& cloud) {
  std::string names;
  for_each_attribute([&](const auto& attribute) {
    if (!attribute.of(cloud).empty()) names += std::string(" ") + attribute.name;
  });
  return names;
}

/// The attributes that every cloud of a city must have or lack: all but those with a default
/// (even_out()).
std::string needed_attributes_of(const PointCloud& cloud) {
  PointCloud some;
  const auto take = [&](auto& to, const auto& from) { to.resize(from.empty() ? 0 : 1); };
  for_each_attribute([&](const auto& attribute) { take(attribute.of(some), attribute.of(cloud)); });
  some.instances = {};
  some.origin_kinds = {};
  return attributes_of(some);
}

/// Gives both clouds attributes that only one of them has and that have a default: no instance,
/// measured beams.
void even_out(PointCloud& a, PointCloud& b) {
  if (a.empty() || b.empty()) return;
  for (PointCloud* const cloud : {&a, &b}) {
    if (cloud->instances.empty() && !(a.instances.empty() && b.instances.empty()))
      cloud->instances.assign(cloud->size(), 0);
    if (cloud->origin_kinds.empty() && !(a.origin_kinds.empty() && b.origin_kinds.empty()))
      cloud->origin_kinds.assign(cloud->size(), OriginKind::measured);
  }
}

/// The points alone, without the cloud's metadata, which gather() keeps.
PointCloud points_at(const PointCloud& cloud, const std::vector<std::uint32_t>& indices) {
  PointCloud part;
  const auto pick = [&](const auto& from, auto& to) {
    if (from.empty()) return;
    to.reserve(indices.size());
    for (const std::uint32_t i : indices) to.push_back(from[i]);
  };
  pick(cloud.positions, part.positions);
  for_each_attribute([&](const auto& attribute) { pick(attribute.of(cloud), attribute.of(part)); });
  return part;
}

template <class T>
void put(std::ofstream& out, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
}

/// Appends the output of `write` to a file.
template <class Write>
void extend(const fs::path& file, const Write& write) {
  std::ofstream out(file, std::ios::binary | std::ios::app);
  write(out);
  out.close();
  if (!out) throw Error(ErrorKind::io, file.string() + ": cannot be written; is the disk full?");
}

/// All values of a file of one type.
template <class T>
std::vector<T> values_of(const fs::path& file) {
  static_assert(std::is_trivially_copyable_v<T>);
  const InputDescriptor in(file);
  if (in.size_bytes() % sizeof(T) != 0)
    throw Error(ErrorKind::data, file.string() + ": damaged: the file ends within a value");
  std::vector<T> values(in.size_bytes() / sizeof(T));
  in.read_at(0, std::as_writable_bytes(std::span(values)));
  return values;
}

/// Ascending indices of a cloud's points in one tile.
struct TilePart {
  TileKey tile;
  std::vector<std::uint32_t> points;
};

std::vector<TilePart> parts_of(const PointCloud& cloud, const TileGrid& grid,
                               const Executor& executor) {
  std::vector<TileKey> tiles(cloud.size());
  executor.for_chunks(cloud.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) tiles[i] = grid.tile_of(cloud.world(i));
  });
  std::vector<TilePart> parts;
  std::map<TileKey, std::size_t> part_of;
  std::size_t last = 0;  // consecutive points are mostly in the same tile
  for (std::uint32_t i = 0; i < tiles.size(); ++i) {
    if (parts.empty() || parts[last].tile != tiles[i]) {
      const auto [found, is_new] = part_of.try_emplace(tiles[i], parts.size());
      if (is_new) parts.push_back({tiles[i], {}});
      last = found->second;
    }
    parts[last].points.push_back(i);
  }
  return parts;
}

/// Reads the blocks of one file.
class BlockReader {
 public:
  explicit BlockReader(const fs::path& file) : file_(file), lines_(file_) {}

  /// Reads the next block; false at the end of the file.
  bool read(PointCloud& block) {
    if (file_.remaining() == 0) return false;
    const std::string head(lines_.next().value_or(""));
    if (!head.starts_with(kPointsHeader)) fail("not a file of points, or from another version");
    std::istringstream words(head.substr(kPointsHeader.size()));
    std::size_t count = 0;
    if (!(words >> count)) fail("the number of points is missing");
    std::vector<std::string> names;
    for (std::string name; words >> name;) names.push_back(name);
    block = {};
    get(block.positions, count);
    std::size_t known = 0;
    for_each_attribute([&](const auto& attribute) {
      if (known >= names.size() || names[known] != attribute.name) return;
      ++known;
      get(attribute.of(block), count);
    });
    if (known != names.size()) fail("unknown attribute '" + names[known] + "'");
    return true;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::data, file_.path().string() + ": damaged: " + what);
  }

  template <class T>
  void get(std::vector<T>& values, std::size_t count) {
    if (count > file_.remaining() / sizeof(T)) fail("the file ends within its points");
    values.resize(count);
    auto left = std::as_writable_bytes(std::span(values));
    while (!left.empty()) {
      const auto buffered = file_.peek(1);
      const std::size_t bytes = std::min(buffered.size(), left.size());
      std::memcpy(left.data(), buffered.data(), bytes);
      file_.skip(bytes);
      left = left.subspan(bytes);
    }
  }

  InputFile file_;
  LineReader lines_;
};

}  // namespace

std::string points_file_of(TileKey tile) { return "points/" + name_of(tile) + ".points"; }
std::string order_file_of(TileKey tile) { return "points/" + name_of(tile) + ".order"; }
std::string classes_file_of(TileKey tile) { return "points/" + name_of(tile) + ".classes"; }
std::string beams_file_of(TileKey tile) { return "points/" + name_of(tile) + ".beams"; }

TilePointsWriter::TilePointsWriter(fs::path folder, const TileGrid& grid, std::size_t buffered,
                                   const Executor& executor, bool keeps_order,
                                   std::optional<Vec3d> origin)
    : folder_(std::move(folder)),
      grid_(grid),
      buffered_(buffered),
      executor_(executor),
      keeps_order_(keeps_order),
      origin_(origin) {
  fs::create_directories(folder_ / "points");
}

void TilePointsWriter::add(const PointCloud& cloud) {
  if (cloud.empty() && cloud.empty_beams.empty()) return;
  if (!origin_) origin_ = cloud.origin;
  if (!cloud.empty()) {
    const std::string attributes = needed_attributes_of(cloud);
    if (!attributes_) attributes_ = attributes;
    if (attributes != *attributes_)
      throw Error(ErrorKind::data, "the inputs have different attributes:" + *attributes_ +
                                       " in the first ones, then" + attributes +
                                       "; model them separately");
  }
  const Vec3d shift = cloud.origin - *origin_;
  const bool is_moved = !(shift == Vec3d{});
  const auto moved = [&](Vec3f p) { return vec_cast<float>(vec_cast<double>(p) + shift); };
  const std::vector<TilePart> parts = parts_of(cloud, grid_, executor_);
  std::vector<Waiting*> to;  // inserted before threads fill them
  to.reserve(parts.size());
  for (const TilePart& part : parts) to.push_back(&waiting_[part.tile]);
  executor_.for_chunks(parts.size(), 1, [&](std::size_t k, std::size_t) {
    PointCloud part = points_at(cloud, parts[k].points);
    if (is_moved) {
      for (Vec3f& p : part.positions) p = moved(p);
      for (Vec3f& p : part.sensor_positions) p = moved(p);
    }
    even_out(to[k]->points, part);
    append(to[k]->points, std::move(part));
    if (keeps_order_)
      for (const std::uint32_t i : parts[k].points) to[k]->order.push_back(added_ + i);
  });
  added_ += cloud.size();
  for (EmptyBeam beam : cloud.empty_beams) {
    const TileKey tile = grid_.tile_of(cloud.origin + vec_cast<double>(beam.origin));
    if (is_moved) beam.origin = moved(beam.origin);
    waiting_[tile].beams.push_back(beam);
  }
  waiting_points_ += cloud.size() + cloud.empty_beams.size();
  if (waiting_points_ > buffered_) write_all();
}

void TilePointsWriter::write(TileKey tile, const Waiting& waiting) const {
  if (!waiting.points.empty())
    extend(folder_ / points_file_of(tile), [&](std::ofstream& out) {
      out << kPointsHeader << waiting.points.size() << attributes_of(waiting.points) << '\n';
      put(out, waiting.points.positions);
      for_each_attribute([&](const auto& attribute) { put(out, attribute.of(waiting.points)); });
    });
  if (!waiting.order.empty())
    extend(folder_ / order_file_of(tile), [&](std::ofstream& out) { put(out, waiting.order); });
  if (!waiting.beams.empty())
    extend(folder_ / beams_file_of(tile), [&](std::ofstream& out) { put(out, waiting.beams); });
}

GroundBox TilePointsWriter::box_of_rays(const PointCloud& points) const {
  GroundBox box = kNoGround;
  for (const auto* positions : {&points.positions, &points.sensor_positions})
    for (const Vec3f p : *positions) {
      const double x = origin().x + static_cast<double>(p.x);
      const double y = origin().y + static_cast<double>(p.y);
      box = box.with({x, y, x, y});
    }
  return box;
}

void TilePointsWriter::write_all() {
  std::vector<std::pair<TileKey, const Waiting*>> files;
  for (const auto& [tile, waiting] : waiting_) {
    files.emplace_back(tile, &waiting);
    counts_[tile].points += waiting.points.size();
    counts_[tile].empty_beams += waiting.beams.size();
  }
  std::vector<GroundBox> rays(files.size());
  executor_.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    write(files[k].first, *files[k].second);
    rays[k] = box_of_rays(files[k].second->points);
  });
  for (std::size_t k = 0; k < files.size(); ++k) {
    GroundBox& box = counts_[files[k].first].rays;
    box = box.with(rays[k]);
  }
  waiting_.clear();
  waiting_points_ = 0;
}

std::map<TileKey, TileCount> TilePointsWriter::finish() {
  write_all();
  return counts_;
}

void read_tile_pieces(const fs::path& folder, TileKey tile,
                      FunctionRef<void(PointCloud& block)> take) {
  BlockReader reader(folder / points_file_of(tile));
  for (PointCloud block; reader.read(block);) take(block);
}

void read_tile_points(const fs::path& folder, TileKey tile, PointCloud& cloud,
                      const std::function<bool(Vec3f)>& wanted,
                      std::span<const std::uint16_t> classes) {
  std::size_t read = 0;
  const auto fail = [&] {
    throw Error(ErrorKind::data,
                (folder / classes_file_of(tile)).string() +
                    ": damaged: the number of classes differs from that of points");
  };
  read_tile_pieces(folder, tile, [&](PointCloud& block) {
    if (!classes.empty()) {
      if (block.size() > classes.size() - read) fail();
      const auto own = classes.subspan(read, block.size());
      block.classes.assign(own.begin(), own.end());
    }
    read += block.size();
    if (wanted) {
      std::vector<std::uint32_t> chosen;
      for (std::uint32_t i = 0; i < block.size(); ++i)
        if (wanted(block.positions[i])) chosen.push_back(i);
      if (chosen.size() < block.size()) block = gather(block, chosen);
    }
    block.origin = cloud.origin;
    if (block.empty()) return;
    even_out(cloud, block);
    append(cloud, std::move(block));
  });
  if (!classes.empty() && read != classes.size()) fail();
}

std::vector<std::uint64_t> read_tile_order(const fs::path& folder, TileKey tile) {
  return values_of<std::uint64_t>(folder / order_file_of(tile));
}

std::vector<std::uint16_t> read_tile_classes(const fs::path& folder, TileKey tile) {
  return values_of<std::uint16_t>(folder / classes_file_of(tile));
}

void write_tile_classes(const fs::path& folder, TileKey tile,
                        std::span<const std::uint16_t> classes) {
  write_file_in_place(folder / classes_file_of(tile),
                      {reinterpret_cast<const char*>(classes.data()), classes.size_bytes()});
}

std::vector<EmptyBeam> read_tile_beams(const fs::path& folder, TileKey tile) {
  const fs::path file = folder / beams_file_of(tile);
  std::error_code none;
  if (!fs::exists(file, none)) return {};
  return values_of<EmptyBeam>(file);
}

namespace {

constexpr std::string_view kClassesHeader = "adasplats classes 1 ";

}  // namespace

std::string squares_file_of(TileKey tile) { return "points/" + name_of(tile) + ".squares"; }

/// Format: a line "adasplats classes 1 SQUARES CELLS TILES", a line "X Y COUNT" per tile, then the
/// classes tile by tile.
void write_square_classes(const std::filesystem::path& file, const SquareClasses& classes) {
  std::ostringstream head;
  head << kClassesHeader << classes.squares << ' ' << classes.cells << ' ' << classes.of_tile.size()
       << '\n';
  for (const auto& [tile, own] : classes.of_tile)
    head << tile.x << ' ' << tile.y << ' ' << own.size() << '\n';
  std::string text = std::move(head).str();
  for (const auto& [tile, own] : classes.of_tile)
    text.append(reinterpret_cast<const char*>(own.data()), own.size() * sizeof(std::uint16_t));
  write_file_in_place(file, text);
}

SquareClasses read_square_classes(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  const auto fail = [&](const char* what) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + what);
  };
  if (!text.starts_with(kClassesHeader)) fail("not a file of classes");
  std::istringstream in(text);
  in.seekg(static_cast<std::streamoff>(kClassesHeader.size()));
  SquareClasses classes;
  std::size_t tiles = 0;
  if (!(in >> classes.squares >> classes.cells >> tiles)) fail("the file ends within its header");
  std::vector<std::pair<TileKey, std::size_t>> heads;
  for (std::size_t k = 0; k < tiles; ++k) {
    TileKey tile;
    std::size_t points = 0;
    if (!(in >> tile.x >> tile.y >> points)) fail("the file ends within its header");
    heads.emplace_back(tile, points);
  }
  if (in.get() != '\n') fail("the file ends within its header");
  auto at = static_cast<std::size_t>(in.tellg());
  for (const auto& [tile, points] : heads) {
    if (points > (text.size() - at) / sizeof(std::uint16_t))
      fail("the file ends within its classes");
    std::vector<std::uint16_t>& own = classes.of_tile[tile];
    own.resize(points);
    if (points > 0) std::memcpy(own.data(), text.data() + at, points * sizeof(std::uint16_t));
    at += points * sizeof(std::uint16_t);
  }
  if (at != text.size()) fail("data follow the classes");
  return classes;
}

}  // namespace adasplats
