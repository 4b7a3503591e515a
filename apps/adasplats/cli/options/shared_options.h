// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/jobs/session/device_choice.h"
#include "adasplats/splats/build_model.h"
#include "cli/options/option_set.h"

// Options that several subcommands share.

namespace adasplats::app {

/// Options of every subcommand.
struct CommonOptions {
  int threads = 0;
  std::uint64_t seed = 1;
  std::filesystem::path report;
  std::filesystem::path config;
};
void add_common_options(OptionSet& app, CommonOptions& options);

/// How many GPUs a subcommand can use.
enum class GpuCount : std::uint8_t { one, several };
/// Adds --device, and --gpus if several can be used.
void add_device_options(OptionSet& app, DeviceOptions& options, GpuCount count);

/// Adds --labels; `default_scheme` is a text for help.
Option* add_labels_option(OptionSet& app, std::string& labels, const std::string& default_scheme);
/// Adds --sensor for a LiDAR: a name or a file, as of load_lidar_model().
Option* add_sensor_option(OptionSet& app, std::string& sensor);
/// Adds the options of LoadOptions.
void add_load_options(OptionSet& app, LoadOptions& options);
/// The first of the options of LoadOptions that is given; empty: none.
std::string given_load_option(const OptionSet& app);
/// The same as the name of a setting.
std::string given_load_setting(const OptionSet& app);

/// Adds --remove.
void add_removal_option(OptionSet& app, DynamicRemoval& removal);
/// " (CLASS POINTS, ...)" for what --remove removed; empty: nothing.
std::string text_of(const std::vector<RemovedPoints::OfClass>& removed);

}  // namespace adasplats::app
