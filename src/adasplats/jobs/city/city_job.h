// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "adasplats/core/setting.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/splats/consistent/consistent_model.h"

namespace adasplats {

/// How a place is cut into tiles.
struct TileChoice {
  double tile_m = 0;  ///< side of a tile; 0: the place is modelled in one piece
  double halo_m = 8;  ///< around a tile what it is modelled with
};

template <class Visit>
void visit_settings(TileChoice& choice, Visit&& visit) {
  constexpr const char* kGroup = "Cities";
  visit(
      Setting{.name = "tile",
              .help = "Model square tiles of this side, m, one by one; the output is a folder. By "
                      "default only if one model exceeds the memory",
              .key = "tile_m",
              .group = kGroup,
              .min = 0,
              .max = 10'000,
              .basic = true},
      choice.tile_m);
  visit(Setting{.name = "halo",
                .help = "Margin of points around a tile that it is modelled with, m; splats "
                        "farther than this from the tile's borders equal those of one large model",
                .key = "halo_m",
                .group = kGroup,
                .min = 0,
                .max = 1'000},
        choice.halo_m);
}

/// By what the size of tiles is chosen (advise_tiles()).
struct MemoryChoice {
  double memory_gb = 0;  ///< that modelling may take; 0: three quarters of what the process may use
  std::size_t tiles_at_once = 0;  ///< at most; 0: as many as suit the threads and GPUs
};

template <class Visit>
void visit_settings(MemoryChoice& choice, Visit&& visit) {
  visit(Setting{.name = "memory",
                .help = "Memory limit of modelling, GB or with a unit (8G, 500M); larger inputs "
                        "are modelled in tiles (default: three quarters of the available memory)",
                .value = "GB",
                .key = "memory_gb",
                .group = "Cities",
                .min = 0,
                .max = 1e6},
        choice.memory_gb);
}

/// Limits for points that are added to a city.
struct AdditionChoice {
  double max_shift_m = 0.1;  ///< offset from its splats (PointFit)
};

template <class Visit>
void visit_settings(AdditionChoice& choice, Visit&& visit) {
  visit(Setting{.name = "max_shift",
                .help =
                    "Maximum offset between added points and the city, m; a larger one is an error",
                .key = "max_shift_m",
                .group = "Cities",
                .min = 0,
                .max = 1'000},
        choice.max_shift_m);
}

/// Points of any number in, the folder of a city out.
struct CityJob : ModelJob {
  TileChoice tiles;
  MemoryChoice memory;
  bool keep_points = false;  ///< in the folder, so that others can be added
  /// A city that the points are added to; empty: none. Its tiles are cut as `tiles` says.
  std::filesystem::path add_to;
  AdditionChoice addition;
  std::filesystem::path output;
  bool overwrite = false;
};

/// The options of the method, without `refine`: rays that end outside a tile would not count.
/// Errors: usage (a method that is not `consistent`).
ConsistentOptions consistent_options_of(const CityJob& job);

/// What the files of a city depend on, for its adasplats.json; of a network its file alone, and not
/// what is in it. Errors: as above.
nlohmann::ordered_json content_of(const CityJob& job);

}  // namespace adasplats
