// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Two clouds: files, sequence folders or outputs of simulate.
struct CloudFiles {
  std::filesystem::path simulated;
  std::filesystem::path original;
  std::string labels;  ///< as label_scheme_for takes it
};

struct CloudPair {
  PointCloud simulated;
  PointCloud original;
  std::optional<LabelScheme> labels;
};

CloudPair load_clouds(const CloudFiles& files, Session& session);

struct CloudComparison {
  CloudDistance distance;
  std::vector<std::pair<std::string, ClassDistance>> by_class;  ///< by name; empty: not asked for
};

/// Whether clouds are compared class by class as well, and what class a simulated point is of.
enum class ByClass : std::uint8_t {
  no,
  own,     ///< the one that it has
  nearest  ///< that of the nearest original point: where its own is a network's, or there is none
};

/// `labels` names the classes; null: they go by their numbers.
CloudComparison evaluate_clouds(const PointCloud& simulated, const PointCloud& original,
                                ByClass by_class, const LabelScheme* labels, Session& session);

/// Mean C2C over the points of several classes, by name; NaN where none has points.
double c2c_of_classes(const CloudComparison& comparison, const std::vector<std::string>& names);

/// The keys of the --report.
nlohmann::ordered_json to_json(const CloudComparison& comparison);

}  // namespace adasplats
