// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/serve/http_server.h"

namespace adasplats {

/// Messages for clients of the Foxglove WebSocket protocol (github foxglove/ws-protocol,
/// docs/spec.md, "foxglove.websocket.v1"): a client subscribes to channels and gets their messages
/// from then on. Thread-safe.
class MessageServer final : public WebSocketHandler {
 public:
  static constexpr const char* kSubprotocol = "foxglove.websocket.v1";

  /// Channels get the numbers 0, 1, ... Messages of `latched` ones are repeated for clients that
  /// subscribe later. A client that is behind by more than `queue_bytes` misses messages.
  struct Channel : McapChannel {
    bool is_latched = false;
  };
  MessageServer(std::string name, std::vector<Channel> channels, std::size_t queue_bytes);

  /// Whether somebody gets the messages of a channel.
  bool is_wanted(std::size_t channel) const;
  void publish(std::size_t channel, std::uint64_t time_ns, std::string_view bytes);
  /// The time of the simulation.
  void publish_time(std::uint64_t time_ns);
  std::size_t clients() const;
  /// Messages that slow clients missed.
  std::uint64_t missed() const;

  void opened(const std::shared_ptr<WebSocketPeer>& peer) override;
  void received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) override;
  void closed(const std::shared_ptr<WebSocketPeer>& peer) override;

 private:
  struct Client {
    std::shared_ptr<WebSocketPeer> peer;
    std::map<std::uint32_t, std::size_t> channel_of;  ///< by subscription
  };
  struct Latched {
    std::uint64_t time_ns = 0;
    std::string bytes;
  };

  void send(Client& client, std::uint32_t subscription, std::uint64_t time_ns,
            std::string_view bytes);

  const std::string name_;
  const std::vector<Channel> channels_;
  const std::size_t queue_bytes_;
  mutable std::mutex mutex_;
  std::vector<Client> clients_;
  std::map<std::size_t, Latched> latched_;  ///< by channel
  std::uint64_t missed_ = 0;
};

}  // namespace adasplats
