// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "adasplats/serve/http_server.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// Nodes of a layer's table that the page asks for at a time: what a first picture needs is the
/// same of a layer of any size.
inline constexpr std::size_t kTableBlock = 1024;

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
  const ViewLayer* layer_of(std::string_view number) const;
  HttpReply recorded_scan(std::string_view name) const;

  const ViewScene& scene_;
  SharedBytes scene_json_;
};

}  // namespace adasplats
