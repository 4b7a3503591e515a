// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "adasplats/core/maths/extent.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/splats/paper/paper_options.h"

namespace adasplats::python {

namespace py = pybind11;

/// The keyword arguments of one call. A function takes them one by one by name; one that was not
/// taken is a TypeError that suggests the nearest name. The same code without a call makes the
/// signature, so names and defaults are written once.
class Keywords {
 public:
  /// Of a call.
  Keywords(std::string function, const py::kwargs& given);
  /// Without a call: notes what is taken, with its default.
  Keywords() = default;

  /// Replaces `value` by the argument of that name, if it was given. Errors: TypeError that says
  /// what is expected, ValueError (out of range, an unknown word).
  void take(const char* name, bool& value);
  void take(const char* name, int& value);
  void take(const char* name, std::uint32_t& value);
  void take(const char* name, std::uint64_t& value);
  void take(const char* name, double& value);
  void take(const char* name, float& value);
  void take(const char* name, GroupScale& value);
  void take(const char* name, std::string& value);
  void take(const char* name, std::filesystem::path& value);  ///< None: no path
  void take(const char* name, Vec3d& value);
  void take(const char* name, std::optional<double>& value);
  void take(const char* name, std::optional<Vec3d>& value);
  void take(const char* name, std::optional<std::uint32_t>& value);
  void take(const char* name, std::optional<Extent>& value);  ///< four or six numbers
  void take(const char* name, std::vector<int>& value);       ///< None: none
  void take(const char* name, py::object& value);

  template <class T>
  void take(const char* name, T& value, Words<T> words) {
    std::vector<std::string> known;
    std::size_t chosen = 0;
    for (const auto& [word, meaning] : words) {
      if (meaning == value) chosen = known.size();
      known.emplace_back(word);
    }
    value = words[take_word(name, chosen, known)].second;
  }

  /// Accepts a deprecated name as `name`, with a DeprecationWarning; before `name` is taken.
  void accept_old_name(const char* old_name, const char* name);

  /// To be called when everything was taken. Errors: TypeError.
  void finish() const;

  /// ", name=default" of everything that was taken; "" where nothing was.
  const std::string& signature() const { return signature_; }

 private:
  /// The argument of that name, or nothing; notes the name and the default.
  std::optional<py::object> find(const char* name, const py::object& default_value);
  std::size_t take_word(const char* name, std::size_t chosen,
                        const std::vector<std::string>& known);
  [[noreturn]] void wrong_type(const char* name, const char* expected, py::handle got) const;

  std::string function_;
  std::optional<py::dict> given_;
  std::vector<std::string> names_;
  std::string signature_;
};

/// Takes all settings of a subject by their names, or by their keys.
template <class Settings>
void take_settings(Keywords& keywords, Settings& settings,
                   const char* Setting::*word = &Setting::name) {
  visit_settings(settings, [&keywords, word]<class T>(const Setting& setting, T& value) {
    if (*setting.old_name != 0) keywords.accept_old_name(setting.old_name, setting.*word);
    if constexpr (std::is_enum_v<T>) {
      keywords.take<T>(setting.*word, value, words_of(value));
    } else {
      keywords.take(setting.*word, value);
    }
  });
}

/// A message of the library with the names of settings as the keywords that take them.
std::string with_keywords(std::string_view message);

/// Errors: ValueError, of a keyword that was given and changes nothing beside the others.
void refuse_unused(const std::vector<UnusedSetting>& unused, const py::kwargs& given);

/// A docstring that begins with the signature, as inspect.signature wants it: `leading` are the
/// arguments before the keywords, `take_all` takes every keyword.
std::string documented(const char* name, const char* leading,
                       const std::function<void(Keywords&)>& take_all, const char* text);
std::string documented(const char* name, const char* signature, const char* text);

}  // namespace adasplats::python
