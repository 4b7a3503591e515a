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

/// A drive of any length through a procedural city.
struct SynthCityOptions {
  std::uint64_t seed = 1;
  double length_m = 1000;  ///< of the drive
  std::optional<double>
      points;  ///< target for all scans, met to within one scan; excludes spacing_m
  std::optional<double> spacing_m;                ///< between scans; default without `points`: 1 m
  bool truth = true;                              ///< write the meshes
  std::string sensor = "velodyne-hdl-64e-kitti";  ///< as for load_lidar_model
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

/// Figures of a drive through a city.
struct SynthCityReport {
  std::size_t scans = 0;
  std::size_t points = 0;
  std::size_t pieces = 0;             ///< street sections that were within the sensor's range
  std::size_t max_pieces = 0;         ///< maximum number of sections in memory
  std::size_t mesh_triangles = 0;     ///< of all sections
  std::size_t pieces_made_again = 0;  ///< sections that were dropped and built again
};

/// Receives scans and sections. Several threads call it at once, in any order.
struct SynthCitySink {
  /// Scan number `index`; called once for every number from 0.
  std::function<void(std::size_t index, const Scan& scan)> scan;
  /// Static mesh of a section, with its name ("x0_y2_east"): called once, when the section first
  /// comes within the sensor's range.
  std::function<void(const std::string& name, const BuiltMesh& section)> section;
  /// All scans below this number have been delivered; called from the calling thread.
  std::function<void(std::size_t scans)> scans_done;
};

/// Drives through a city and scans it. Only sections around the sensor are in memory. The result
/// depends only on the options, not on threads or on the sections in memory. Range noise and lost
/// returns are those of scan_world().
/// Errors: usage (an option out of range; both points and spacing; a scan spacing below 1 mm; more
/// than a million scans), those of load_lidar_model.
SynthCityReport scan_synth_city(const SynthCityOptions& options, const SynthCitySink& sink,
                                const Executor& executor, ProgressSink& progress);

/// Scans a city and writes it: FOLDER/sequences/00/ (SemanticKITTI) and FOLDER/truth/NAME.ply
/// (meshes of sections, in the format of save_street_mesh()). Scans are written in place, so the
/// folder is complete only when this returns.
/// Errors: those of scan_synth_city; cannot_create (also if sequences/00 exists), io.
SynthCityReport write_synth_city(const std::filesystem::path& folder,
                                 const SynthCityOptions& options, const Executor& executor,
                                 ProgressSink& progress);

}  // namespace adasplats
