// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <filesystem>
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
  /// For a call.
  Keywords(std::string function, const py::kwargs& given);
  /// Without a call: records the names and their defaults.
  Keywords() = default;

  /// Replaces `value` by the argument of that name, if it was given. Errors: TypeError with the
  /// expected type, ValueError (out of range, an unknown word).
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

  /// None: no value.
  template <class T>
  void take(const char* name, std::optional<T>& value, Words<T> words) {
    std::vector<std::string> known;
    for (const auto& [word, meaning] : words) known.emplace_back(word);
    const std::size_t chosen = take_word(name, known.size(), known);
    if (chosen < words.size()) value = words[chosen].second;
  }
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

  /// To be called when everything was taken. Errors: TypeError.
  void finish() const;

  /// ", name=default" of every keyword that was taken; empty without keywords.
  const std::string& signature() const { return signature_; }

 private:
  /// The argument of that name, if it was given; records the name and the default.
  std::optional<py::object> find(const char* name, const py::object& default_value);
  /// Index of the given word in `known`; `chosen` by default (known.size(): the default is None).
  std::size_t take_word(const char* name, std::size_t chosen,
                        const std::vector<std::string>& known);
  [[noreturn]] void wrong_type(const char* name, const char* expected, py::handle got) const;

  std::string function_;
  std::optional<py::dict> given_;
  std::vector<std::string> names_;
  std::string signature_;
};

/// Takes all settings of a struct by their names, or by their keys.
template <class Settings>
void take_settings(Keywords& keywords, Settings& settings,
                   const char* Setting::*word = &Setting::name) {
  visit_settings(settings, [&keywords, word]<class T>(const Setting& setting, T& value) {
    if constexpr (std::is_enum_v<T>) {
      keywords.take<T>(setting.*word, value, words_of(value));
    } else {
      keywords.take(setting.*word, value);
    }
  });
}

/// A message of the library with the names of settings replaced by those of Python keywords.
std::string with_keywords(std::string_view message);

/// Errors: ValueError for a keyword that was given and has no effect with the others.
void reject_unused(const std::vector<UnusedSetting>& unused, const py::kwargs& given);

/// Whether a value is a str, bytes or os.PathLike.
bool is_path(py::handle value);
/// Errors: TypeError.
std::filesystem::path path_of(py::handle value, const char* name);
/// One path or several; `else_expected` ("a PointCloud, ") goes into the message. Errors:
/// TypeError, ValueError (no path).
std::vector<std::filesystem::path> paths_of(py::handle value, const char* name,
                                            const char* else_expected = "");

/// The keyword arguments of a call, which Arguments::take(keywords) lists. Errors: TypeError,
/// ValueError.
template <class Arguments>
Arguments arguments_of(const char* function, const py::kwargs& given) {
  Keywords keywords(function, given);
  Arguments arguments;
  arguments.take(keywords);
  keywords.finish();
  return arguments;
}

/// A docstring that begins with the signature, as inspect.signature() reads it.
std::string documented(const char* name, const char* signature, const char* text);
/// The same for a function with the keywords of Arguments; `leading`: the arguments before them.
template <class Arguments>
std::string documented(const char* name, const char* leading, const char* text) {
  Keywords keywords;
  Arguments arguments;
  arguments.take(keywords);
  return documented(name, (std::string(leading) + ", *" + keywords.signature()).c_str(), text);
}

}  // namespace adasplats::python
