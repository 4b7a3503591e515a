// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"

namespace adasplats {

/// A class that predicted labels are judged by.
struct BenchmarkClass {
  std::string name;
  SemanticGroup group;
  bool is_movable = false;  ///< Mobility::movable or moving
};

/// What the classes of a label scheme count as where predicted labels are judged. Those of
/// SemanticKITTI as its single-scan benchmark has them (semantic-kitti.yaml, learning_map): 19
/// classes in its order, where what moves counts as its class at rest, buses and trams as other
/// vehicles, lane markings as road, and outliers, other structures and other objects as nothing.
/// Those of other schemes as themselves by ascending id, classes of one name as one; "unlabeled"
/// counts as nothing, and so does the id 0 where the scheme does not have it.
class BenchmarkClasses {
 public:
  explicit BenchmarkClasses(const LabelScheme& labels);

  const std::string& scheme() const { return scheme_; }  ///< its name
  std::span<const BenchmarkClass> classes() const { return classes_; }
  /// Number of the class that an id counts as; classes().size(): it counts as nothing. Nothing: the
  /// scheme does not have the id.
  std::optional<std::size_t> find(std::uint16_t id) const;

 private:
  std::size_t number_of(std::string_view name) const;

  std::string scheme_;
  std::vector<BenchmarkClass> classes_;
  std::vector<std::optional<std::size_t>> number_of_id_;
};

}  // namespace adasplats
