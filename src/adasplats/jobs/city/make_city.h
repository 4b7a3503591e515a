// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/evaluate/point_fit.h"
#include "adasplats/jobs/city/city_alignment.h"
#include "adasplats/jobs/city/city_job.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/splats/build_model.h"

namespace adasplats {

struct CityResult {
  CityManifest city;
  std::size_t points_read = 0;
  std::size_t tiles_resumed = 0;             ///< an interrupted run had made
  std::size_t tiles_kept = 0;                ///< of a city that points were added to, as they were
  std::optional<AlignmentReport> alignment;  ///< of scans that were added
  std::optional<PointFit> fit;               ///< of points that were added, to that city
  std::optional<SegmentReport> segmented;    ///< where a network gave the points classes
  std::optional<OriginCheck> origins;        ///< by some tiles; nothing: they were not checked
  std::vector<StepTime> steps;
  double seconds = 0;
};

/// Reads the inputs piece by piece (drives 200 scans at a time, else file by file), sorts points
/// into tiles on disk, and models tile after tile on the session's device, each with the points
/// around it and the rays that cross it. Interrupted at any moment, the same job goes on. Memory: a
/// piece of the inputs, or a tile with what is around it.
///
/// Splats farther than the halo from all borders are those of one large model of the points, but
/// for choices between equally good ones that follow from others far away. Reflectances are by the
/// response of the sensor in the tile with the most points.
/// Errors: usage (a method that is not `consistent`), those of make_model and of ResumableFolder.
CityResult make_city(const CityJob& job, Session& session);

/// Does all that comes before the tiles, and the tile that the others need the sensor's response
/// from; gives the tiles that are still to be modelled. Each is a task of its own then
/// (make_city_tile), on as many machines as see the folder; make_city finishes it. Tasks that are
/// done are not done again. Errors: as make_city's.
std::vector<TileKey> plan_city(const CityJob& job, Session& session);

/// The keys of a city's --report.
nlohmann::ordered_json to_json(const CityResult& result);

}  // namespace adasplats
