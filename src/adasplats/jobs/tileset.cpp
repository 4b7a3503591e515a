// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/tileset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/map_projection.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/levels/level_tree.h"
#include "adasplats/splats/model/spz.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kTilesetFile = "tileset.json";
/// Maximum number of splats of a content. CesiumJS sorts all visible splats again whenever a tile
/// is replaced; 65,536 splats take about a megabyte.
constexpr std::size_t kTileSplats = 65'536;
/// Fine enough that for surfaces kTileSplats, or half of the splats below, limits an inner tile.
constexpr int kCellsPerSide = 512;
/// Geometric error of a tile divided by the spacing of its splats: with CesiumJS' default, children
/// replace a tile whose splats are more than 4 pixels apart.
constexpr double kErrorOverSpacing = 4;

/// A box along the axes, in the local frame.
struct TileBox {
  Vec3d low, high;

  void add(const TileBox& other) {
    low = min(low, other.low);
    high = max(high, other.high);
  }
  Vec3d center() const { return 0.5 * (low + high); }
};

/// A tile with those below it.
struct Tile {
  Json json;
  TileBox box;
  double error_m = 0;
  ColoredDisks shown;  ///< in its place
};

/// The box of the disks' extents.
TileBox box_of(std::span<const Disk> disks) {
  constexpr double kFar = HUGE_VAL;
  TileBox box = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const Disk& disk : disks) {
    const Vec3d center = vec_cast<double>(disk.center), normal = vec_cast<double>(disk.normal);
    Vec3d reach;
    for (int axis = 0; axis < 3; ++axis)
      reach[axis] = static_cast<double>(disk.radius) *
                    std::sqrt(std::max(0.0, 1 - normal[axis] * normal[axis]));
    box.add({center - reach, center + reach});
  }
  return box;
}

Json json_of(const TileBox& box, double error_m, const std::string& uri, Json children) {
  const Vec3d c = box.center(), half = 0.5 * (box.high - box.low);
  Json tile = {
      {"boundingVolume", {{"box", {c.x, c.y, c.z, half.x, 0, 0, 0, half.y, 0, 0, 0, half.z}}}},
      {"geometricError", error_m},
      {"refine", "REPLACE"},
      {"content", {{"uri", uri}}}};
  if (!children.empty()) tile["children"] = std::move(children);
  return tile;
}

Json tileset_json(Tile root) {
  const Json extensions =
      Json::array({"KHR_gaussian_splatting", "KHR_gaussian_splatting_compression_spz_2"});
  // CesiumJS decodes Gaussians only if the tileset requires both.
  return {{"asset", {{"version", "1.1"}, {"generator", "adasplats"}}},
          {"extensionsUsed", Json::array({"3DTILES_content_gltf"})},
          {"extensions",
           {{"3DTILES_content_gltf",
             {{"extensionsUsed", extensions}, {"extensionsRequired", extensions}}}}},
          {"geometricError", length(root.box.high - root.box.low)},
          {"root", std::move(root.json)}};
}

ColoredDisks decoded(const LevelNode& node, std::span<const LevelElement> elements,
                     std::span<const LevelColor> colors) {
  LevelSplats splats;
  add_splats(node, elements, {}, splats);
  ColoredDisks decoded{std::move(splats.disks), {}};
  decoded.colors.reserve(colors.size());
  for (const LevelColor& color : colors) decoded.colors.push_back({color[0], color[1], color[2]});
  return decoded;
}

LevelInput input_of(const ColoredDisks& splats) {
  return {.disks = splats.disks,
          .positions = {},
          .classes = {},
          .intensities = {},
          .errors_m = {},
          .colors = splats.colors};
}

/// Writes the tiles of the parts and those above them, depth first: in memory are one part and the
/// shown splats of at most three siblings per level.
class TileWriter {
 public:
  TileWriter(fs::path folder, const TilesetParts& parts, const LoadPart& load, Session& session)
      : folder_(std::move(folder)), parts_(parts), load_(load), session_(session) {}

  Tile write() {
    session_.progress.begin_step("writing tiles", parts_.keys.size());
    std::vector<std::size_t> all(parts_.keys.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = k;
      lowest_ = k == 0 ? parts_.keys[k]
                       : TileKey{std::min(lowest_.x, parts_.keys[k].x),
                                 std::min(lowest_.y, parts_.keys[k].y)};
    }
    constexpr int kKeyBits = 32;
    Tile root = all.size() == 1 ? part(0, folder_, "tiles/") : square(all, kKeyBits);
    session_.progress.end_step();
    return root;
  }

 private:
  /// The tiles of a part, with contents in `folder`/`below`.
  Tile part(std::size_t k, const fs::path& folder, const std::string& below) {
    const ColoredDisks splats = load_(k);
    const LevelTree tree(input_of(splats), options(), session_.executor);
    const std::span<const LevelNode> nodes = tree.nodes();
    fs::create_directories(folder / below);
    const auto uri = [&below](std::size_t n) { return below + std::to_string(n) + ".glb"; };
    std::vector<TileBox> boxes(nodes.size());
    session_.executor.for_chunks(nodes.size(), 1, [&](std::size_t n, std::size_t) {
      const ColoredDisks shown = decoded(nodes[n], tree.elements(n), tree.colors(n));
      boxes[n] = box_of(shown.disks);
      write_file_in_place(folder / uri(n), spz_glb(shown.disks, shown.colors));
    });
    std::vector<Json> json(nodes.size());
    std::vector<double> errors_m(nodes.size(), 0);
    for (std::size_t n = nodes.size(); n-- > 0;) {
      Json children;
      for (std::size_t c = nodes[n].first_child; c < nodes[n].first_child + nodes[n].child_count;
           ++c) {
        boxes[n].add(boxes[c]);
        errors_m[n] = std::max(errors_m[n], errors_m[c]);
        children.push_back(std::move(json[c]));
      }
      errors_m[n] =
          std::max(errors_m[n], kErrorOverSpacing * static_cast<double>(nodes[n].spacing_m));
      json[n] = json_of(boxes[n], errors_m[n], uri(n), std::move(children));
    }
    session_.progress.advance(++parts_done_);
    return {std::move(json[0]), boxes[0], errors_m[0],
            decoded(nodes[0], tree.elements(0), tree.colors(0))};
  }

  /// A part as a tileset of its own.
  Tile external(std::size_t k) {
    const std::string below = "tiles/" + name_of(parts_.keys[k]) + "/";
    Tile tile = part(k, folder_ / below, "");
    Tile reference{json_of(tile.box, tile.error_m, below + kTilesetFile, {}), tile.box,
                   tile.error_m, std::move(tile.shown)};
    write_file_in_place(folder_ / below / kTilesetFile,
                        tileset_json(std::move(tile)).dump() + "\n");
    return reference;
  }

  /// The tile above parts in a square of 2^`level` parts a side.
  Tile square(const std::vector<std::size_t>& parts, int level) {
    if (parts.size() == 1) return external(parts.front());
    std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> quarters;
    for (const std::size_t k : parts)
      quarters[{(std::int64_t{parts_.keys[k].x} - lowest_.x) >> (level - 1),
                (std::int64_t{parts_.keys[k].y} - lowest_.y) >> (level - 1)}]
          .push_back(k);
    if (quarters.size() == 1) return square(parts, level - 1);
    ColoredDisks below;
    Json children;
    std::optional<TileBox> box;
    double error_m = 0;
    for (const auto& [corner, inside] : quarters) {
      Tile child = square(inside, level - 1);
      below.disks.insert(below.disks.end(), child.shown.disks.begin(), child.shown.disks.end());
      below.colors.insert(below.colors.end(), child.shown.colors.begin(), child.shown.colors.end());
      if (box) box->add(child.box);
      box = box.value_or(child.box);
      error_m = std::max(error_m, child.error_m);
      children.push_back(std::move(child.json));
    }
    const LevelPiece piece = merged_node(input_of(below), options(), session_.executor);
    Tile tile{{}, *box, 0, decoded(piece.node, piece.elements, piece.colors)};
    tile.box.add(box_of(tile.shown.disks));
    tile.error_m = std::max(error_m, kErrorOverSpacing * static_cast<double>(piece.node.spacing_m));
    const std::string uri = "top/" + std::to_string(tops_++) + ".glb";
    fs::create_directories(folder_ / "top");
    write_file_in_place(folder_ / uri, spz_glb(tile.shown.disks, tile.shown.colors));
    tile.json = json_of(tile.box, tile.error_m, uri, std::move(children));
    return tile;
  }

  static LevelOptions options() {
    return {
        .leaf_size = kTileSplats, .cells_per_side = kCellsPerSide, .intensity_range = ByteRange{}};
  }

  fs::path folder_;
  const TilesetParts& parts_;
  const LoadPart& load_;
  Session& session_;
  TileKey lowest_;
  std::size_t parts_done_ = 0, tops_ = 0;
};

/// Of the center of the tileset, with the transform of its root, column by column.
struct PlaceOnEarth {
  std::array<double, 16> transform;
  std::string text;
};

PlaceOnEarth place_of(const TilesetParts& parts, Vec3d local_center) {
  // x, y, z to east, north, up at latitude and longitude 0.
  constexpr double kEquator_m = 6'378'137;
  PlaceOnEarth place{{0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, kEquator_m, 0, 0, 1}, {}};
  const std::string at_zero = "; placed at latitude 0, longitude 0";
  if (parts.crs.empty()) {
    place.text = "not georeferenced: the model has no coordinate system" + at_zero;
    return place;
  }
  const auto projection = MapProjection::of(parts.crs);
  if (!projection) {
    place.text = "not georeferenced: " + parts.crs.name() +
                 " is neither a UTM zone of WGS 84 or ETRS89 nor Lambert-93" + at_zero;
    return place;
  }
  const Vec3d center = parts.origin + local_center;
  const auto there = projection->geographic(center.x, center.y);
  const auto matrix = projection->geocentric_from_local(center);
  if (!there || !matrix) {
    place.text = "not georeferenced: the coordinates are outside " + parts.crs.name() + at_zero;
    return place;
  }
  place.transform = *matrix;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = 0; axis < 3; ++axis)
      place.transform[12 + row] += (*matrix)[4 * axis + row] * parts.origin[static_cast<int>(axis)];
  constexpr double kDegrees = 180 / std::numbers::pi;
  const auto degrees = [](double angle_rad) {
    return decimal_text(std::round(angle_rad * kDegrees * 1e6) / 1e6);
  };
  place.text = "georeferenced by " + parts.crs.name() + ": center at latitude " +
               degrees(there->latitude_rad) + ", longitude " + degrees(there->longitude_rad) +
               "; heights count as heights above the ellipsoid";
  return place;
}

}  // namespace

std::string write_tileset(const fs::path& folder, const TilesetParts& parts, const LoadPart& load,
                          Session& session) {
  Tile root = TileWriter(folder, parts, load, session).write();
  PlaceOnEarth place = place_of(parts, root.box.center());
  root.json["transform"] = place.transform;
  write_file_in_place(folder / kTilesetFile, tileset_json(std::move(root)).dump() + "\n");
  return place.text;
}

}  // namespace adasplats
