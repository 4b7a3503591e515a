// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/setting.h"
#include "adasplats/pipeline/session/scan_range.h"
#include "adasplats/pipeline/session/session.h"
#include "adasplats/segment/segment_cloud.h"

namespace adasplats {

/// Classes of points, by a network: points in, the same points with labels out.
struct SegmentJob {
  std::vector<std::filesystem::path> inputs;  ///< sequences, or files of points
  LoadOptions load;
  std::filesystem::path network;  ///< empty: default_network()
  SegmentOptions segment;
  std::filesystem::path output;  ///< a folder for sequences, else a PLY
  bool overwrite = false;
};

template <class Visit>
void visit_settings(SegmentOptions& segment, Visit&& visit) {
  visit(Setting{.name = "tile",
                .help = "Side of the squares that are looked at one after the other, m",
                .value = "M",
                .key = "tile_m",
                .least = 1,
                .most = 1000},
        segment.tile_m);
  visit(Setting{.name = "margin",
                .help = "How much around each square is looked at, too, m",
                .value = "M",
                .key = "margin_m",
                .least = 0,
                .most = 100},
        segment.margin_m);
  visit(Setting{.name = "intensity", .help = "Use the points' intensities, where they have some"},
        segment.intensity);
}

struct SegmentResult {
  struct ClassCount {
    std::string name;
    std::size_t points = 0;
  };
  std::size_t points = 0;            ///< that have a label now
  std::size_t points_unlabeled = 0;  ///< not finite
  std::size_t cells = 0, tiles = 0;  ///< that the network saw
  std::vector<ClassCount> classes;   ///< of the network, in its order
  double load_seconds = 0, segment_seconds = 0;
};

/// Gives every point the class that the network sees there. Of sequence folders (chosen scans, put
/// in place by their poses and looked at together) OUTPUT is a SemanticKITTI tree,
/// sequences/00/labels/NNNNNN.label for the first folder and so on, a number for every point of the
/// scan in its order, 0 for those that are not finite; of files of points a PLY of the points with
/// the column `label`. Numbers are SemanticKITTI's. Errors: usage (sequences beside files), data (a
/// class of the network that SemanticKITTI does not have), unavailable (built without OpenBLAS),
/// those of read_network, load_cloud and OutputFolder.
SegmentResult run_segment(const SegmentJob& job, Session& session);

/// The keys of the command's report.
nlohmann::ordered_json to_json(const SegmentResult& result);

}  // namespace adasplats
