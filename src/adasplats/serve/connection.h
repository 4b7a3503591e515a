// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <chrono>
#include <memory>
#include <set>
#include <string_view>

#include "adasplats/serve/http_server.h"

namespace adasplats {

using ServerClock = std::chrono::steady_clock;

/// One accepted socket. All calls are on the server's thread. A connection has a deadline instead
/// of timers; the server checks all deadlines several times per stall_limit.
class Connection {
 public:
  virtual ~Connection() = default;
  /// Closes the socket and removes the connection from the server at once.
  virtual void abort() = 0;
  /// Ends the connection within half a second, because the server stops.
  virtual void stop() = 0;
  ServerClock::time_point deadline() const { return deadline_; }
  /// Whether it has sent a request with the token.
  bool has_token() const { return has_token_; }
  ServerClock::time_point begin() const { return begin_; }

 protected:
  void set_deadline(ServerClock::time_point deadline) { deadline_ = deadline; }
  void set_has_token() { has_token_ = true; }

 private:
  ServerClock::time_point deadline_ = ServerClock::time_point::max();
  ServerClock::time_point begin_ = ServerClock::now();
  bool has_token_ = false;
};

/// State shared by the connections of a server. They own it jointly, because a WebSocketPeer may
/// outlive the server.
struct ServerCore {
  HttpServerOptions options;
  HttpActions act;
  bool takes_writes;  ///< POST and DELETE
  WebSocketHandler& live;
  std::uint16_t port = 0;
  boost::asio::io_context context{1};
  std::set<std::shared_ptr<Connection>> connections;  ///< open ones

  /// Open connections with the token.
  std::size_t users() const;

  ServerClock::time_point stall_deadline() const {
    return ServerClock::now() + options.stall_limit;
  }
  /// Whether a page of this Origin may write and open the WebSocket. Clients other than browsers
  /// send none; they have the token.
  bool is_allowed_origin(std::string_view origin, std::string_view host) const;
};

/// Handles the HTTP requests of a socket; hands it over if a request asks for the WebSocket.
void start_http(boost::asio::ip::tcp::socket socket, const std::shared_ptr<ServerCore>& core);

/// Answers a request for the WebSocket and passes its messages to the handler.
void start_websocket(boost::asio::ip::tcp::socket socket, const std::shared_ptr<ServerCore>& core,
                     boost::beast::http::request<boost::beast::http::empty_body> request);

/// Headers of every response: no caching, and only this page may use the data and load from this
/// server. connect-src 'self' includes ws: of the same host and port (Content Security Policy 3,
/// 6.7.2.8).
inline constexpr const char* kSafetyHeaders[][2] = {
    {"Cache-Control", "no-store"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Content-Security-Policy",
     "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
     "connect-src 'self'; worker-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; "
     "form-action 'none'"},
};

template <class Message>
void set_safety_headers(Message& message) {
  for (const auto& [name, value] : kSafetyHeaders) message.set(name, value);
}

}  // namespace adasplats
