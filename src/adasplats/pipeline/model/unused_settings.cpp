// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/model/unused_settings.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <type_traits>

namespace adasplats {
namespace {

/// What is turned off and would not have been done anyway is as wished.
template <class Value>
bool asks_for_something(const Value& value) {
  if constexpr (std::is_same_v<Value, bool>) return value;
  return true;
}

class Unused {
 public:
  /// All settings of another method.
  template <class Settings>
  void add_all(const Settings& settings, const std::string& why) {
    Settings copy = settings;
    visit_settings(copy, [&](const Setting& setting, const auto& value) {
      if (asks_for_something(value)) list.push_back({setting, why});
    });
  }

  /// Those of these names.
  template <class Settings>
  void add(const Settings& settings, std::initializer_list<std::string_view> names,
           const std::string& why) {
    Settings copy = settings;
    visit_settings(copy, [&](const Setting& setting, const auto& value) {
      const bool named = std::find(names.begin(), names.end(), setting.name) != names.end();
      if (named && asks_for_something(value)) list.push_back({setting, why});
    });
  }

  std::vector<UnusedSetting> list;
};

void add_consistent(const ConsistentOptions& consistent, Unused& unused) {
  if (consistent.balance_rounds > 0) return;
  unused.add(consistent, {"strict_rounds", "settle_rounds", "fill"},
             "without balance rounds, where no ray is looked at");
}

void add_paper(const PaperOptions& paper, PaperVariant variant, Unused& unused) {
  if (!paper.denoise) unused.add(paper, {"denoise_sigmas", "denoise_votes"}, "without denoising");
  if (!paper.resample)
    unused.add(paper, {"resample_density", "resample_base"}, "without resampling");
  switch (variant) {
    case PaperVariant::basic:
      return unused.add(
          paper,
          {"smoothness", "resample", "resample_density", "resample_base", "ground_scale",
           "surface_scale", "linear_scale", "non_surface_scale", "planar_scale", "group_normals"},
          "with the method basic");
    case PaperVariant::descriptors:
      return unused.add(paper, {"ground_scale", "surface_scale"},
                        "with the method descriptors, which knows planar points alone "
                        "(planar_scale)");
    case PaperVariant::semantic:
      return unused.add(paper, {"planar_scale"},
                        "with the method semantic; it is for the method descriptors");
  }
}

}  // namespace

std::vector<UnusedSetting> unused_settings(const RecipeChoice& choice) {
  Unused unused;
  const ModelRecipe recipe = choice.recipe();
  if (const auto* consistent = std::get_if<ConsistentOptions>(&recipe)) {
    unused.add_all(choice.paper, "with the method consistent; it is for the paper's methods");
    add_consistent(*consistent, unused);
  } else if (const auto* paper = std::get_if<PaperOptions>(&recipe)) {
    unused.add_all(choice.consistent, "with the paper's methods; it is for the method consistent");
    add_paper(*paper, paper->variant, unused);
  }
  return unused.list;
}

}  // namespace adasplats
