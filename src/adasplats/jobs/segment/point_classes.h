// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/segment/segment_cloud.h"

namespace adasplats {

/// Which network gave points their classes.
struct NetworkFacts {
  std::string name;    ///< of its file; "default": the one that the program comes with
  std::string sha256;  ///< of its file's bytes
  std::string card;
};

/// The classes that a network gives points.
struct PointClasses {
  struct ClassCount {
    std::string name;
    std::size_t points = 0;
  };
  std::vector<std::uint16_t> ids;    ///< one a wanted point, of semantickitti_labels()
  std::vector<float> confidences;    ///< of these, 0 to 1; empty: not asked for
  std::size_t cells = 0, tiles = 0;  ///< that the network saw
  std::vector<ClassCount> by_class;  ///< of the network, in its order
};

/// The ids that a network's classes have in semantickitti_labels(), in its order. Errors: data,
/// beginning with `name` (a class that SemanticKITTI does not have).
std::vector<std::uint16_t> semantickitti_ids(const Network& network, const std::string& name);

/// Whether networks can be run: not in a program that was built without OpenBLAS.
bool can_segment();

/// Gives points the classes of SemanticKITTI by a network.
class PointClassifier {
 public:
  /// `file`: empty for default_network(). Errors: unavailable (can_segment()), those of
  /// read_network and semantickitti_ids.
  explicit PointClassifier(const std::filesystem::path& file);

  const NetworkFacts& facts() const { return facts_; }
  /// The network's classes, and their ids in semantickitti_labels().
  const std::vector<std::string>& names() const { return network_.classes; }
  const std::vector<std::uint16_t>& ids() const { return ids_; }
  /// Whether the network has a class of what `removal` removes.
  bool has_class_of(DynamicRemoval removal) const;

  PointClasses classes_of(const PointCloud& cloud, const SegmentOptions& options,
                          Session& session) const;

 private:
  Network network_;
  NetworkFacts facts_;
  std::vector<std::uint16_t> ids_;  ///< of its classes
};

/// {"name", "sha256", "card"}.
nlohmann::ordered_json to_json(const NetworkFacts& facts);

/// segment_cloud() on the session's device. If a GPU that the user did not request fails, warns and
/// continues on the CPU.
Segmentation segment_on_device(const PointCloud& cloud, const Network& network,
                               const SegmentOptions& options, Session& session);

}  // namespace adasplats
