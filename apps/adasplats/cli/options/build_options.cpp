// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/build_options.h"

#include "cli/options/option_types.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

void add_scales(OptionSet& app, BuildOptions& options) {
  constexpr const char* kGroup = "Scales of neighbours K, radius R and error bound E by group";
  for (int i = 0; i < kSemanticGroups; ++i) {
    const std::string name(name_of(static_cast<SemanticGroup>(i)));
    std::string flag = "--" + name + "-scale";
    std::replace(flag.begin(), flag.end(), '_', '-');
    add_scale(app, flag, options.semantic_scales[static_cast<std::size_t>(i)],
              "Of the group " + name)
        ->group(kGroup);
  }
  add_scale(app, "--planar-scale", options.planar_scale,
            "Of planar points in the method descriptors")
      ->group(kGroup);
  add_switch(app, "--group-normals,!--base-normals", options.group_normals,
             "Normals from the group's own neighbourhood, or from the base one")
      ->group(kGroup);
}

void add_cleaning(OptionSet& app, BuildOptions& options) {
  constexpr const char* kGroup = "Denoising and resampling";
  add_switch(app, "--denoise,!--no-denoise", options.denoise, "Remove noise")->group(kGroup);
  app.add_option("--denoise-sigmas", options.denoise_sigmas,
                 "A neighbourhood votes against points farther than this from its plane")
      ->capture_default_str()
      ->group(kGroup);
  app.add_option("--denoise-votes", options.denoise_votes,
                 "Share of its neighbourhoods that removes a point")
      ->capture_default_str()
      ->group(kGroup);
  add_switch(app, "--resample,!--no-resample", options.resample,
             "Fill in points on splats and generate again")
      ->group(kGroup);
  app.add_option("--resample-density", options.resample_density,
                 "Wanted density of splats, times its mean; none are added where two thirds of "
                 "it are there")
      ->capture_default_str()
      ->group(kGroup);
  add_choice<BuildOptions::ResampleBase>(
      app, "--resample-base", options.resample_base,
      {{"points", BuildOptions::ResampleBase::points},
       {"centers", BuildOptions::ResampleBase::centers},
       {"mixed", BuildOptions::ResampleBase::mixed}},
      "What the second generation starts from, with the new points")
      ->group(kGroup);
}

void add_consistent(OptionSet& app, ConsistentOptions& options) {
  constexpr const char* kGroup = "Method consistent";
  const auto number = [&app](const char* flag, auto& value, const char* help) {
    app.add_option(flag, value, help)->capture_default_str()->group(kGroup);
  };
  number("--cell", options.cell_m, "Side of the cells that points are fused in, m");
  number("--small-cell", options.small_cell_m,
         "Side of cells where the surface is not flat, m; 0: as elsewhere");
  number("--largest-radius", options.cover.largest_radius_m,
         "Of a splat, m; 0: splats do not grow over their neighbours");
  number("--balance-rounds", options.balance_rounds,
         "Of judging small disks by the measured rays; 0: no ray check");
  number("--strict-rounds", options.strict_rounds, "Of limiting grown splats that rays go through");
  number("--settle-rounds", options.settle_rounds, "Of moving splats to where rays end");
  add_switch(app, "--fill,!--no-fill", options.fill,
             "Put small splats where measured rays fall through")
      ->group(kGroup);
}

}  // namespace

const std::vector<std::pair<std::string, SplatMethod>>& method_names() {
  static const std::vector<std::pair<std::string, SplatMethod>> names = {
      {"consistent", SplatMethod::consistent},
      {"basic", SplatMethod::basic},
      {"descriptors", SplatMethod::descriptors},
      {"semantic", SplatMethod::semantic}};
  return names;
}

std::string text_of(const std::vector<RemovedPoints::OfClass>& removed) {
  std::string text;
  for (const auto& part : removed) {
    text += (text.empty() ? " (" : ", ") + part.name + " " + grouped(part.points);
  }
  return text.empty() ? text : text + ")";
}

void add_removal_option(OptionSet& app, DynamicRemoval& removal) {
  add_choice<DynamicRemoval>(app, "--remove", removal,
                             {{"none", DynamicRemoval::none},
                              {"moving", DynamicRemoval::moving},
                              {"movable", DynamicRemoval::movable}},
                             "Objects to leave out by their labels; movable: parked cars too");
}

void add_build_options(OptionSet& app, BuildOptions& options) {
  add_choice<SplatMethod>(
      app, "--method", options.method, method_names(),
      "consistent agrees with the measured rays; the others are the paper's variants, of "
      "which semantic needs labels");
  app.add_option("--neighbors", options.neighbors, "K, neighbours of a point")
      ->capture_default_str();
  app.add_option("--alpha", options.alpha,
                 "Share of a splat's radius within which other seeds are discarded")
      ->capture_default_str();
  app.add_option("--smoothness", options.smoothness, "Least dot product of normals in a splat")
      ->capture_default_str();
  app.add_option("--radius", options.radius_m,
                 "R, m; without it the mean distance to the K-th neighbour");
  app.add_option("--error-bound", options.error_m,
                 "E, m; without it the mean distance of neighbours from their plane");
  add_choice<SelectionOrder>(app, "--selection", options.selection,
                             {{"most-discards-first", SelectionOrder::most_discards_first},
                              {"largest-first", SelectionOrder::largest_first},
                              {"curve", SelectionOrder::curve},
                              {"scattered", SelectionOrder::scattered}},
                             "Order in which candidate splats are taken");
  add_removal_option(app, options.remove);
  add_consistent(app, options.consistent);
  add_cleaning(app, options);
  add_scales(app, options);
}

}  // namespace adasplats::app
