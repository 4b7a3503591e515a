// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/core/setting.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/synth/street.h"

namespace adasplats {

/// Kind of a procedural world.
enum class WorldKind : std::uint8_t { residential, suburban, rural, motorway, city };
inline constexpr std::pair<std::string_view, WorldKind> kWorldKinds[] = {
    {"residential", WorldKind::residential},
    {"suburban", WorldKind::suburban},
    {"rural", WorldKind::rural},
    {"motorway", WorldKind::motorway},
    {"city", WorldKind::city}};
inline Words<WorldKind> words_of(WorldKind) { return kWorldKinds; }

struct WorldOptions {
  std::uint64_t seed = 1;
  WorldKind kind = WorldKind::residential;
  double length_m = 200;  ///< of the road
};

/// How a world is scanned: by a sensor at KITTI's height in the right lane, on a drive around the
/// middle of the road.
struct WorldScanOptions {
  std::uint64_t seed = 1;
  std::size_t scans = 10;
  double spacing_m = 1;                           ///< between scans
  std::string sensor = "velodyne-hdl-64e-kitti";  ///< as for load_lidar_model
};

template <class Visit>
void visit_settings(WorldOptions& world, Visit&& visit) {
  visit(Setting{.name = "kind", .help = "Kind of scene", .basic = true}, world.kind);
  visit(Setting{.name = "length",
                .help = "Length of the road, m",
                .value = "M",
                .key = "length_m",
                .min = 80,
                .max = 1000,
                .basic = true},
        world.length_m);
}

template <class Visit>
void visit_settings(WorldScanOptions& scan, Visit&& visit) {
  visit(Setting{.name = "scans",
                .help = "Number of scans",
                .value = "N",
                .min = 1,
                .max = 10000,
                .basic = true},
        scan.scans);
  visit(Setting{.name = "spacing",
                .help = "Distance between scans, m",
                .value = "M",
                .key = "spacing_m",
                .min = 0,
                .max = 100,
                .basic = true},
        scan.spacing_m);
}

/// A scene for learning semantic classes: exact geometry with SemanticKITTI's classes, and another
/// layout for every seed. Metres, z up; the road is curved and starts at the origin.
struct SynthWorld {
  Street street;     ///< with a curved road; movers exist from time 0 on
  Trajectory drive;  ///< of the vehicle in the right lane, origin on the road, from end to end
};

/// Builds a world; depends only on the options. Errors: usage (length out of range).
SynthWorld make_world(const WorldOptions& options);

/// Scans a world; `on_scan` receives every scan (index, scan) in order. Ranges have the sensor's
/// noise; glass and bright metal lose some returns, and a few returns have random ranges and
/// SemanticKITTI's class outlier.
/// Errors: usage (an option out of range, more scans than fit on the road), those of
/// load_lidar_model.
void scan_world(const SynthWorld& world, const WorldScanOptions& options,
                const std::function<void(std::size_t, const Scan&)>& on_scan,
                const Executor& executor, ProgressSink& progress);

/// Figures of write_world().
struct WorldReport {
  std::size_t mesh_triangles = 0;
  std::size_t moving_objects = 0;
  std::size_t scans = 0;
  std::size_t points = 0;
};

/// Builds, scans and writes a world: FOLDER/sequences/00/ (SemanticKITTI) and mesh.ply (static
/// surfaces).
/// Errors: those of make_world and scan_world; cannot_create (also if sequences/00 exists), io.
WorldReport write_world(const std::filesystem::path& folder, const WorldOptions& world,
                        const WorldScanOptions& scan, const Executor& executor,
                        ProgressSink& progress);

}  // namespace adasplats
