// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/load_options.h"

#include <algorithm>

#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"

namespace adasplats::app {
namespace {

constexpr const char* kInputGroup = "Input";

}  // namespace

void add_load_options(OptionSet& app, LoadOptions& options) {
  add_settings(app, options);
  const auto set_sensor_fields = [&options](const std::string& text) {
    const std::size_t first = text.find(',');
    const std::size_t second = text.find(',', first + 1);
    if (first == std::string::npos || second == std::string::npos ||
        text.find(',', second + 1) != std::string::npos) {
      refuse_value("--sensor-fields", "expected three names of columns, found '" + text + "'");
    }
    options.sensor_x_field = text.substr(0, first);
    options.sensor_y_field = text.substr(first + 1, second - first - 1);
    options.sensor_z_field = text.substr(second + 1);
  };
  app.add_option_function<std::string>("--sensor-fields", set_sensor_fields,
                                       "Columns of the sensor's position")
      ->type_name("X,Y,Z")
      ->group(kInputGroup);
  const auto set_scans = [&options](const std::string& text) {
    const ScanRange range = parse_scan_range("--scans", text);
    options.first_scan = range.first;
    options.scan_count = range.count;
    options.scan_stride = range.stride;
  };
  app.add_option_function<std::string>("--scans", set_scans, "Which scans of a sequence")
      ->type_name("FIRST:COUNT[:STRIDE]")
      ->group(kInputGroup);
}

std::string given_load_option(const OptionSet& app) { return app.first_given(kInputGroup); }

std::string given_load_setting(const OptionSet& app) {
  std::string name = given_load_option(app);
  if (!name.empty()) name.erase(0, 2);
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace adasplats::app
