// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/unused_settings.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

using List = std::vector<UnusedSetting>;

/// Those of these names.
template <class Settings>
void add(const Settings& settings, std::initializer_list<std::string_view> names,
         const std::string& why, List& list) {
  for (const UnusedSetting& unused : all_unused(settings, why)) {
    if (std::find(names.begin(), names.end(), unused.setting.name) != names.end())
      list.push_back(unused);
  }
}

/// Of a method's own settings; most have none.
template <class Options>
void add_own(const Options& /*own*/, List& /*unused*/) {}

void add_own(const ConsistentOptions& consistent, List& unused) {
  if (consistent.balance_rounds > 0) return;
  add(consistent, {"strict_rounds", "settle_rounds", "fill", "refine"},
      "without balance rounds, where no ray is looked at", unused);
}

void add_own(const PaperOptions& paper, List& unused) {
  if (!paper.denoise) add(paper, {"denoise_sigmas", "denoise_votes"}, "without denoising", unused);
  if (!paper.resample)
    add(paper, {"resample_density", "resample_base"}, "without resampling", unused);
  switch (paper.variant) {
    case PaperVariant::basic:
      add(paper,
          {"smoothness", "resample", "resample_density", "resample_base", "ground_scale",
           "surface_scale", "linear_scale", "non_surface_scale", "planar_scale", "group_normals"},
          "with the method basic", unused);
      break;
    case PaperVariant::descriptors:
      add(paper, {"ground_scale", "surface_scale"},
          "with the method descriptors, which knows planar points alone (planar_scale)", unused);
      break;
    case PaperVariant::semantic:
      add(paper, {"planar_scale"}, "with the method semantic; it is for the method descriptors",
          unused);
      break;
  }
}

}  // namespace

List unused_settings(const MethodChoice& choice) {
  const MethodOptions recipe = choice.recipe();
  std::string chosen;
  visit_methods(choice, [&]<class Options>(const Options&, const char* method) {
    if (std::holds_alternative<Options>(recipe)) chosen = method;
  });
  List unused;
  visit_methods(choice, [&]<class Options>(const Options& options, const char* method) {
    if (const auto* held = std::get_if<Options>(&recipe)) {
      add_own(*held, unused);
    } else {
      const List others = all_unused(options, "with " + chosen + "; it is for " + method);
      unused.insert(unused.end(), others.begin(), others.end());
    }
  });
  return unused;
}

void check_label_use(const LabelUse& use, const PointCloud& cloud, const LabelScheme* scheme,
                     ProgressSink& progress) {
  if (cloud.classes.empty() && !use.labels.empty()) {
    throw Error(ErrorKind::usage, "`labels` " + use.labels +
                                      ": the points have no labels; leave it out (`label_field` "
                                      "names their column)");
  }
  const std::string why = removal_problem(cloud, scheme, use.removal);
  if (why.empty()) return;
  if (use.removal_is_asked) {
    throw Error(ErrorKind::usage, "`remove` " + std::string(name_of(use.removal)) + ": " + why);
  }
  const bool removes_noise = scheme != nullptr && has_noise(*scheme);
  if (!cloud.classes.empty() && !removes_noise) progress.warn(why + "; nothing is removed");
}

}  // namespace adasplats
