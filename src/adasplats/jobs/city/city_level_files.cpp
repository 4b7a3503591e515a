// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_level_files.h"

#include <filesystem>
#include <string>

#include "adasplats/city/city_levels.h"

namespace adasplats {

void write_level_files(const CityManifest& city, ResumableFolder& folder, Session& session) {
  std::filesystem::create_directories(folder.path() / "levels");
  session.progress.begin_step("levels of detail", city.tiles.size());
  const LevelFacts facts = survey_levels(folder.path(), city);
  for (std::size_t k = 0; k < city.tiles.size(); ++k) {
    const std::string file = levels_file_of(city.tiles[k].key);
    if (city.tiles[k].splats > 0 && !folder.has(file)) {
      write_tile_levels(folder.path(), city, k, facts, session.executor);
      folder.record(file);
    }
    session.progress.advance(k + 1);
  }
  write_top_levels(
      folder.path(), city, facts,
      [&](const std::string& file) { return folder.recorded().at(file); }, session.executor);
  folder.record(std::string(kTopLevelsFile));
  session.progress.end_step();
}

}  // namespace adasplats
