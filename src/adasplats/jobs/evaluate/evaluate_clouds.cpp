// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

std::string class_name(const LabelScheme* scheme, std::uint16_t id) {
  const SemanticClass* found = scheme != nullptr ? scheme->find(id) : nullptr;
  return found == nullptr ? "class " + std::to_string(id) : found->name;
}

/// The places of the points and the classes that the original has there.
PointCloud with_nearest_classes(const PointCloud& simulated, const PointCloud& original,
                                const Executor& executor) {
  PointCloud points;
  points.origin = simulated.origin;
  points.positions = simulated.positions;
  points.classes = nearest_classes(simulated, original, executor);
  return points;
}

}  // namespace

CloudPair load_clouds(const CloudFiles& files, Session& session) {
  const std::array<std::filesystem::path, 2> inputs = {resolve_cloud_input(files.simulated),
                                                       resolve_cloud_input(files.original)};
  const auto load = [&](std::size_t k) {
    return load_cloud(std::span(inputs).subspan(k, 1), {}, session.executor, session.progress)
        .first;
  };
  CloudPair pair;
  pair.labels = label_scheme_for(files.labels, inputs);
  pair.simulated = load(0);
  pair.original = load(1);
  require_one_crs({{inputs[0], pair.simulated.crs}, {inputs[1], pair.original.crs}},
                  session.progress);
  return pair;
}

CloudComparison evaluate_clouds(const PointCloud& simulated, const PointCloud& original,
                                ByClass by_class, const LabelScheme* labels, Session& session) {
  CloudComparison comparison;
  session.progress.begin_step("compare", kPassUnits);
  comparison.distance = cloud_distance(simulated, original, session.executor);
  if (by_class != ByClass::no) {
    session.progress.begin_step("compare classes", kPassUnits);
    for (const ClassDistance& c :
         by_class == ByClass::own
             ? cloud_distance_by_class(simulated, original, session.executor)
             : cloud_distance_by_class(with_nearest_classes(simulated, original, session.executor),
                                       original, session.executor))
      comparison.by_class.emplace_back(class_name(labels, c.class_id), c);
  }
  session.progress.end_step();
  return comparison;
}

double c2c_of_classes(const CloudComparison& comparison, const std::vector<std::string>& names) {
  double sum_m = 0;
  double points = 0;
  for (const auto& [name, distance] : comparison.by_class) {
    const bool wanted = std::find(names.begin(), names.end(), name) != names.end();
    if (!wanted || std::isnan(distance.c2c_m)) continue;
    sum_m += distance.c2c_m * static_cast<double>(distance.simulated_points);
    points += static_cast<double>(distance.simulated_points);
  }
  return points > 0 ? sum_m / points : std::numeric_limits<double>::quiet_NaN();
}

nlohmann::ordered_json to_json(const CloudComparison& comparison) {
  nlohmann::ordered_json json = to_json(comparison.distance);
  json["simulated_points"] = comparison.distance.simulated_points;
  json["original_points"] = comparison.distance.original_points;
  json["by_class"] = nlohmann::ordered_json::object();
  for (const auto& [name, distance] : comparison.by_class) {
    json["by_class"][name] = {{"c2c_m", distance.c2c_m},
                              {"c2c_to_all_m", distance.c2c_to_all_m},
                              {"points", distance.simulated_points},
                              {"original_points", distance.original_points}};
  }
  return json;
}

}  // namespace adasplats
