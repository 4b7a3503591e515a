// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/setting.h"
#include "adasplats/splats/paper/select.h"

namespace adasplats {

/// What adapts splats to the kind of surface.
enum class PaperVariant : std::uint8_t {
  basic,        ///< nothing: section "Basic Splatting"
  descriptors,  ///< local descriptors: "Adaptive Splatting Using Local Descriptors"
  semantic,     ///< classes: "Adaptive Splatting"
};

/// Factors on K, R and E for one group of points.
struct GroupScale {
  double neighbors = 1;  ///< times K
  double radius = 1;     ///< times R
  double error = 1;      ///< times E

  std::array<double, 3> factors() const { return {neighbors, radius, error}; }
};

/// Input of the second generation, in addition to the new points. The paper's text describes the
/// points, its figures (fewer points and splats than before) indicate the splats' centers.
enum class ResampleBase : std::uint8_t {
  points,   ///< all points
  centers,  ///< centers of all splats
  mixed,    ///< centers on ground and surface, points of thin things (linear, non-surface)
};
inline constexpr std::pair<std::string_view, ResampleBase> kResampleBases[] = {
    {"points", ResampleBase::points},
    {"centers", ResampleBase::centers},
    {"mixed", ResampleBase::mixed}};
inline Words<ResampleBase> words_of(ResampleBase) { return kResampleBases; }

/// The paper's method (sections "Basic Splatting" to "Splat-Based Resampling and Denoising").
struct PaperOptions {
  PaperVariant variant = PaperVariant::basic;

  int neighbors = 40;       ///< K, section "Basic Splatting"
  double alpha = 0.2;       ///< share of a splat's radius within which seeds are discarded
  double smoothness = 0.6;  ///< beta: minimum dot product of normals, section "Adaptive Splatting"
  std::optional<double> radius_m;  ///< R instead of the mean distance to the K-th neighbour
  std::optional<double> error_m;   ///< E instead of the mean point-to-plane distance
  /// The order of the greedy selection.
  SelectionOrder selection = SelectionOrder::most_discards_first;

  bool denoise = true;         ///< section "Splat-Based Resampling and Denoising"
  double denoise_sigmas = 3;   ///< a neighbourhood votes against points farther than this
  double denoise_votes = 0.5;  ///< share of its neighbourhoods that removes a point
  bool resample = true;        ///< second generation; adaptive variants only, as in the paper
  /// Target density of splats, times its mean. A neighbourhood below it makes as many new points as
  /// it lacks, rounded for each splat: none if it has more than two thirds.
  double resample_density = 1;
  ResampleBase resample_base = ResampleBase::mixed;

  /// Section "Adaptive Splatting": ground, surface, linear, non-surface.
  std::array<GroupScale, kSemanticGroups> semantic_scales = {
      {{3, 3, 3}, {1, 1, 1}, {0.33, 0.33, 0.33}, {0.25, 0.25, 0.25}}};
  /// Section "Local Descriptors": planar points (ground and surface) have 2; others as above.
  GroupScale planar_scale = {2, 2, 2};
  /// Normals from the group's own neighbourhood (else from the base neighbourhood).
  bool group_normals = true;
};

template <class Visit>
void visit_cleaning_settings(PaperOptions& paper, Visit&& visit) {
  constexpr const char* kCleaning = "Denoising and resampling";
  visit(Setting{.name = "denoise", .help = "Remove noisy points", .group = kCleaning},
        paper.denoise);
  visit(Setting{.name = "denoise_sigmas",
                .help = "Distance from its plane beyond which a neighbourhood votes against a "
                        "point, standard deviations",
                .group = kCleaning,
                .min = 0,
                .exclusive_min = true},
        paper.denoise_sigmas);
  visit(Setting{.name = "denoise_votes",
                .help = "Fraction of a point's neighbourhoods whose votes remove it",
                .group = kCleaning,
                .min = 0,
                .max = 1,
                .exclusive_min = true},
        paper.denoise_votes);
  visit(Setting{.name = "resample",
                .help = "Add points on sparse splats and generate all splats again",
                .group = kCleaning},
        paper.resample);
  visit(Setting{.name = "resample_density",
                .help = "Target density of splats relative to their mean; nothing is added above "
                        "two thirds of it",
                .group = kCleaning,
                .min = 0,
                .max = 100},
        paper.resample_density);
  visit(
      Setting{.name = "resample_base",
              .help = "Points that the second generation starts from, in addition to the new ones",
              .group = kCleaning},
      paper.resample_base);
}

template <class Visit>
void visit_scale_settings(PaperOptions& paper, Visit&& visit) {
  constexpr const char* kScales = "Factors of neighbours K, radius R and error bound E by group";
  const auto scale = [&](const char* name, const char* help, GroupScale& value) {
    visit(Setting{.name = name, .help = help, .group = kScales, .min = 0}, value);
  };
  scale("ground_scale", "Factors of K, R and E for the group ground", paper.semantic_scales[0]);
  scale("surface_scale", "Factors of K, R and E for the group surface", paper.semantic_scales[1]);
  scale("linear_scale", "Factors of K, R and E for the group linear", paper.semantic_scales[2]);
  scale("non_surface_scale", "Factors of K, R and E for the group non-surface",
        paper.semantic_scales[3]);
  scale("planar_scale", "Factors of K, R and E for planar points (method descriptors)",
        paper.planar_scale);
  visit(Setting{.name = "group_normals",
                .help = "Compute normals from the group's own neighbourhood (--base-normals: from "
                        "the base one)",
                .opposite = "base-normals",
                .group = kScales},
        paper.group_normals);
}

template <class Visit>
void visit_settings(PaperOptions& paper, Visit&& visit) {
  constexpr const char* kGroup = "The paper's methods";
  visit(Setting{.name = "neighbors",
                .help = "Number of neighbours of a point, K",
                .group = kGroup,
                .min = 3,
                .max = 1e5},
        paper.neighbors);
  visit(Setting{.name = "alpha",
                .help = "Fraction of a splat's radius within which other seeds are discarded",
                .group = kGroup,
                .min = 0,
                .max = 1},
        paper.alpha);
  visit(Setting{.name = "smoothness",
                .help = "Minimum dot product of normals within a splat",
                .group = kGroup,
                .min = -1,
                .max = 1},
        paper.smoothness);
  visit(Setting{.name = "radius",
                .help =
                    "Neighbourhood radius R, m (default: the mean distance to the K-th neighbour)",
                .key = "radius_m",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        paper.radius_m);
  visit(Setting{.name = "error_bound",
                .help =
                    "Error bound E, m (default: the mean distance of neighbours from their plane)",
                .key = "error_m",
                .group = kGroup,
                .min = 0},
        paper.error_m);
  visit(Setting{.name = "selection",
                .help = "Order in which candidate splats are selected",
                .group = kGroup},
        paper.selection);
  visit_cleaning_settings(paper, visit);
  visit_scale_settings(paper, visit);
}

/// Errors: usage (a setting out of range).
void check(const PaperOptions& paper);

}  // namespace adasplats
