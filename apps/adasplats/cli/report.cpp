// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/report.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "adasplats/core/memory.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/provenance/machine.h"
#include "adasplats/jobs/provenance/provenance.h"

namespace adasplats::app {
namespace {

using Json = nlohmann::ordered_json;

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
  report["provenance"] = to_json(provenance_of(session.executor.threads(), session.device));
  report["parameters"] = parameters_of(command.options().parser());
  report["threads"] = session.executor.threads();
  if (command.device()) report["device"] = device_json(session.device);
  report.update(session.report);
  report["warnings"] = session.bar.warnings();
  report["peak_memory_bytes"] = peak_memory_bytes();
  // Names of files need not be UTF-8; JSON must be.
  write_file(command.common().report,
             report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace adasplats::app
