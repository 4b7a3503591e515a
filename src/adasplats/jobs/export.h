// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// What other programs open (docs/exports.md).
enum class ExportFormat : std::uint8_t {
  gaussian_3d,
  gaussian_2d,
  tiles_3d,
  usd,
  glb,
  ply,
  las,
  laz,
  pcd,
  csv,
  mcap,
  semantickitti,
  kitti_raw,
  nuscenes,
  pandaset,
  argoverse2
};
inline constexpr std::pair<std::string_view, ExportFormat> kExportFormats[] = {
    {"gaussian-3d", ExportFormat::gaussian_3d},
    {"gaussian-2d", ExportFormat::gaussian_2d},
    {"3d-tiles", ExportFormat::tiles_3d},
    {"usd", ExportFormat::usd},
    {"glb", ExportFormat::glb},
    {"ply", ExportFormat::ply},
    {"las", ExportFormat::las},
    {"laz", ExportFormat::laz},
    {"pcd", ExportFormat::pcd},
    {"csv", ExportFormat::csv},
    {"mcap", ExportFormat::mcap},
    {"semantickitti", ExportFormat::semantickitti},
    {"kitti-raw", ExportFormat::kitti_raw},
    {"nuscenes", ExportFormat::nuscenes},
    {"pandaset", ExportFormat::pandaset},
    {"argoverse2", ExportFormat::argoverse2}};
/// What colours show.
enum class ExportColor : std::uint8_t { semantic, intensity, height, rgb };
inline constexpr std::pair<std::string_view, ExportColor> kExportColors[] = {
    {"class", ExportColor::semantic},
    {"intensity", ExportColor::intensity},
    {"height", ExportColor::height},
    {"rgb", ExportColor::rgb}};

/// A splat model, a point cloud or the scans of a drive, for other programs.
struct ExportJob {
  std::filesystem::path input, output;
  /// Else that of the output's ending, where that is clear.
  std::optional<ExportFormat> format;
  std::string labels;  ///< scheme of the classes; empty: what the model says
  /// Else default_color(): the colours of the file, else by class, intensity or height.
  std::optional<ExportColor> color;
  LoadOptions load;  ///< of clouds and sequences
  /// The setting that was given and is for these alone; empty: none.
  std::string cloud_option;
};

struct ExportResult {
  std::size_t count = 0;
  const char* unit = "";    ///< of `count`: "splats", "points" or "scans"
  std::size_t dropped = 0;  ///< points that were not finite or too far
  std::uint64_t written_bytes = 0;
  std::string place;  ///< of 3d-tiles: where they are on the Earth, or why that is unknown
};

/// Writes the file, or the folder of a data set. Errors: usage (a format that the input cannot
/// have, with those it can; an ending that says none), and those of reading and writing.
ExportResult run_export(const ExportJob& job, Session& session);

}  // namespace adasplats
