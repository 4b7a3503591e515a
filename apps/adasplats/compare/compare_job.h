// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/maths/vec3.h"
#include "cli/session.h"
#include "compare/comparison_data.h"
#include "compare/steps.h"

namespace adasplats::app {

/// Every competitor on the same points with the same rays. What is empty is found in the data.
struct CompareJob {
  std::filesystem::path data;
  std::filesystem::path output;
  Preset preset = Preset::none;
  std::vector<std::string> methods;  ///< empty: all that the data allow
  std::vector<std::pair<std::string, std::filesystem::path>> meshes;  ///< name and file, ready-made
  std::string labels, scans, held_out_scans, sensor = "hdl-64-paper";
  std::optional<DynamicRemoval> remove;  ///< else what the paper removes: removal_of()
  std::filesystem::path trajectory, held_out, truth;
  std::optional<Vec3d> offset_m;
  std::size_t every = 0;  ///< 0: at most 20 poses
  int poisson_depth = 13;
  int picture_width = 960;  ///< pixels; the height is 9/16 of it
  StepRules steps;
  std::vector<std::string> device_arguments;  ///< --device, where it is given
};

/// What the paper removes from the data of a preset, with whatever scheme they are labelled: all
/// that is movable (section "Adaptive Splatting" and both "Results"), from every input. M-City has
/// no dynamic objects. Without a preset as with PC3D-Paris: the methods are the paper's.
DynamicRemoval paper_removal(Preset preset);

/// The words of --methods.
std::vector<std::string> compare_method_names();

/// Runs what is not done yet, writes compare.json, report.md and report.html into the output
/// folder and gives back what compare.json holds (its layout: docs/formats.md). A competitor that
/// fails is a row that says so. Errors: those of finding the data; usage for what no competitor
/// could work with (limits, sensor, labels, names); cannot_create where the folder holds something
/// else or another run works in it.
nlohmann::ordered_json run_compare(const CompareJob& job, Session& session);

}  // namespace adasplats::app
