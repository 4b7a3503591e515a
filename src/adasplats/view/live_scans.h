// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/core/executor.h"
#include "adasplats/serve/http_server.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// Simulates a LiDAR for every connected page (docs/viewer_protocol.md, "WebSocket live"), each
/// with its own sensor and pose. One thread serves the pages in turn. A page gets a scan when it is
/// ready for one, so a stalled page costs nothing.
class LiveScans final : public WebSocketHandler {
 public:
  /// Scene and executor must outlive it.
  LiveScans(const ViewScene& scene, const Executor& executor);
  ~LiveScans() override;
  LiveScans(const LiveScans&) = delete;
  LiveScans& operator=(const LiveScans&) = delete;

  void opened(const std::shared_ptr<WebSocketPeer>& peer) override;
  void received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) override;
  void closed(const std::shared_ptr<WebSocketPeer>& peer) override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace adasplats
