// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "adasplats/serve/http_server.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// Nodes per block of a layer's table. The page loads blocks on demand, so that the first picture
/// costs the same for layers of any size.
inline constexpr std::size_t kTableBlock = 1024;

/// Answers the GETs of the page (docs/viewer_protocol.md): page files, scene.json, layers and
/// recorded scans. `scene` must outlive it.
class ViewPages {
 public:
  explicit ViewPages(const ViewScene& scene);
  /// Status 404 for unknown paths. Errors (the server answers 500): those of reading a recorded
  /// scan or the levels of a city.
  HttpReply get(std::string_view path) const;

 private:
  HttpReply layer(std::string_view path) const;
  const ViewLayer* layer_of(std::string_view number) const;
  HttpReply recorded_scan(std::string_view name) const;

  const ViewScene& scene_;
  SharedBytes scene_json_;
};

}  // namespace adasplats
