// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/point_classes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/segment/network/run_network.h"

namespace adasplats {

std::vector<std::uint16_t> semantickitti_ids(const Network& network, const std::string& name) {
  std::vector<std::uint16_t> ids;
  for (const std::string& word : network.classes) {
    const SemanticClass* const found = semantickitti_labels().find(word);
    if (found == nullptr)
      throw Error(ErrorKind::data, name + ": SemanticKITTI has no class '" + word + "'");
    ids.push_back(found->id);
  }
  return ids;
}

bool can_segment() {
  try {
    require_products();
  } catch (const Error&) {
    return false;
  }
  return true;
}

PointClassifier::PointClassifier(const std::filesystem::path& file) {
  require_products();
  network_ = file.empty() ? default_network() : read_network(file);
  facts_ = {file.empty() ? "default" : file.filename().string(), network_.sha256, network_.card};
  ids_ = semantickitti_ids(network_, file.string());
}

bool PointClassifier::has_class_of(DynamicRemoval removal) const {
  return std::ranges::any_of(ids_, [removal](std::uint16_t id) {
    return is_removed(*semantickitti_labels().find(id), removal);
  });
}

PointClasses PointClassifier::classes_of(const PointCloud& cloud, const SegmentOptions& options,
                                         Session& session) const {
  session.progress.begin_step("segment", 0);
  Segmentation found = segment_on_device(cloud, network_, options, session);
  session.progress.end_step();
  PointClasses classes;
  for (const std::string& name : network_.classes) classes.by_class.push_back({name, 0});
  classes.ids.resize(found.classes.size());
  for (std::size_t i = 0; i < classes.ids.size(); ++i) {
    classes.ids[i] = ids_[found.classes[i]];
    ++classes.by_class[found.classes[i]].points;
  }
  classes.confidences = std::move(found.confidences);
  classes.cells = found.cells;
  classes.tiles = found.tiles;
  return classes;
}

nlohmann::ordered_json to_json(const NetworkFacts& facts) {
  return {{"name", facts.name}, {"sha256", facts.sha256}, {"card", facts.card}};
}

Segmentation segment_on_device(const PointCloud& cloud, const Network& network,
                               const SegmentOptions& options, Session& session) {
  Segmentation result;
  const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
    const auto engine = make_cuda_segment_engine(session.device.gpu_numbers().front());
    result = segment_cloud(cloud, network, options, *engine, session.executor);
  });
  return on_gpu ? result : segment_cloud(cloud, network, options, session.executor);
}

}  // namespace adasplats
