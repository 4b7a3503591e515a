// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// One [[object]] of a world file.
struct WorldFileObject {
  std::uint64_t line = 0;  ///< of the file, for messages
  std::string name;        ///< default: the file name of the geometry
  std::filesystem::path geometry;
  /// A number, or a name of the label scheme.
  std::optional<std::variant<std::uint16_t, std::string>> class_id;
  std::uint16_t instance = 0;
  /// Pose of the geometry in the world, or in the frame that `trajectory` moves.
  RigidTransform placement;
  std::filesystem::path trajectory;  ///< empty: at rest
  double delay_s = 0;
  double speed_factor = 1;
  bool only_during = false;
  std::optional<std::array<double, 2>> only_between_s;
  std::optional<std::uint64_t> only_scan;
  double scale = 1;
};

/// What stands and moves in a place, as a TOML file (docs/worlds.md):
///     model = "street.ply"        # the place: splats or a mesh; optional
///     [[object]]
///     geometry = "car.glb"        # splats (PLY) or a mesh (PLY, OBJ, glTF)
///     class = "car"               # or a number; default: the geometry's classes
///     instance = 7                # default: 1 for the first object, 2 for the second, ...
///     position = [12.0, -3.5, 0]  # m, world coordinates
///     yaw_deg = 90                # also pitch_deg, roll_deg
///     scale = 1.0
///     trajectory = "car.csv"      # world_from_object (read_trajectory); position and angles are
///                                 # then those of the geometry in the frame that it moves
///     delay_s = 2                 # later by this
///     speed_factor = 1.5          # along the trajectory, from its first pose on
///     present = "always"          # "during": between the first and the last pose only; or two
///                                 # times, [12.5, 13.0], before delay and speed factor
///     scan = 12                   # there in this scan alone
///     name = "taxi"
/// Paths are relative to the file.
struct WorldFile {
  std::filesystem::path path;
  std::filesystem::path model;  ///< empty: the file names none
  std::vector<WorldFileObject> objects;
};

/// Reads the file and checks that the files it names exist. Errors: config with the line (an
/// unknown key, with the nearest known key; a value of the wrong type or out of range), no_input (a
/// named file does not exist, with the line).
WorldFile read_world_file(const std::filesystem::path& path);

/// Loads the geometries of the objects, each file once, and adds the objects to `world`. Class
/// names are those of `scheme`. Errors: config with the line (an unknown class, with the nearest
/// known class; "during" without a second pose), those of load_mesh, load_model and
/// read_trajectory.
void add_objects(World& world, const WorldFile& file, const LabelScheme& scheme);

}  // namespace adasplats
