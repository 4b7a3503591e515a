// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/jobs/compare/compare.h"
#include "adasplats/jobs/compare/steps.h"

namespace adasplats {

/// One way to make a model of the scene.
struct Competitor {
  std::string name;
  std::string title;
  bool is_mesh = false;
  bool needs_labels = false;
  bool segments = false;               ///< classes from a network instead of labels
  std::vector<std::string> arguments;  ///< of `model` or `mesh`; empty for an existing mesh
  std::filesystem::path file;          ///< of an existing mesh
};

/// What all competitors share.
struct CompetitionRules {
  const CompareJob& job;
  ComparisonData data;
  std::filesystem::path original;  ///< the measured points
  bool has_classes = false;        ///< the points have labels
  bool labelled = false;
  DynamicRemoval removal = DynamicRemoval::none;  ///< none if nothing would be removed
  /// For a competitor that segments: its network does not distinguish moving from movable objects.
  DynamicRemoval network_removal = DynamicRemoval::none;
  Vec3d offset_m;
  std::size_t every = 1;
  Vec3d eye, target;               ///< of the pictures' camera
  std::filesystem::path pictures;  ///< folder
  std::string device;              ///< for steps that can use the CPU or a GPU
};

/// Every method of this program, in the order of the tables.
const std::vector<Competitor>& known_competitors();

/// The competitors of these names (empty: all), each once, followed by the existing meshes. Errors:
/// usage (an unknown name, a mesh with a name that is taken).
std::vector<Competitor> chosen_competitors(
    const std::vector<std::string>& names,
    const std::vector<std::pair<std::string, std::filesystem::path>>& meshes);

/// Generates, renders, simulates and measures: an entry of compare.json's "competitors".
nlohmann::ordered_json compete(const Competitor& competitor, const CompetitionRules& rules,
                               const StepRunner& runner);

/// A picture of the measured points from the same camera: {"picture": FILE}, or the keys of a
/// failed competitor.
nlohmann::ordered_json original_picture(const CompetitionRules& rules, const StepRunner& runner);

}  // namespace adasplats
