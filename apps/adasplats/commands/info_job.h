// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "cli/session.h"

namespace adasplats::app {

/// What `info` says of one input.
struct FileFacts {
  std::string kind;  ///< "point cloud", "splat model", "mesh", "sequence"...
  std::vector<std::pair<std::string, std::string>> rows;       ///< what: value, as shown
  std::vector<std::pair<std::string, std::uint64_t>> classes;  ///< points (splats, triangles) each
  nlohmann::ordered_json json;
};

/// Reads a file or folder of any kind that the program knows.
FileFacts run_info(const std::filesystem::path& input, const std::string& labels,
                   const LoadOptions& options, Session& session);

/// The sensors of a rig file, or the one that `topic` names.
std::vector<FileFacts> run_rig_info(const std::filesystem::path& rig_file,
                                    const std::string& labels, const LoadOptions& options,
                                    Session& session);

}  // namespace adasplats::app
