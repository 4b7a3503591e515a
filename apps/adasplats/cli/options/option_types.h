// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/extent.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/core/words.h"
#include "adasplats/jobs/scene/placed_poses.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/splats/build_model.h"
#include "cli/options/option_set.h"

namespace adasplats::app {

/// Parses "FIRST:COUNT[:STRIDE]", the value of `option`. Errors: reject_value().
ScanRange parse_scan_range(const std::string& option, const std::string& text);

Option* add_scan_range(OptionSet& app, const std::string& name, ScanRange& target,
                       const std::string& help);
Option* add_path(OptionSet& app, const std::string& name, std::filesystem::path& target,
                 const std::string& help);
/// Several paths after one another.
Option* add_paths(OptionSet& app, const std::string& name,
                  std::vector<std::filesystem::path>& target, const std::string& help);
Option* add_vector(OptionSet& app, const std::string& name, std::optional<Vec3d>& target,
                   const std::string& help);
Option* add_vector(OptionSet& app, const std::string& name, Vec3d& target, const std::string& help);
/// "XMIN,YMIN,XMAX,YMAX[,ZMIN,ZMAX]".
Option* add_extent(OptionSet& app, const std::string& name, std::optional<Extent>& target,
                   const std::string& help);
/// Positions "X,Y[,Z[,YAW_DEG]]", Z may be empty; may be given several times.
Option* add_places(OptionSet& app, const std::string& name, std::vector<SensorPlace>& target,
                   const std::string& help);
/// Corners "X,Y;X,Y;...".
Option* add_corners(OptionSet& app, const std::string& name, std::vector<PathCorner>& target,
                    const std::string& help);
Option* add_scale(OptionSet& app, const std::string& name, GroupScale& target,
                  const std::string& help);
/// A length in metres, or with its unit: "500", "500m", "10km".
Option* add_length(OptionSet& app, const Setting& setting, double& target);
/// Memory in GB (10^9 bytes), or with its unit: "8", "8G", "8GB", "500M", "500MB".
Option* add_memory(OptionSet& app, const Setting& setting, double& target);
/// --picture-width, pixels of a 16:9 picture.
Option* add_picture_width(OptionSet& app, int& width);
/// A flag with its opposite: names as "--denoise,!--no-denoise".
Option* add_switch(OptionSet& app, const std::string& names, bool& target, const std::string& help);

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

template <class T>
Choices<T> choices_of(std::type_identity_t<Words<T>> words) {
  return {words.begin(), words.end()};
}

/// For a choice without a default.
template <class T, std::size_t N>
Choices<std::optional<T>> choices_of_optional(const std::pair<std::string_view, T> (&words)[N]) {
  return {std::begin(words), std::end(words)};
}

/// One of a few words.
template <class T>
Option* add_choice(OptionSet& app, const std::string& name, T& target, Choices<T> choices,
                   const std::string& help) {
  std::vector<std::string> words;
  std::string joined;
  std::string chosen;
  for (const auto& [word, value] : choices) {
    words.push_back(word);
    joined += (joined.empty() ? "" : "|") + word;
    if (value == target) chosen = word;
  }
  const auto choose = [&target, name, choices = std::move(choices),
                       words](const std::string& given) {
    for (const auto& [word, value] : choices) {
      if (word == given) {
        target = value;
        return;
      }
    }
    reject_value(name, unknown_word("value", given, words));
  };
  return app.add_option_function<std::string>(name, choose, help)
      ->type_name(joined)
      ->default_str(chosen);
}

}  // namespace adasplats::app
