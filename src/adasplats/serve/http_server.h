// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace adasplats {

/// Bytes that several connections may send at once.
using SharedBytes = std::shared_ptr<const std::string>;

/// What a GET is answered with.
struct HttpReply {
  int status = 200;
  std::string content_type = "application/octet-stream";
  SharedBytes body;  ///< null: empty
};

/// The answer to the path behind "/TOKEN/", without its query ("layers/0/table/0.bin"; "" is the
/// folder itself); status 404 where there is nothing. Called on the server's thread.
using HttpHandler = std::function<HttpReply(std::string_view path)>;

/// The other end of a WebSocket. Any thread may call these; after it is gone they do nothing.
class WebSocketPeer {
 public:
  virtual ~WebSocketPeer() = default;
  /// Sends behind what is queued. Where more than `queued_bytes_limit` would wait, the connection
  /// is closed instead.
  virtual void send_text(std::string text) = 0;
  virtual void send_binary(SharedBytes bytes) = 0;
  /// Ends the connection with a close code (RFC 6455, 7.4.1) and a reason.
  virtual void close(std::uint16_t code, std::string_view reason) = 0;
};

/// What happens to WebSockets. Called on the server's thread, so it must return soon.
class WebSocketHandler {
 public:
  virtual ~WebSocketHandler() = default;
  virtual void opened(const std::shared_ptr<WebSocketPeer>& peer) = 0;
  /// A whole text message; binary ones close the connection (1003).
  virtual void received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) = 0;
  /// Once for each peer that was opened, whoever ended it.
  virtual void closed(const std::shared_ptr<WebSocketPeer>& peer) = 0;
};

struct HttpServerOptions {
  std::string address = "127.0.0.1";              ///< numeric
  std::uint16_t port = 0;                         ///< 0: any free one
  std::string token;                              ///< first part of every path; not empty
  std::size_t connections_limit = 64;             ///< more are answered 503 and closed
  std::size_t header_bytes_limit = 8 << 10;       ///< of a request
  std::size_t message_bytes_limit = 16 << 10;     ///< of a WebSocket message from the other end
  std::size_t queued_bytes_limit = 64 << 20;      ///< that wait for one WebSocket
  std::chrono::milliseconds stall_limit{30'000};  ///< without a byte taken or a request begun
};

/// A token nobody can guess: 32 hexadecimal digits from the system's random numbers.
std::string random_token();

/// A small HTTP/1.1 server for one page on this machine: GET and HEAD below /TOKEN/, and one
/// WebSocket at /TOKEN/live. It serves what `get` answers and nothing else; it reads no files.
/// Every answer forbids caching, sniffing, framing and loading from elsewhere. A WebSocket whose
/// Origin is not this server's is refused (403), as is a Host that is neither the address, nor
/// localhost.
class HttpServer {
 public:
  /// Listens; nobody is answered before run(). `get` and `live` must outlive it.
  /// Errors: unavailable (the port is taken, or there is no such address); usage (an address that
  /// is not numeric, a token that is not letters, digits, '-' and '_').
  HttpServer(HttpServerOptions options, HttpHandler get, WebSocketHandler& live);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const;
  /// "http://127.0.0.1:8123/0123.../"
  std::string url() const;
  /// Serves on the calling thread until stop(). An exception of a handler is answered with 500, or
  /// closes the WebSocket (1011), and the server goes on.
  void run();
  /// From any thread, or a signal's: run() returns soon, connections are closed (1001).
  void stop();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Whether this build has the server: false where Boost was not found. The constructor of
/// HttpServer then throws an unavailable Error that says so.
bool has_http_server();

}  // namespace adasplats
