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
#include "adasplats/jobs/segment/scan_windows.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/segment/segment_cloud.h"

namespace adasplats {

/// Classes of points, by a network: points in, the same points with labels out.
struct SegmentJob {
  std::vector<std::filesystem::path> inputs;  ///< sequences, or files of points
  LoadOptions load;
  std::filesystem::path network;    ///< empty: default_network()
  std::filesystem::path class_map;  ///< read_class_map(); empty: SemanticKITTI's numbers
  SegmentOptions segment;
  WindowOptions window;
  std::filesystem::path output;  ///< a folder for sequences, else a file
  bool overwrite = false;
};

template <class Visit>
void visit_settings(SegmentOptions& segment, Visit&& visit) {
  visit(Setting{.name = "tile",
                .help = "Side of the squares processed one after the other, m",
                .value = "M",
                .key = "tile_m",
                .min = 1,
                .max = 1000},
        segment.tile_m);
  visit(Setting{.name = "margin",
                .help = "Context around each square, m",
                .value = "M",
                .key = "margin_m",
                .min = 0,
                .max = 100},
        segment.margin_m);
  visit(Setting{.name = "intensity", .help = "Use the intensities of the points, if available"},
        segment.intensity);
}

struct SegmentResult {
  struct ClassCount {
    std::string name;
    std::size_t points = 0;
  };
  std::size_t points = 0;            ///< that have a label now
  std::size_t points_unlabeled = 0;  ///< not finite, or too far away
  std::size_t cells = 0, tiles = 0;  ///< that the network saw
  std::size_t windows = 0;           ///< of scans that were looked at together
  std::vector<ClassCount> classes;   ///< in the order of the network
  double load_seconds = 0, segment_seconds = 0;
};

/// Gives every point the class that the network sees there. Of sequence folders (chosen scans, put
/// in place by their poses and looked at window by window) OUTPUT is a SemanticKITTI tree:
/// sequences/00 for the first folder and so on, labels/NNNNNN.label with a number for every point
/// of the scan in its order, links to the scans in velodyne/ and the files of poses; beside
/// `labels`, on demand, confidences/NNNNNN.bin (save_floats(), a number a point) and
/// probabilities/NNNNNN.bin (a number a class and point). Of files of points it is one PLY, LAS or
/// LAZ of all points (LabelledPoints), of a single .bin also a .label, as its name says. Numbers
/// are SemanticKITTI's or the class map's. Errors: usage (sequences beside files, an output of
/// another ending, that is or lies among the inputs), data (no points; a class of the network that
/// SemanticKITTI does not have), unavailable (built without OpenBLAS), those of read_network,
/// read_class_map, load_cloud and OutputFolder.
SegmentResult run_segment(const SegmentJob& job, Session& session);

/// The keys of the command's report.
nlohmann::ordered_json to_json(const SegmentResult& result);

}  // namespace adasplats
