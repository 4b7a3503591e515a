// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "adasplats/serve/http_server.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// Answers the page's GETs (docs/viewer_protocol.md): the page, scene.json, layers and recorded
/// scans, and nothing else. `scene` must outlive it.
class ViewPages {
 public:
  explicit ViewPages(const ViewScene& scene);
  /// Status 404 for what there is not, 500 where a recorded scan or the levels of a city can no
  /// longer be read.
  HttpReply get(std::string_view path) const;

 private:
  HttpReply layer(std::string_view path) const;
  HttpReply recorded_scan(std::string_view name) const;

  const ViewScene& scene_;
  SharedBytes scene_json_;
  std::vector<SharedBytes> nodes_;  ///< nodes.bin of each layer, and of each geometry
};

}  // namespace adasplats
