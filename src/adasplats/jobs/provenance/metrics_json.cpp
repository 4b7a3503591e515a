// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/provenance/metrics_json.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

std::string metres_key(double bound_m) {
  std::array<char, 32> text{};
  // 0.05, 0.10 and 0.224, which is the square root of 0.05.
  const bool short_form = std::fabs(bound_m * 100 - std::round(bound_m * 100)) < 1e-9;
  std::snprintf(text.data(), text.size(), short_form ? "%.2f" : "%.3f", bound_m);
  return text.data();
}

Json by_bound(const std::map<double, double>& values) {
  Json json = Json::object();
  for (const auto& [bound_m, value] : values) json[metres_key(bound_m)] = value;
  return json;
}

Json to_json(const DistanceSummary& surface) {
  return {{"mean", surface.mean_m},
          {"median", surface.median_m},
          {"p95", surface.p95_m},
          {"rmse", surface.rmse_m}};
}

Json to_json(const Presence& presence) {
  return {{"points", presence.points}, {"present", presence.present}};
}

Json to_json(const LabelAgreement& agreement) {
  Json json = {{"points", agreement.points}, {"agree", agreement.agree}};
  if (agreement.points > 0) {
    json["share"] = agreement.share();
    json["distance_m"] = agreement.distance_m;
  }
  return json;
}

Json confusion_json(const SegmentationConfusion& confusion, const Json& names) {
  Json counts = Json::array();
  for (std::size_t truth = 0; truth < confusion.classes(); ++truth) {
    Json row = Json::array();
    for (std::size_t predicted = 0; predicted <= confusion.classes(); ++predicted)
      row.push_back(confusion.count(truth, predicted));
    counts.push_back(row);
  }
  return {{"classes", names}, {"counts", counts}};
}

Json groups_json(const SegmentationConfusion& groups) {
  Json iou = Json::object();
  const std::vector<std::string> names = segmentation_groups();
  for (std::size_t g = 0; g < names.size(); ++g)
    if (groups.of_truth(g) > 0) iou[names[g]] = groups.iou(g);
  return {{"miou", groups.mean_iou()}, {"iou", iou}};
}

}  // namespace

Json to_json(const CloudDistance& distance) {
  Json json;
  json["c2c_m"] = distance.c2c_m;
  json["completeness_m"] = distance.completeness_m;
  json["chamfer_m"] = distance.chamfer_m;
  json["chamfer_m2"] = distance.chamfer_m2;
  json["f_score"] = by_bound(distance.f_score);
  return json;
}

Json to_json(const BeamAccuracy& accuracy) {
  Json json;
  json["rays"] = accuracy.rays;
  json["no_hit"] = accuracy.no_hit;
  json["early_50cm"] = accuracy.early_50cm;
  json["late_50cm"] = accuracy.late_50cm;
  json["within"] = by_bound(accuracy.within);
  json["range_error_m"] = {{"median", accuracy.median_m}, {"mae", accuracy.mae_m},
                           {"rmse", accuracy.rmse_m},     {"p90", accuracy.p90_m},
                           {"bias", accuracy.bias_m},     {"spread", accuracy.spread_m}};
  return json;
}

Json to_json(const ResimulateResult& result) {
  Json json = to_json(result.all);
  json.update(to_json(result.clouds));
  json["beams"] = result.beams;
  const auto add = [&](const char* key, const auto& parts) {
    json[key] = nlohmann::ordered_json::object();
    for (const auto& [name, accuracy] : parts) json[key][name] = to_json(accuracy);
  };
  add("by_range", result.by_range);
  add("by_incidence", result.by_incidence);
  add("by_class", result.by_class);
  add("by_elevation", result.by_elevation);
  return json;
}

Json to_json(const TruthResult& result) {
  Json json;
  json["rays"] = result.rays;
  json["rays_on_truth"] = result.all.range.rays;
  json["points"] = result.all.surface.points;
  json["hole_share"] = result.all.hole_share;
  json["ghost_share"] = result.ghost_share;
  json["bleeding_share"] = result.bleeding_share;
  json["surface_distance_m"] = to_json(result.all.surface);
  json["range"] = to_json(result.all.range);
  json["by_class"] = nlohmann::ordered_json::object();
  for (const auto& [name, accuracy] : result.by_class) {
    json["by_class"][name] = {{"rays", accuracy.range.rays},
                              {"points", accuracy.surface.points},
                              {"hole_share", accuracy.hole_share},
                              {"surface_distance_m", to_json(accuracy.surface)},
                              {"range", to_json(accuracy.range)}};
  }
  return json;
}

Json to_json(const PresenceResult& result) {
  Json json = {{"all", to_json(result.all)},
               {"moving", to_json(result.moving)},
               {"still", to_json(result.still)},
               {"by_class", Json::object()}};
  for (const auto& [name, part] : result.by_class) json["by_class"][name] = to_json(part);
  return json;
}

Json to_json(const LabelAgreementResult& result) {
  Json json = {{"all", to_json(result.all)},
               {"labelled", to_json(result.labelled)},
               {"by_class", Json::object()}};
  for (const auto& [id, agreement] : result.by_class)
    json["by_class"][std::to_string(id)] = to_json(agreement);
  return json;
}

Json to_json(const SegmentationResult& result) {
  const SegmentationConfusion& confusion = result.confusion;
  const double min_share = result.options.min_share;
  Json names = Json::array(), iou = Json::object(), share = Json::object(), rare = Json::array();
  for (std::size_t c = 0; c < confusion.classes(); ++c) {
    const std::string& name = result.classes.classes()[c].name;
    names.push_back(name);
    if (confusion.of_truth(c) == 0) continue;
    iou[name] = confusion.iou(c);
    share[name] = confusion.share(c);
    if (confusion.is_rare(c, min_share)) rare.push_back(name);
  }
  return {{"miou_present", confusion.mean_iou(min_share)},
          {"accuracy", confusion.accuracy()},
          {"points", confusion.points()},
          {"ignored", confusion.ignored()},
          {"iou", iou},
          {"share", share},
          {"rare", rare},
          {"groups", groups_json(grouped(confusion, result.classes))},
          {"confusion", confusion_json(confusion, names)}};
}

}  // namespace adasplats
