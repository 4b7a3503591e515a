// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/shared_options.h"

#include <algorithm>
#include <charconv>

#include "cli/command_entry.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

Choices<DeviceKind> choices_of_devices() {
  Choices<DeviceKind> choices;
  for (const auto& [word, kind] : device_words()) choices.emplace_back(word, kind);
  return choices;
}

/// "0,2": different numbers, not negative.
std::vector<int> parse_gpus(const std::string& text) {
  std::vector<int> gpus;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    int gpu = 0;
    const auto [stop, failure] = std::from_chars(at, end, gpu);
    if (failure != std::errc() || gpu < 0 || (stop != end && *stop != ','))
      reject_value("--gpus", "expected numbers of GPUs with commas between them, or all, found '" +
                                 text + "'");
    if (std::find(gpus.begin(), gpus.end(), gpu) != gpus.end())
      reject_value("--gpus", "expected every GPU once, found '" + text + "'");
    gpus.push_back(gpu);
    if (stop == end) return gpus;
    at = stop + 1;
  }
}

}  // namespace

void add_common_options(OptionSet& app, CommonOptions& options) {
  constexpr int kMaxThreads = 4096;
  app.add_version_flag("--version", std::string("adasplats ") + ADASPLATS_VERSION,
                       "Print the version and exit")
      ->group(kCommonHeading);
  app.add_option("--threads", options.threads, "Number of threads; 0: all available ones")
      ->range(0, kMaxThreads)
      ->capture_default_str()
      ->type_name("N")
      ->group(kCommonHeading)
      ->basic();
  app.add_option("--seed", options.seed, "Seed of all random numbers")
      ->capture_default_str()
      ->type_name("N")
      ->group(kCommonHeading);
  add_path(app, "--report", options.report, "Write parameters, counts and timings as JSON")
      ->group(kCommonHeading)
      ->basic();
  add_path(app, "--config", options.config,
           "TOML file with options: keys are long option names without dashes, at the top or in a "
           "table named after the subcommand; the command line overrides it")
      ->group(kCommonHeading);
}

void add_device_options(OptionSet& app, DeviceOptions& options, GpuCount count) {
  constexpr const char* kGroup = "Device options";
  add_choice<DeviceKind>(app, "--device", options.kind, choices_of_devices(),
                         "Where to compute; auto: on an NVIDIA GPU with cuda, else on the CPU")
      ->group(kGroup)
      ->basic();
  const Setting limit = {.name = "gpu_memory",
                         .help =
                             "Memory limit of each GPU, GB or with a unit (8G, 500M), besides "
                             "half a gigabyte for CUDA (default: all that is free)",
                         .value = "GB",
                         .min = 0.1,
                         .max = 1e6};
  add_memory(app, limit, options.memory_gb)->group(kGroup);
  if (count == GpuCount::one) return;
  app.add_option_function<std::string>(
         "--gpus",
         [&options](const std::string& text) {
           options.all_gpus = text == "all";
           options.gpus = options.all_gpus ? std::vector<int>() : parse_gpus(text);
         },
         "GPUs that share the work, by their numbers in info --devices (0,1), or all (default: the "
         "first)")
      ->type_name("LIST|all")
      ->group(kGroup);
}

Option* add_labels_option(OptionSet& app, std::string& labels, const std::string& default_scheme) {
  return app
      .add_option("--labels", labels,
                  "Label scheme: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a "
                  "TOML file (default: " +
                      default_scheme + ")")
      ->type_name("SCHEME")
      ->basic();
}

Option* add_sensor_option(OptionSet& app, std::string& sensor) {
  return app.add_option("--sensor", sensor, "Sensor: a name from 'adasplats sensors', or a file")
      ->capture_default_str()
      ->type_name("NAME|FILE");
}

void add_load_options(OptionSet& app, LoadOptions& options) {
  add_settings(app, options);
  const auto set_sensor_fields = [&options](const std::string& text) {
    const std::size_t first = text.find(',');
    const std::size_t second = text.find(',', first + 1);
    if (first == std::string::npos || second == std::string::npos ||
        text.find(',', second + 1) != std::string::npos) {
      reject_value("--sensor-fields", "expected three names of columns, found '" + text + "'");
    }
    options.sensor_x_field = text.substr(0, first);
    options.sensor_y_field = text.substr(first + 1, second - first - 1);
    options.sensor_z_field = text.substr(second + 1);
  };
  app.add_option_function<std::string>("--sensor-fields", set_sensor_fields,
                                       "Columns with the sensor position of every point")
      ->type_name("X,Y,Z")
      ->group(kInputHeading);
  const auto set_scans = [&options](const std::string& text) {
    const ScanRange range = parse_scan_range("--scans", text);
    options.first_scan = range.first;
    options.scan_count = range.count;
    options.scan_stride = range.stride;
  };
  app.add_option_function<std::string>("--scans", set_scans, "Scans of a sequence to load")
      ->type_name("FIRST:COUNT[:STRIDE]")
      ->group(kInputHeading);
}

std::string given_load_option(const OptionSet& app) { return app.first_given(kInputHeading); }

std::string given_load_setting(const OptionSet& app) {
  std::string name = given_load_option(app);
  if (!name.empty()) name.erase(0, 2);
  std::ranges::replace(name, '-', '_');
  return name;
}

void add_removal_option(OptionSet& app, DynamicRemoval& removal) {
  add_choice<DynamicRemoval>(app, "--remove", removal, choices_of<DynamicRemoval>(kDynamicRemovals),
                             "Remove objects by their labels; movable includes parked cars")
      ->basic();
}

std::string text_of(const std::vector<RemovedPoints::OfClass>& removed) {
  std::string text;
  for (const auto& part : removed) {
    text += (text.empty() ? " (" : ", ") + part.name + " " + grouped(part.points);
  }
  return text.empty() ? text : text + ")";
}

}  // namespace adasplats::app
