// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/core/setting.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/synth/mesh_builder.h"

namespace adasplats {

/// A drive through a procedural city, as long as wished.
struct SynthCityOptions {
  std::uint64_t seed = 1;
  double length_m = 1000;           ///< of the drive
  std::optional<double> points;     ///< of all scans, to one scan's; instead of spacing_m
  std::optional<double> spacing_m;  ///< between scans; where neither is given, 1 m
  bool truth = true;                ///< whether the meshes are written
  std::string sensor = "velodyne-hdl-64e-kitti";  ///< as load_lidar_model takes it
};

template <class Visit>
void visit_settings(SynthCityOptions& city, Visit&& visit) {
  visit(Setting{.name = "length",
                .help = "Length of the drive, m or with a unit (10km)",
                .value = "M",
                .key = "length_m",
                .min = 50,
                .max = 1e6,
                .basic = true},
        city.length_m);
  visit(Setting{.name = "points",
                .help = "Number of points of all scans together; determines their spacing",
                .value = "N",
                .min = 1,
                .max = 1e12,
                .basic = true},
        city.points);
  visit(Setting{.name = "spacing",
                .help = "Distance between scans, m (default: 1 without --points)",
                .value = "M",
                .key = "spacing_m",
                .min = 0.001,
                .max = 1000,
                .basic = true},
        city.spacing_m);
  visit(Setting{.name = "truth",
                .help = "Write the exact surface of static objects, tile by tile",
                .basic = true},
        city.truth);
}

/// What a drive through a city was.
struct SynthCityReport {
  std::size_t scans = 0;
  std::size_t points = 0;
  std::size_t pieces = 0;             ///< that were within the sensor's range at some time
  std::size_t max_pieces = 0;         ///< in memory at once
  std::size_t mesh_triangles = 0;     ///< of all pieces
  std::size_t pieces_made_again = 0;  ///< where the drive came back
};

/// What receives the parts of a city. Several threads call at once, in any order.
struct SynthCitySink {
  /// Scan number `index`; every number from 0 on comes once.
  std::function<void(std::size_t index, const Scan& scan)> scan;
  /// What stands in a piece, "x0_y2_east": once, when it comes into the sensor's range.
  std::function<void(const std::string& name, const BuiltMesh& piece)> piece;
  /// Scans up to this number have come; from the calling thread.
  std::function<void(std::size_t scans)> scans_done;
};

/// Drives through a city and scans it. Only pieces around the sensor are in memory. Depends on the
/// options alone: not on threads, nor on which pieces were there before. Ranges are noisy and some
/// returns lost as scan_world has them.
/// Errors: usage (an option out of its range; points and spacing both; scans nearer together than
/// 1 mm or more than a million), those of load_lidar_model.
SynthCityReport scan_synth_city(const SynthCityOptions& options, const SynthCitySink& sink,
                                const Executor& executor, ProgressSink& progress);

/// Scans and writes a city: FOLDER/sequences/00/ (SemanticKITTI) and FOLDER/truth/NAME.ply (the
/// meshes of pieces as save_street_mesh() writes them). Scans are written in place: the folder is
/// whole when this returns.
/// Errors: as scan_synth_city; cannot_create (also where sequences/00 is there already), io.
SynthCityReport write_synth_city(const std::filesystem::path& folder,
                                 const SynthCityOptions& options, const Executor& executor,
                                 ProgressSink& progress);

}  // namespace adasplats
