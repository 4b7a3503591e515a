// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <cstdio>

#include "adasplats/core/memory.h"
#include "adasplats/io/atomic_file.h"

namespace adasplats::app {
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

/// Numbers and truth values in their own type; everything else as text.
Json value_of(const std::string& text, const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return text == "true" || text == "1";
  Json number = Json::parse(text, nullptr, false);
  return number.is_number() ? number : Json(text);
}

Json parameters_of(CLI::App& app) {
  Json parameters = Json::object();
  for (const CLI::Option* option : settings_of(app)) {
    const auto& names = option->get_lnames();
    Json& value = parameters[names.empty() ? option->get_name() : names.front()];
    const std::vector<std::string>& given = option->results();
    if (option->get_items_expected_max() > 1) {
      value = given;
    } else if (!given.empty()) {
      value = value_of(given.back(), *option);
    } else if (!option->get_default_str().empty()) {
      value = value_of(option->get_default_str(), *option);
    }
  }
  return parameters;
}

}  // namespace

void write_report(Command& command, const Session& session) {
  Json report;
  report["program"] = "adasplats";
  report["version"] = ADASPLATS_VERSION;
  report["command"] = command.full_name();
  report["parameters"] = parameters_of(command.options());
  report["threads"] = session.executor.threads();
  if (command.device()) report["device"] = to_json(session.device);
  report.update(session.report);
  report["warnings"] = session.progress.warnings();
  report["peak_memory_bytes"] = peak_memory_bytes();
  // Names of files need not be UTF-8; JSON must be.
  write_file(command.common().report,
             report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

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

}  // namespace adasplats::app
