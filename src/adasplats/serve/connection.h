// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <memory>
#include <set>

#include "adasplats/serve/http_server.h"

namespace adasplats {

using ServerClock = std::chrono::steady_clock;

/// One accepted socket; all of it happens on the server's thread. What has to happen by a time is
/// not left to timers of its own: the server looks at all deadlines a few times in a
/// stall_limit.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Ends it now: when this returns the socket is closed and the server has forgotten it.
  virtual void abort() = 0;
  /// The server stops: ends it within half a second.
  virtual void stop() = 0;
  ServerClock::time_point deadline() const { return deadline_; }

 protected:
  void set_deadline(ServerClock::time_point deadline) { deadline_ = deadline; }

 private:
  ServerClock::time_point deadline_ = ServerClock::time_point::max();
};

/// What the connections of a server share. They own it together, since a WebSocketPeer may be kept
/// longer than the server.
struct ServerCore {
  HttpServerOptions options;
  HttpHandler get;
  WebSocketHandler& live;
  std::uint16_t port = 0;
  boost::asio::io_context context{1};
  std::set<std::shared_ptr<Connection>> connections;  ///< those that are open

  ServerClock::time_point stall_deadline() const {
    return ServerClock::now() + options.stall_limit;
  }
};

}  // namespace adasplats
