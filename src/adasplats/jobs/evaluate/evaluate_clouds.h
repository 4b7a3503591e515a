// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Two clouds: point files, sequence folders or outputs of `simulate`.
struct CloudFiles {
  std::filesystem::path simulated;
  std::filesystem::path original;
  std::string labels;  ///< label scheme as for label_scheme_for()
};

struct CloudPair {
  PointCloud simulated;
  PointCloud original;
  std::optional<LabelScheme> labels;
};

/// Errors: those of load_cloud, usage where the clouds have different coordinate systems.
CloudPair load_clouds(const CloudFiles& files, Session& session);

/// Whether to compare class by class too, and which class a simulated point belongs to.
enum class ByClass : std::uint8_t {
  no,
  own,     ///< its own
  nearest  ///< that of the nearest original point, for points without classes of their own or with
           ///< classes predicted by a network
};

struct CloudComparison {
  CloudDistance distance;
  std::vector<std::pair<std::string, ClassDistance>> by_class;  ///< by name; empty with ByClass::no
};

/// `labels` names the classes; null: they are named by number.
CloudComparison evaluate_clouds(const PointCloud& simulated, const PointCloud& original,
                                ByClass by_class, const LabelScheme* labels, Session& session);

struct CloudComparisonJob : CloudFiles {
  ByClass by_class = ByClass::no;
  /// PNG of the simulated points, coloured by their distance to the nearest original point from 0
  /// to 20 cm; empty: none.
  std::filesystem::path picture;
  /// Of the picture. By default the original cloud determines the camera, so pictures of several
  /// simulations can be overlaid.
  ViewChoice view = {.width = 1920, .height = 1080};
  std::filesystem::path errors;  ///< PLY of the simulated points with their distances; empty: none
};

/// Loads, compares and draws.
CloudComparison evaluate_clouds(const CloudComparisonJob& job, Session& session);

/// Mean C2C over the points of several classes, by name; NaN if none has points.
double c2c_of_classes(const CloudComparison& comparison, const std::vector<std::string>& names);

/// The keys of --report.
nlohmann::ordered_json to_json(const CloudDistance& distance);
nlohmann::ordered_json to_json(const CloudComparison& comparison);

}  // namespace adasplats
