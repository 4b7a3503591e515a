// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/vec3.h"

// Of toml++ 3, which only sources include (sensors/toml_nodes.h).
namespace toml {
inline namespace v3 {
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace adasplats {

using TomlKeys = std::vector<std::string>;

/// A TOML table with an error (config, with the line) for unknown keys and wrong values. Copies of
/// a toml::table lose their line numbers, so it shares the parsed one.
class TomlTable {
 public:
  TomlTable(std::shared_ptr<const toml::table> table, const std::filesystem::path& path,
            const TomlKeys& known);

  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// Throws if the key is missing.
  void require(std::string_view key) const;

  /// The error "<key> <message>" at the line of the key.
  Error error(std::string_view key, const std::string& message) const;
  Error error_at(const toml::node& node, const std::string& message) const;
  /// "FILE:LINE" of an existing key.
  std::string place(std::string_view key) const;

  /// The table under an existing key.
  TomlTable table(std::string_view key, const TomlKeys& known) const;

  /// The tables of a list that must be there: [[KEY]].
  std::vector<TomlTable> tables(std::string_view key, const TomlKeys& known) const;
  /// The first of them, with any keys; nothing if the key is missing or no such list.
  std::optional<TomlTable> first_table(std::string_view key) const;

  double number(std::string_view key, double otherwise, double low, double high) const;
  std::int64_t whole_number(std::string_view key, std::int64_t low, std::int64_t high) const;
  bool flag(std::string_view key, bool otherwise) const;
  std::string text(std::string_view key, const std::string& otherwise) const;

  // Lists; empty if the key is missing.
  std::vector<double> numbers(std::string_view key, double low, double high) const;
  std::vector<double> angles_rad(std::string_view key, double low_deg, double high_deg) const;
  std::vector<std::uint32_t> whole_numbers(std::string_view key, std::int64_t low) const;
  /// Lists of equal length, concatenated. `columns`: their length; 0 sets it from the first list.
  std::vector<double> number_rows(std::string_view key, double low, double high,
                                  std::size_t& columns) const;
  std::vector<float> rows(std::string_view key, double low, double high,
                          std::size_t& columns) const;
  /// Points, or one point repeated `count` times.
  std::vector<Vec3d> points(std::string_view key, std::size_t count) const;

  /// The value of a key, for callers that parse it themselves; nullptr if the key is missing.
  const toml::node* find(std::string_view key) const;
  double number_of(const toml::node& node, std::string_view key, double low, double high) const;

 private:
  std::vector<const toml::node*> elements(std::string_view key) const;
  Vec3d point_of(const std::vector<const toml::node*>& row, std::string_view key) const;
  std::int64_t whole_number_of(const toml::node& node, std::string_view key, std::int64_t low,
                               std::int64_t high) const;

  std::filesystem::path path_;
  std::shared_ptr<const toml::table> table_;
};

/// A TOML string of any text.
std::string toml_string(std::string_view text);

/// Parses a file of a `kind`, such as "sensor", that may hold the keys `known`. Errors: config.
TomlTable parse_toml(std::string_view text, const std::filesystem::path& path,
                     const TomlKeys& known, const char* kind);

}  // namespace adasplats
