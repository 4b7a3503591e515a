// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Label schemes of users, as TOML.

#include <toml++/toml.h>

#include <algorithm>
#include <set>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {

namespace {

constexpr std::array<std::uint8_t, 3> kDefaultRgb = {160, 160, 160};

/// Reads values of a file, with errors that name the line.
class SchemeFile {
 public:
  explicit SchemeFile(const std::string& path) : path_(path) {}

  Error error(std::uint64_t line, const std::string& message) const {
    return Error(ErrorKind::config, path_ + ":" + std::to_string(line) + ": " + message);
  }
  Error error(const toml::node& node, const std::string& message) const {
    return error(node.source().begin.line, message);
  }

  void reject_unknown_keys(const toml::table& table, const std::vector<std::string>& known) const {
    for (const auto& [key, value] : table) {
      const std::string word(key.str());
      if (std::ranges::find(known, word) != known.end()) continue;
      const auto nearest = nearest_word(word, known);
      throw error(key.source().begin.line,
                  "unknown key '" + word + "'" +
                      (nearest ? ", did you mean '" + *nearest + "'?" : std::string()));
    }
  }

  const toml::node& required(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) throw error(table, "a class needs '" + std::string(key) + "'");
    return *node;
  }

  std::string text(const toml::node& node, const std::string& key) const {
    const auto value = node.value_exact<std::string>();
    if (!value || value->empty()) throw error(node, "'" + key + "' is not a text in quotes");
    return *value;
  }

  std::int64_t integer(const toml::node& node, const std::string& key, std::int64_t high) const {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < 0 || *value > high)
      throw error(node, "'" + key + "' is not a whole number from 0 to " + std::to_string(high));
    return *value;
  }

  template <class T>
  T choice(const toml::node& node, const std::string& key,
           const std::vector<std::pair<std::string, T>>& choices) const {
    const std::string word = text(node, key);
    std::vector<std::string> words;
    std::string list;
    for (const auto& [name, value] : choices) {
      if (name == word) return value;
      words.push_back(name);
      list += (list.empty() ? "" : ", ") + name;
    }
    const auto nearest = nearest_word(word, words);
    throw error(node, "unknown " + key + " '" + word + "'" +
                          (nearest ? ", did you mean '" + *nearest + "'?" : " (" + list + ")"));
  }

 private:
  std::string path_;
};

/// The parser recurses over dotted keys without a limit of its own (over brackets it has one).
void reject_deep_keys(const SchemeFile& file, std::string_view text) {
  constexpr int kMaxDots = 64;
  std::uint64_t line = 1;
  int dots = 0;
  for (const char c : text) {
    if (c == '.' && ++dots > kMaxDots)
      throw file.error(line, "more than " + std::to_string(kMaxDots) + " dots in a line");
    if (c == '\n') {
      ++line;
      dots = 0;
    }
  }
}

toml::table parse(const SchemeFile& file, const std::string& text) {
  reject_deep_keys(file, text);
  try {
    return toml::parse(std::string_view(text));
  } catch (const toml::parse_error& problem) {
    throw file.error(problem.source().begin.line, std::string(problem.description()));
  }
}

std::array<std::uint8_t, 3> read_rgb(const SchemeFile& file, const toml::node& node) {
  const toml::array* values = node.as_array();
  if (values == nullptr || values->size() != 3)
    throw file.error(node, "'rgb' is not a list of three numbers");
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<std::uint8_t>(file.integer((*values)[i], "rgb", 255));
  return rgb;
}

SemanticClass read_class(const SchemeFile& file, const toml::node& node) {
  const toml::table* table = node.as_table();
  if (table == nullptr) throw file.error(node, "'class' is not a list of [[class]] tables");
  file.reject_unknown_keys(*table, {"id", "name", "group", "mobility", "rgb"});
  SemanticClass result{};
  result.id = static_cast<std::uint16_t>(file.integer(file.required(*table, "id"), "id", 0xffff));
  result.name = file.text(file.required(*table, "name"), "name");
  result.group = file.choice<SemanticGroup>(file.required(*table, "group"), "group",
                                            {{"ground", SemanticGroup::ground},
                                             {"surface", SemanticGroup::surface},
                                             {"linear", SemanticGroup::linear},
                                             {"non-surface", SemanticGroup::non_surface}});
  if (const toml::node* mobility = table->get("mobility"))
    result.mobility = file.choice<Mobility>(
        *mobility, "mobility",
        {{"fixed", Mobility::fixed}, {"movable", Mobility::movable}, {"moving", Mobility::moving}});
  const toml::node* rgb = table->get("rgb");
  result.rgb = rgb != nullptr ? read_rgb(file, *rgb) : kDefaultRgb;
  return result;
}

LabelScheme read_scheme(const std::string& path) {
  const SchemeFile file(path);
  const toml::table root = parse(file, read_file(path));
  file.reject_unknown_keys(root, {"name", "class"});
  const toml::node* name = root.get("name");
  const toml::node* classes = root.get("class");
  if (name == nullptr) throw file.error(1, "a label scheme needs 'name'");
  if (classes == nullptr) throw file.error(1, "a label scheme needs at least one [[class]]");
  if (!classes->is_array() || classes->as_array()->empty())
    throw file.error(*classes, "'class' is not a list of [[class]] tables");

  std::vector<SemanticClass> result;
  std::set<std::uint16_t> ids;
  std::set<std::string> names;
  for (const toml::node& node : *classes->as_array()) {
    result.push_back(read_class(file, node));
    const SemanticClass& added = result.back();
    const toml::table& table = *node.as_table();
    if (!ids.insert(added.id).second)
      throw file.error(*table.get("id"), "duplicate id " + std::to_string(added.id));
    if (!names.insert(added.name).second)
      throw file.error(*table.get("name"), "duplicate class name '" + added.name + "'");
  }
  return LabelScheme(file.text(*name, "name"), std::move(result));
}

}  // namespace

LabelScheme load_label_scheme(const std::string& name_or_path) {
  std::vector<std::string> names;
  std::string list;
  for (const LabelScheme* scheme : known_label_schemes()) {
    if (name_or_path == scheme->name()) return *scheme;
    names.push_back(scheme->name());
    list += (list.empty() ? "" : ", ") + scheme->name();
  }
  std::error_code ignored;  // a text too long for a path is none
  if (!std::filesystem::exists(name_or_path, ignored)) {
    const auto nearest = nearest_word(name_or_path, names);
    throw Error(ErrorKind::no_input,
                name_or_path + ": neither a file nor a label scheme" +
                    (nearest ? ", did you mean '" + *nearest + "'?" : " (" + list + ")"));
  }
  return read_scheme(name_or_path);
}

}  // namespace adasplats
