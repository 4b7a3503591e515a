// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "evaluate_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adasplats/cloud/kitti_sequence.h"
#include "adasplats/cloud/load_cloud.h"
#include "inputs.h"
#include "model_scene.h"
#include "report.h"

namespace adasplats::app {
namespace {

std::string class_name(const std::optional<LabelScheme>& scheme, std::uint16_t id) {
  const SemanticClass* found = scheme ? scheme->find(id) : nullptr;
  return found == nullptr ? "class " + std::to_string(id) : found->name;
}

}  // namespace

CloudComparison run_cloud_comparison(const CloudComparisonJob& job, Session& session) {
  const std::array<std::filesystem::path, 2> inputs = {resolve_cloud_input(job.simulated),
                                                       resolve_cloud_input(job.original)};
  const auto scheme = label_scheme_for(job.labels, inputs);
  const auto load = [&](std::size_t k) {
    return load_cloud(std::span(inputs).subspan(k, 1), {}, session.executor, session.progress)
        .first;
  };
  const PointCloud simulated = load(0);
  const PointCloud original = load(1);
  CloudComparison comparison;
  session.progress.begin_step("compare", 0);
  comparison.distance = cloud_distance(simulated, original, session.executor);
  if (job.by_class) {
    session.progress.begin_step("compare classes", 0);
    for (const ClassDistance& c : cloud_distance_by_class(simulated, original, session.executor)) {
      comparison.by_class.emplace_back(class_name(scheme, c.class_id), c);
    }
  }
  session.progress.end_step();
  return comparison;
}

ResimulateResult run_resimulate(const ResimulateJob& job, Session& session) {
  require_input(job.model);
  const LabelScheme labels = load_label_scheme(job.labels);
  const KittiSequence sequence = open_kitti_sequence(resolve_cloud_input(job.sequence));
  const ModelScene scene(job.model, session);
  return resimulate(scene.tracer(), scene.model().view(), scene.model().origin, sequence, labels,
                    job.options, session.executor, session.progress);
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

nlohmann::ordered_json to_json(const ResimulateResult& result) {
  nlohmann::ordered_json json = to_json(result.all);
  json.update(to_json(result.clouds));
  const auto add = [&](const char* key, const auto& parts) {
    json[key] = nlohmann::ordered_json::object();
    for (const auto& [name, accuracy] : parts) json[key][name] = to_json(accuracy);
  };
  add("by_range", result.by_range);
  add("by_incidence", result.by_incidence);
  add("by_class", result.by_class);
  return json;
}

}  // namespace adasplats::app
