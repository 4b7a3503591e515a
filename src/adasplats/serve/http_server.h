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
#include <vector>

namespace adasplats {

/// Bytes that several connections may send at once.
using SharedBytes = std::shared_ptr<const std::string>;

/// The response to a GET.
struct HttpReply {
  int status = 200;
  std::string content_type = "application/octet-stream";
  SharedBytes body;  ///< null: empty
};

/// Returns the response to a path after "/TOKEN/", without its query ("layers/0/table/0.bin"; "" is
/// the folder itself); status 404 for an unknown path. Called on the server's thread.
using HttpHandler = std::function<HttpReply(std::string_view path)>;

/// A request of a client that may change something.
struct HttpRequest {
  std::string method;  ///< "GET" (also of HEAD), "POST" or "DELETE"
  std::string path;    ///< as of HttpHandler
  std::string body;    ///< of POST
};
/// Sends the response to a request. Any thread may call it, once; later calls do nothing.
using HttpAnswer = std::function<void(HttpReply)>;
/// Receives a request on the server's thread, so it must return quickly; the answer may come later.
using HttpActions = std::function<void(HttpRequest, HttpAnswer)>;

/// The client of a WebSocket. Any thread may call these; after the connection has ended they do
/// nothing.
class WebSocketPeer {
 public:
  virtual ~WebSocketPeer() = default;
  /// Appends to the queue. If it would exceed `queued_bytes_limit`, closes the connection instead.
  virtual void send_text(std::string text) = 0;
  virtual void send_binary(SharedBytes bytes) = 0;
  /// Bytes that were queued and not sent yet.
  virtual std::size_t queued_bytes() const = 0;
  /// Ends the connection with a close code (RFC 6455, 7.4.1) and a reason.
  virtual void close(std::uint16_t code, std::string_view reason) = 0;
};

/// Receives the events of WebSockets on the server's thread, so it must return quickly.
class WebSocketHandler {
 public:
  virtual ~WebSocketHandler() = default;
  virtual void opened(const std::shared_ptr<WebSocketPeer>& peer) = 0;
  /// A complete text message; binary messages close the connection (1003).
  virtual void received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) = 0;
  /// Called once for each opened peer, whichever side closed it.
  virtual void closed(const std::shared_ptr<WebSocketPeer>& peer) = 0;
};

struct HttpServerOptions {
  std::string address = "127.0.0.1";  ///< numeric
  std::uint16_t port = 0;             ///< 0: any free port
  std::string token;                  ///< first part of every path; not empty
  /// With the token; further ones get 503. Eight times as many others are open at most: then the
  /// oldest of them is closed for a new one, so that they cannot lock out clients with the token.
  std::size_t connections_limit = 64;
  std::size_t header_bytes_limit = 8 << 10;  ///< of a request
  /// Of a WebSocket message from the client, and of the body of a POST.
  std::size_t message_bytes_limit = 16 << 10;
  std::size_t queued_bytes_limit = 64 << 20;      ///< queued for one WebSocket
  std::chrono::milliseconds stall_limit{30'000};  ///< without progress
  std::string subprotocol;                        ///< of the WebSocket, for clients that offer it
  std::vector<std::string> allowed_origins;       ///< of pages of other servers
};

/// An unpredictable token: 32 hexadecimal digits from the system's random numbers. Errors:
/// unavailable.
std::string random_token();

/// A small HTTP/1.1 server for one page on this machine: GET and HEAD below /TOKEN/, and one
/// WebSocket at /TOKEN/live. It serves only the responses of its handler and reads no files. Every
/// response forbids caching, sniffing, framing and loading from other servers. Rejects (403)
/// WebSockets, POST and DELETE with another Origin, and a Host that is neither the address nor
/// localhost.
class HttpServer {
 public:
  /// Listens; requests are answered from run() on. `get` and `live` must outlive the server.
  /// Errors: unavailable (the port is in use, or the address is not one of this machine); usage
  /// (the address is not numeric, or the token has other characters than letters, digits, '-' and
  /// '_').
  HttpServer(HttpServerOptions options, HttpHandler get, WebSocketHandler& live);
  /// The same with POST and DELETE. A POST without Content-Length gets 411, one with a longer body
  /// than message_bytes_limit 413.
  HttpServer(HttpServerOptions options, HttpActions act, WebSocketHandler& live);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const;
  /// "http://127.0.0.1:8123/0123.../"
  std::string url() const;
  /// Serves on the calling thread until stop(). If a handler throws, the response is 500 or the
  /// WebSocket is closed (1011), and the server continues.
  void run();
  /// Makes run() return soon and closes the connections (1001). Callable from any thread and from
  /// signal handlers.
  void stop();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Whether this build has the server: false if Boost was not found. The constructor of HttpServer
/// then throws an unavailable Error.
bool has_http_server();

}  // namespace adasplats
