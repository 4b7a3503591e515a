// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/square_classes.h"

#include <cstring>
#include <sstream>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

constexpr std::string_view kHead = "adasplats classes 1 ";

}  // namespace

std::string squares_file_of(TileKey tile) { return "points/" + name_of(tile) + ".squares"; }

/// A line "adasplats classes 1 SQUARES CELLS TILES", a line "X Y COUNT" a tile, then the classes of
/// one tile after another.
void write_square_classes(const std::filesystem::path& file, const SquareClasses& classes) {
  std::ostringstream head;
  head << kHead << classes.squares << ' ' << classes.cells << ' ' << classes.of_tile.size() << '\n';
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
  if (!text.starts_with(kHead)) fail("no classes of a city");
  std::istringstream in(text);
  in.seekg(static_cast<std::streamoff>(kHead.size()));
  SquareClasses classes;
  std::size_t tiles = 0;
  if (!(in >> classes.squares >> classes.cells >> tiles)) fail("it ends within its head");
  std::vector<std::pair<TileKey, std::size_t>> heads;
  for (std::size_t k = 0; k < tiles; ++k) {
    TileKey tile;
    std::size_t points = 0;
    if (!(in >> tile.x >> tile.y >> points)) fail("it ends within its head");
    heads.emplace_back(tile, points);
  }
  if (in.get() != '\n') fail("it ends within its head");
  auto at = static_cast<std::size_t>(in.tellg());
  for (const auto& [tile, points] : heads) {
    if (points > (text.size() - at) / sizeof(std::uint16_t)) fail("it ends within its classes");
    std::vector<std::uint16_t>& own = classes.of_tile[tile];
    own.resize(points);
    if (points > 0) std::memcpy(own.data(), text.data() + at, points * sizeof(std::uint16_t));
    at += points * sizeof(std::uint16_t);
  }
  if (at != text.size()) fail("something follows its classes");
  return classes;
}

}  // namespace adasplats
