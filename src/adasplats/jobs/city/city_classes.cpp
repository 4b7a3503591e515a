// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_classes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/city/tile_points.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/city/city_points.h"
#include "adasplats/jobs/city/city_squares.h"
#include "adasplats/jobs/city/tile_workers.h"
#include "adasplats/jobs/session/repeated_warnings.h"
#include "adasplats/segment/full_intensity.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kIntensityFile = "points/intensity.json";

/// Threads for each tile that is read at a time.
constexpr std::size_t kThreadsATile = 4;

void require_reach(const CurveBox& box) {
  const Vec3f far = max(box.high, Vec3f{} - box.low);
  if (std::max({far.x, far.y, far.z}) > kSegmentReach_m)
    throw Error(ErrorKind::data,
                "there are points farther than 100 km from the others, which `segment` does not "
                "take (`max_distance`)");
}

/// Gives what `find` makes of each tile with points to `take`, in their order on this thread; some
/// are looked at at a time.
template <class Find, class Take>
void for_tiles(const LayerWork& work, const Find& find, const Take& take) {
  const std::vector<TileKey> tiles(work.tiles.tiles.begin(), work.tiles.tiles.end());
  const auto threads = static_cast<std::size_t>(work.session.executor.threads());
  const std::size_t at_once = std::max<std::size_t>(1, threads / kThreadsATile);
  for (std::size_t first = 0; first < tiles.size(); first += at_once) {
    std::vector<decltype(find(tiles[first]))> found(std::min(at_once, tiles.size() - first));
    work.session.executor.for_chunks(
        found.size(), 1, [&](std::size_t k, std::size_t) { found[k] = find(tiles[first + k]); });
    for (auto& each : found) take(each);
  }
}

/// The full scale of intensities in the whole city; nothing if points have none.
std::optional<float> full_intensity_of(const LayerWork& work, ResumableFolder& folder) {
  const std::filesystem::path file = work.path(kIntensityFile);
  if (folder.has(work.layer.file(kIntensityFile))) {
    const Json full = Json::parse(read_file(file));
    return full.is_null() ? std::nullopt : std::optional<float>(full.get<float>());
  }
  const auto intensities_of = [&](TileKey tile) {
    std::vector<float> all;
    read_tile_pieces(work.folder(), tile, [&](const PointCloud& piece) {
      all.insert(all.end(), piece.intensities.begin(), piece.intensities.end());
    });
    return all;
  };
  FullIntensitySearch search;
  bool has_some = false;
  for_tiles(work, intensities_of, [&](const std::vector<float>& all) {
    has_some = has_some || !all.empty();
    search.add_first(all);
  });
  search.begin_second();
  if (has_some) for_tiles(work, intensities_of, [&](const auto& all) { search.add_second(all); });
  const std::optional<float> full = has_some ? std::optional(search.value()) : std::nullopt;
  write_file_in_place(file, (full ? Json(*full) : Json()).dump() + "\n");
  folder.record(work.layer.file(kIntensityFile));
  return full;
}

/// Runs the network on squares that no earlier run has done.
void segment_squares(const std::vector<SquareGroup>& groups, const PointClassifier& classifier,
                     const SegmentOptions& options, const LayerWork& work,
                     ResumableFolder& folder) {
  std::vector<SquareGroup> to_do;
  for (const SquareGroup& group : groups)
    if (!folder.has(work.layer.file(squares_file_of(group.tile)))) to_do.push_back(group);
  ProgressSink& progress = work.session.progress;
  progress.begin_step("segment", groups.size());
  std::size_t done = groups.size() - to_do.size();
  progress.advance(done);
  RepeatedWarnings warnings(progress, "squares");
  std::vector<FileDigest> digests(to_do.size());
  work_side_by_side(
      to_do.size(), 0, work.session, warnings,
      [&](std::size_t k, Session& session) {
        const std::string file = squares_file_of(to_do[k].tile);
        write_square_classes(work.path(file),
                             classes_of_squares(to_do[k], classifier, options, work, session));
        digests[k] = {work.layer.file(file), sha256_of_file(work.path(file))};
      },
      [&](std::size_t k) {
        folder.record(std::span(&digests[k], 1));
        progress.advance(++done);
      });
  progress.end_step();
  warnings.end();
}

/// Gives the points of one tile, in the order of their file, their classes by the squares' files.
class ClassesOfTile {
 public:
  ClassesOfTile(TileKey tile, const SegmentOptions& options, const LayerWork& work)
      : tile_(tile), options_(options), work_(work) {}

  std::uint16_t next(Vec3f position) {
    const SegmentSquare square = square_of(position, options_);
    if (part_ == nullptr || square != square_) {
      part_ = &part_of(group_of(square, options_, work_));
      square_ = square;
    }
    if (part_->next == part_->classes.size()) fail();
    return part_->classes[part_->next++];
  }
  void finish() const {
    for (const auto& [group, part] : parts_)
      if (part.next != part.classes.size()) fail();
  }

 private:
  /// Of one file.
  struct Part {
    std::vector<std::uint16_t> classes;
    std::size_t next = 0;
  };

  Part& part_of(TileKey group) {
    const auto [found, is_new] = parts_.try_emplace(group);
    if (is_new)
      found->second.classes =
          std::move(read_square_classes(work_.path(squares_file_of(group))).of_tile[tile_]);
    return found->second;
  }

  [[noreturn]] void fail() const {
    throw Error(ErrorKind::data, work_.path(points_file_of(tile_)).string() +
                                     ": damaged: other points than those that got classes");
  }

  TileKey tile_;
  const SegmentOptions& options_;
  const LayerWork& work_;
  std::map<TileKey, Part> parts_;
  SegmentSquare square_;
  Part* part_ = nullptr;
};

/// What the points of a tile say of the whole.
struct TileTally {
  FileDigest file;
  std::size_t rays = 0;
  bool had_labels = false;
  std::map<std::uint16_t, std::size_t> points;  ///< by class
};

TileTally write_classes_of(TileKey tile, const SegmentOptions& options, const LabelScheme& scheme,
                           const LayerWork& work) {
  TileTally tally;
  std::vector<std::uint16_t> all;
  ClassesOfTile classes(tile, options, work);
  read_tile_pieces(work.folder(), tile, [&](PointCloud& piece) {
    tally.had_labels = tally.had_labels || !piece.classes.empty();
    piece.classes.clear();
    for (const Vec3f p : piece.positions) {
      piece.classes.push_back(classes.next(p));
      ++tally.points[piece.classes.back()];
    }
    tally.rays += count_rays(piece, &scheme, work.job);
    all.insert(all.end(), piece.classes.begin(), piece.classes.end());
  });
  classes.finish();
  write_tile_classes(work.folder(), tile, all);
  tally.file = {work.layer.file(classes_file_of(tile)),
                sha256_of_file(work.path(classes_file_of(tile)))};
  return tally;
}

/// The files of all tiles, and what they say together.
void write_classes(const std::vector<SquareGroup>& groups, const PointClassifier& classifier,
                   const SegmentOptions& options, const LayerWork& work, ResumableFolder& folder) {
  SegmentReport report;
  report.network = classifier.facts();
  for (const SquareGroup& group : groups) {
    const SquareClasses squares = read_square_classes(work.path(squares_file_of(group.tile)));
    report.classes.cells += squares.cells;
    report.classes.tiles += squares.squares;
  }
  std::size_t rays = 0;
  std::map<std::uint16_t, std::size_t> points;
  for_tiles(
      work,
      [&](TileKey tile) { return write_classes_of(tile, options, semantickitti_labels(), work); },
      [&](const TileTally& tally) {
        folder.record(std::span(&tally.file, 1));
        rays += tally.rays;
        report.replaced_labels = report.replaced_labels || tally.had_labels;
        for (const auto& [id, count] : tally.points) points[id] += count;
      });
  for (std::size_t k = 0; k < classifier.names().size(); ++k)
    report.classes.by_class.push_back({classifier.names()[k], points[classifier.ids()[k]]});
  Json json = to_json(report);
  json["rays"] = rays;
  write_file_in_place(work.path(kClassesFile), json.dump(1) + "\n");
  folder.record(work.layer.file(kClassesFile));
}

bool is_done(const LayerWork& work, const ResumableFolder& folder) {
  return folder.has(work.layer.file(kClassesFile)) &&
         std::ranges::all_of(work.tiles.tiles, [&](TileKey tile) {
           return folder.has(work.layer.file(classes_file_of(tile)));
         });
}

}  // namespace

void load_classes(LayerWork& work) {
  const std::filesystem::path file = work.path(kClassesFile);
  const std::string text = read_file(file);
  try {
    const Json json = Json::parse(text);
    SegmentReport report;
    const Json& network = json.at("network");
    report.network = {network.at("name"), network.at("sha256"), network.at("card")};
    report.classes.cells = json.at("cells");
    report.classes.tiles = json.at("tiles");
    for (const auto& [name, points] : json.at("classes").items())
      report.classes.by_class.push_back({name, points});
    report.replaced_labels = json.at("replaced_labels");
    work.layer.facts.rays = json.at("rays");
    work.segmented = std::move(report);
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

void give_classes(const PointClassifier& classifier, LayerWork& work, ResumableFolder& folder) {
  require_reach(work.layer.facts.box);
  if (!is_done(work, folder)) {
    SegmentOptions options;
    options.full_intensity = full_intensity_of(work, folder);
    const std::vector<SquareGroup> groups = groups_of_squares(options, work);
    segment_squares(groups, classifier, options, work, folder);
    write_classes(groups, classifier, options, work, folder);
  }
  load_classes(work);
  if (work.segmented->replaced_labels) work.session.progress.warn(kLabelsReplaced);
}

}  // namespace adasplats
