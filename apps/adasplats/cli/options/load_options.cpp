// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/load_options.h"

#include "cli/options/option_types.h"

namespace adasplats::app {
namespace {

constexpr const char* kInputGroup = "Input";

/// What of the points is dropped, and when that is an error.
void add_refusals(OptionSet& app, LoadOptions& options) {
  app.add_option("--max-distance", options.max_distance_m,
                 "Points farther than this from the median of all are dropped, m")
      ->capture_default_str()
      ->group(kInputGroup);
  app.add_option("--max-dropped", options.max_dropped,
                 "Share of the points that may be dropped as far or not finite before it is an "
                 "error")
      ->capture_default_str()
      ->type_name("SHARE")
      ->group(kInputGroup);
  app.add_option(
         "--own-body", options.own_body_m,
         "Points nearer than this to their sensor are the recording vehicle itself and left "
         "out, m; 0 keeps all (default: those that go along with the sensor)")
      ->type_name("M")
      ->group(kInputGroup);
  app.add_flag("--trust-origins", options.trust_origins,
               "Take sensor positions though points lie behind others as seen from there, as later "
               "returns do")
      ->group(kInputGroup);
  app.add_flag("--strict", options.strict, "Points that are not finite are an error")
      ->group(kInputGroup);
  app.add_flag("--salvage", options.salvage, "Read the whole records of truncated LAS files")
      ->group(kInputGroup);
}

}  // namespace

void add_load_options(OptionSet& app, LoadOptions& options) {
  app.add_option("--label-field", options.label_field, "Column of the semantic class")
      ->type_name("NAME")
      ->group(kInputGroup);
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
  add_vector(app, "--viewpoint", options.viewpoint,
             "The station that measured all points that have no sensor position, world coordinates")
      ->group(kInputGroup);
  add_path(app, "--trajectory", options.trajectory,
           "Poses: the nearest one turns the normals of points that have no sensor position; a "
           "guess, nothing is checked with it")
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
  app.add_flag("--beams-from-poses", options.beams_from_poses,
               "Beams of sequences start at their poses, even where the sensor is recognised")
      ->group(kInputGroup);
  add_refusals(app, options);
}

std::string given_load_option(const OptionSet& app) { return app.first_given(kInputGroup); }

}  // namespace adasplats::app
