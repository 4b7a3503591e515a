// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/vec3.h"
#include "adasplats/pipeline/scan_range.h"
#include "adasplats/splats/build_model.h"

namespace adasplats::app {

/// "FIRST:COUNT[:STRIDE]", the value of `option`. Errors: CLI::ValidationError.
ScanRange parse_scan_range(const std::string& option, const std::string& text);

CLI::Option* add_path(CLI::App& app, const std::string& name, std::filesystem::path& target,
                      const std::string& help);
CLI::Option* add_vector(CLI::App& app, const std::string& name, std::optional<Vec3d>& target,
                        const std::string& help);
CLI::Option* add_scale(CLI::App& app, const std::string& name, GroupScale& target,
                       const std::string& help);
/// --picture-width, pixels of a picture of 16:9.
CLI::Option* add_picture_width(CLI::App& app, int& width);
/// A flag with its opposite: names as "--denoise,!--no-denoise".
CLI::Option* add_switch(CLI::App& app, const std::string& names, bool& target,
                        const std::string& help);

/// "what 'x' is not known, did you mean 'y'?" or a list of all that are known.
std::string unknown_word(const std::string& what, const std::string& word,
                         const std::vector<std::string>& known);

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

/// One of a few words.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& target, Choices<T> choices,
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
    throw CLI::ValidationError(name, unknown_word("value", given, words));
  };
  return app.add_option_function<std::string>(name, choose, help)
      ->type_name(joined)
      ->default_str(chosen);
}

}  // namespace adasplats::app
