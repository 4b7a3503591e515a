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

/// One way to a model of the scene.
struct Competitor {
  std::string name;
  std::string title;
  bool is_mesh = false;
  bool needs_labels = false;
  bool segments = false;               ///< its classes are a network's, not the data's labels
  std::vector<std::string> arguments;  ///< of `model` or `mesh`; empty for a ready-made mesh
  std::filesystem::path file;          ///< of a ready-made mesh
};

/// Camera of the pictures.
struct PictureView {
  Vec3d eye;
  Vec3d target;
};

/// What all competitors are asked with.
struct CompetitionRules {
  const CompareJob& job;
  ComparisonData data;
  std::filesystem::path original;  ///< the measured points
  bool has_classes = false;        ///< the points have labels
  bool labelled = false;
  DynamicRemoval removal = DynamicRemoval::none;  ///< that removes something, or none
  /// Of a competitor that segments, whose network tells nothing that moves from what could.
  DynamicRemoval network_removal = DynamicRemoval::none;
  Vec3d offset_m;
  std::size_t every = 1;
  PictureView view;
  std::filesystem::path pictures;  ///< folder
  std::string device;              ///< what steps compute on that have a choice
};

/// Every method that this program has, in the order of the tables.
const std::vector<Competitor>& known_competitors();

/// Those of the names (empty: all known ones), each once, and the ready-made meshes behind them.
/// Errors: usage for a name that is not known and for a mesh whose name others have.
std::vector<Competitor> chosen_competitors(
    const std::vector<std::string>& names,
    const std::vector<std::pair<std::string, std::filesystem::path>>& meshes);

/// Generates, renders, simulates and measures: an entry of compare.json's "competitors".
nlohmann::ordered_json compete(const Competitor& competitor, const CompetitionRules& rules,
                               const StepRunner& runner);

/// A picture of the measured points from the same camera: {"picture": FILE}, or what a competitor
/// that failed says.
nlohmann::ordered_json original_picture(const CompetitionRules& rules, const StepRunner& runner);

}  // namespace adasplats
