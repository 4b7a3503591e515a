// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_survey.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/city/tile_workers.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/repeated_warnings.h"
#include "adasplats/splats/model_engine.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// Approximate number of points in the tiles that the spacing of cells is measured in.
constexpr std::size_t kSurveyedPoints = 16'000'000;

/// Spacings of cells by whether they have a beam.
struct Spacings {
  std::vector<float> with_beam, without;
  std::size_t cells = 0, limited = 0;  ///< CellSpacing::limited
};

/// Tiles in which the spacing of cells is measured: all, or every n-th.
std::vector<TileKey> surveyed(const CityWork& work) {
  std::size_t points = 0;
  for (const TileKey tile : work.tiles.tiles) points += work.points_in(tile);
  const std::size_t every = std::max<std::size_t>(1, points / kSurveyedPoints);
  std::vector<TileKey> chosen;
  std::size_t k = 0;
  for (const TileKey tile : work.tiles.tiles)
    if (k++ % every == 0) chosen.push_back(tile);
  return chosen;
}

Spacings spacings_in(TileKey tile, const LabelScheme* scheme, const ModelEngine& engine,
                     const CityWork& work) {
  Spacings found;
  PointCloud cloud = points_around(tile, work);
  ClassTables tables;
  tables.removed = points_to_remove(cloud, scheme, work.job.build.remove).ids;
  GlobalContext whole;
  whole.box = work.first().box;
  const std::unique_ptr<ConsistentSteps> steps = engine.consistent_steps();
  if (steps->load(std::move(cloud), tables, &whole) == 0) return found;
  steps->fuse(work.options);
  const GroundBox own = work.tiles.grid.box_of(tile);
  for (const CellSpacing& cell : steps->spacings(work.options)) {
    if (!own.contains(work.origin() + vec_cast<double>(cell.place))) continue;
    ++found.cells;
    found.limited += cell.limited ? 1 : 0;
    if (!(cell.spacing > 0)) continue;
    (cell.with_beam ? found.with_beam : found.without).push_back(cell.spacing);
  }
  return found;
}

}  // namespace

TypicalSpacing load_spacing(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    const Json json = Json::parse(text);
    return {json.at("with_beam"), json.at("without"), json.value("limited", 0.0)};
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::data, file.string() + ": damaged: " + error.what());
  }
}

void survey_spacing(CityWork& work, ResumableFolder& folder) {
  if (folder.has(kSpacingFile)) {
    work.typical = load_spacing(work.path(kSpacingFile));
    return;
  }
  const std::optional<LabelScheme> scheme = scheme_of(work.job);
  const std::vector<TileKey> chosen = surveyed(work);
  ProgressSink& progress = work.session.progress;
  progress.begin_step("spacing of cells", chosen.size());
  RepeatedWarnings warnings(progress, "tiles");
  std::vector<Spacings> of_tiles(chosen.size());
  std::size_t done = 0;
  const auto survey = [&](std::size_t k, Session& session) {
    with_model_engine(session, [&](const ModelEngine& engine) {
      of_tiles[k] = spacings_in(chosen[k], scheme ? &*scheme : nullptr, engine, work);
    });
  };
  work_side_by_side(chosen.size(), work.job.memory.tiles_at_once, work.session, warnings, survey,
                    [&](std::size_t) { progress.advance(++done); });
  progress.end_step();
  warnings.end();
  Spacings found;
  for (const Spacings& some : of_tiles) {
    found.with_beam.insert(found.with_beam.end(), some.with_beam.begin(), some.with_beam.end());
    found.without.insert(found.without.end(), some.without.begin(), some.without.end());
    found.cells += some.cells;
    found.limited += some.limited;
  }
  work.typical = typical_spacing(std::move(found.with_beam), std::move(found.without));
  if (found.cells > 0)
    work.typical.limited = static_cast<double>(found.limited) / static_cast<double>(found.cells);
  const Json json = {{"with_beam", work.typical.with_beam},
                     {"without", work.typical.without},
                     {"limited", work.typical.limited}};
  write_file_in_place(work.path(kSpacingFile), json.dump() + "\n");
  folder.record(std::string(kSpacingFile));
}

}  // namespace adasplats
