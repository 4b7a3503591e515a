// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace adasplats {

/// What the classes of a network are written as.
struct OutputClasses {
  struct Class {
    std::uint16_t id;
    std::string name;
  };
  std::vector<Class> classes;           ///< each number once, in the order of the network
  std::vector<std::size_t> of_network;  ///< which of them each class of the network is
  std::uint16_t unlabeled = 0;          ///< of points that have no class

  /// Whether several classes of the network are written as one.
  bool joins() const { return classes.size() < of_network.size(); }
  /// Probabilities of the network's classes, point by point, as those of `classes`.
  std::vector<float> joined(std::span<const float> probabilities) const;
};

/// By SemanticKITTI's numbers and names. Errors: data (a class that it does not have, with `file`).
OutputClasses semantickitti_outputs(std::span<const std::string> network,
                                    const std::filesystem::path& file);

/// By a class map: docs/segmentation.md. Errors: no_input; config with the line (no
/// number, a number twice with two names, a class that the network does not have, a class twice) or
/// with the class of the network that is missing.
OutputClasses read_class_map(const std::filesystem::path& file,
                             std::span<const std::string> network);

}  // namespace adasplats
