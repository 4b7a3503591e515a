// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/serve/connection.h"
#include "adasplats/serve/request_check.h"
#include "adasplats/view/live_message.h"
#include "fuzz_readers.h"

namespace adasplats::fuzz {
namespace {

/// Both ends of a connection, without a network between.
struct SocketPair {
  SocketPair() {
    std::array<int, 2> ends{};
    require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) == 0,
            "a pair of sockets");
    served = ends[0];
    browser = ends[1];
  }
  ~SocketPair() { ::close(browser); }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;
  int served = -1, browser = -1;  ///< the connection closes the first
};

/// Answers every text with its length, and counts who comes and goes.
class CountingHandler final : public WebSocketHandler {
 public:
  void opened(const std::shared_ptr<WebSocketPeer>&) override { ++opened_; }
  void received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) override {
    require(text.size() <= kMaxMessage, "no message beyond the limit");
    peer->send_text(std::to_string(text.size()));
  }
  void closed(const std::shared_ptr<WebSocketPeer>&) override { ++closed_; }
  bool is_balanced() const { return opened_ == closed_; }

  static constexpr std::size_t kMaxMessage = 1000;

 private:
  int opened_ = 0, closed_ = 0;
};

/// Whether a part between slashes is ".." or "."; a name may have dots elsewhere ("a..b").
bool leads_elsewhere(std::string_view path) {
  const std::string parts = "/" + std::string(path) + "/";
  return parts.find("/../") != parts.npos || parts.find("/./") != parts.npos ||
         parts.find_first_of(std::string_view("\\\0", 2)) != parts.npos;
}

std::shared_ptr<ServerCore> make_core(CountingHandler& handler) {
  const HttpActions act = [](const HttpRequest& request, const HttpAnswer& answer) {
    static const auto kBody = std::make_shared<const std::string>(300, 'b');
    require(!leads_elsewhere(request.path), "no way out of the folder");
    if (request.path == "throw") throw Error(ErrorKind::data, "d");
    answer({request.path.empty() ? 200 : 404, "text/plain", kBody});
  };
  std::shared_ptr<ServerCore> core(new ServerCore{{}, act, true, handler});
  core->options.token = "t";
  core->options.message_bytes_limit = CountingHandler::kMaxMessage;
  core->port = 8123;
  return core;
}

/// A connection to a server of its own, which is closed by the end that asks. It must end by
/// itself: nobody looks at deadlines here.
class ServedConnection {
 public:
  ServedConnection() : core_(make_core(handler_)) {
    boost::asio::ip::tcp::socket socket(core_->context);
    socket.assign(boost::asio::ip::tcp::v4(), pair_.served);
    start_http(std::move(socket), core_);
  }

  /// Sends bytes, and lets the server do what it can without more.
  void send(std::string_view bytes) {
    while (!bytes.empty() && !core_->connections.empty()) {
      const ssize_t sent = ::send(pair_.browser, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno != EAGAIN) return;  // it no longer listens
      if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
      turn();
    }
    turn();
  }
  void end() {
    ::shutdown(pair_.browser, SHUT_WR);
    while (!core_->connections.empty()) turn();
    turn();
    require(handler_.is_balanced(), "closed() for each opened()");
  }

 private:
  void turn() {
    std::array<char, 4096> answer{};
    while (::recv(pair_.browser, answer.data(), answer.size(), 0) > 0) {
    }
    core_->context.restart();
    core_->context.poll();
    require(std::chrono::steady_clock::now() < limit_, "a connection that ends");
  }

  CountingHandler handler_;
  SocketPair pair_;
  std::shared_ptr<ServerCore> core_;
  std::chrono::steady_clock::time_point limit_ =
      std::chrono::steady_clock::now() + std::chrono::seconds(5);
};

constexpr std::string_view kUpgrade =
    "GET /t/live HTTP/1.1\r\nHost: localhost:8123\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";

}  // namespace

void answer_http(const Input& input) {
  ServedConnection connection;
  connection.send(input.bytes);
  connection.end();
}

void answer_websocket(const Input& input) {
  ServedConnection connection;
  connection.send(kUpgrade);  // what came before its answer would be refused
  connection.send(input.bytes);
  connection.end();
}

void check_request(const Input& input) {
  const std::size_t half = std::min(input.bytes.find('\n'), input.bytes.size());
  const std::string_view first = input.bytes.substr(0, half);
  const std::string_view second = input.bytes.substr(std::min(half + 1, input.bytes.size()));
  if (const auto path = path_after_token(first, "t"))
    require(!leads_elsewhere(*path), "a path of ours");
  for (const char* address : {"127.0.0.1", "0.0.0.0", "::1"}) is_own_host(first, {address, 8123});
  is_own_origin(first, second);
  is_loopback(std::string(first));
}

void read_live_message(const Input& input) { parse_live_message(input.bytes, {}); }

}  // namespace adasplats::fuzz
