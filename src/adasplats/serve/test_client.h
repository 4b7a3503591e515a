// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "adasplats/serve/http_server.h"

namespace adasplats {

/// A client that sends any bytes over a plain socket.
class RawClient {
 public:
  struct Frame {
    int opcode = -1;  ///< -1: the connection ended
    bool last = true;
    std::string payload;
    /// The code of a close frame; 0 for other frames.
    int close_code() const {
      if (opcode != 8 || payload.size() < 2) return 0;
      return static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
    }
  };

  explicit RawClient(std::uint16_t port, int receive_buffer = 0)
      : port_(port), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval limit{5, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (receive_buffer)
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  RawClient(RawClient&& other) noexcept
      : port_(other.port_),
        socket_(std::exchange(other.socket_, -1)),
        buffer_(std::move(other.buffer_)) {}
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  RawClient& operator=(RawClient&&) = delete;
  ~RawClient() { drop(); }

  void drop() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }
  /// Ends with a reset instead of a close.
  void reset() {
    const linger now{1, 0};
    setsockopt(socket_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    drop();
  }

  /// False if the server has closed the connection.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }

  /// "GET TARGET" with our Host and more lines of header.
  bool get(std::string_view target, std::string_view lines = {}, std::string_view method = "GET") {
    return send(std::string(method) + " " + std::string(target) + " HTTP/1.1\r\nHost: " + host() +
                "\r\n" + std::string(lines) + "\r\n");
  }
  std::string host() const { return std::string("127.0.0.1:") + std::to_string(port_); }

  /// Appends at least one byte to `buffer_`; false at the end of the connection.
  bool receive() {
    char bytes[65536];
    const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
    if (count < 0 && errno == EAGAIN) ADD_FAILURE() << "received nothing for five seconds";
    if (count <= 0) return false;
    buffer_.append(bytes, static_cast<std::size_t>(count));
    return true;
  }
  std::string take(std::size_t count) {
    while (buffer_.size() < count && receive()) {
    }
    count = std::min(count, buffer_.size());
    std::string bytes = buffer_.substr(0, count);
    buffer_.erase(0, count);
    return bytes;
  }
  /// Everything until the server closes the connection.
  std::string take_all() {
    while (receive()) {
    }
    return std::exchange(buffer_, {});
  }
  bool ended() { return buffer_.empty() && !receive(); }

  /// One reply: its header, and the body of its Content-Length unless it answers HEAD.
  std::string reply(bool head = false) {
    std::size_t end = 0;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
      if (!receive()) return std::exchange(buffer_, {});
    }
    const std::size_t length = buffer_.find("\r\nContent-Length: ");
    std::size_t size = end + 4;
    if (!head && length < end) size += std::stoul(buffer_.substr(length + 18));
    return take(size);
  }

  /// Requests the WebSocket and returns the response.
  std::string upgrade(std::string_view target, std::string_view lines = {}) {
    get(target, std::string("Connection: Upgrade\r\nUpgrade: websocket\r\n"
                            "Sec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n") +
                    std::string(lines));
    return reply();
  }

  /// A frame's bytes (RFC 6455, 5.2), masked with a key.
  static std::string frame(int first_byte, std::string_view payload, bool masked = true) {
    std::string bytes(1, static_cast<char>(first_byte));
    const int mask_bit = masked ? 0x80 : 0;
    if (payload.size() < 126) {
      bytes += static_cast<char>(mask_bit | static_cast<int>(payload.size()));
    } else {
      const int width = payload.size() < 65536 ? 2 : 8;
      bytes += static_cast<char>(mask_bit | (width == 2 ? 126 : 127));
      for (int i = width - 1; i >= 0; --i)
        bytes += static_cast<char>(payload.size() >> (8 * i) & 255);
    }
    const std::string key = masked ? "\x12\x34\x56\x78" : "";
    bytes += key;
    for (std::size_t i = 0; i < payload.size(); ++i)
      bytes += static_cast<char>(payload[i] ^ (masked ? key[i % 4] : 0));
    return bytes;
  }
  bool send_text(std::string_view text) { return send(frame(0x81, text)); }

  Frame read_frame() {
    const std::string head = take(2);
    if (head.size() < 2) return {};
    const auto byte = [](char c) {
      return static_cast<std::size_t>(static_cast<unsigned char>(c));
    };
    std::size_t size = byte(head[1]) & 127;
    if (size > 125) {
      const std::string digits = take(size == 126 ? 2 : 8);
      size = 0;
      for (const char c : digits) size = size << 8 | byte(c);
    }
    return {static_cast<int>(byte(head[0]) & 15), (byte(head[0]) & 128) != 0, take(size)};
  }
  /// The frames of a message as one.
  Frame read_message() {
    Frame message = read_frame();
    while (!message.last) {
      const Frame more = read_frame();
      if (more.opcode != 0) return {};
      message.last = more.last;
      message.payload += more.payload;
    }
    return message;
  }

 private:
  std::uint16_t port_;
  int socket_;
  std::string buffer_;
};

/// Records the events of WebSockets and runs actions of a test.
class RecordingHandler final : public WebSocketHandler {
 public:
  using Peer = std::shared_ptr<WebSocketPeer>;
  std::function<void(const Peer&)> on_open = [](const Peer&) {};
  std::function<void(const Peer&, std::string_view)> on_text =
      [](const Peer& peer, std::string_view text) { peer->send_text(std::string(text)); };

  void opened(const Peer& peer) override {
    {
      const std::scoped_lock lock(mutex_);
      peers_.push_back(peer);
      closings_.push_back(0);
    }
    on_open(peer);
  }
  void received(const Peer& peer, std::string_view text) override { on_text(peer, text); }
  void closed(const Peer& peer) override {
    const std::scoped_lock lock(mutex_);
    for (std::size_t i = 0; i < peers_.size(); ++i) closings_[i] += peers_[i] == peer;
  }

  /// How often each peer was closed, in the order they were opened.
  std::vector<int> closings() const {
    const std::scoped_lock lock(mutex_);
    return closings_;
  }
  Peer peer(std::size_t i) const {
    const std::scoped_lock lock(mutex_);
    return peers_.at(i);
  }
  void forget() {
    const std::scoped_lock lock(mutex_);
    peers_.clear();
    closings_.clear();
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Peer> peers_;
  std::vector<int> closings_;
};

/// Number of open files and sockets of this process.
inline std::size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

/// Sanitizers retain freed memory for a while.
#ifdef ADASPLATS_SANITIZED
inline constexpr std::size_t kSanitizerKb = 1 << 20;
#else
inline constexpr std::size_t kSanitizerKb = 0;
#endif

/// Resident memory of this process.
inline std::size_t resident_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stoul(line.substr(6));
  return 0;
}

/// Whether a condition becomes true within two seconds.
inline bool soon(const std::function<bool()>& condition) {
  for (int i = 0; i < 4000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

/// A server on its own thread; a test may change the options before start().
class ServerTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_http_server()) GTEST_SKIP() << "built without Boost";
    options.token = "secret";
  }
  void TearDown() override { stop(); }

  void start() {
    server = std::make_unique<HttpServer>(
        options, [this](std::string_view path) { return get(path); }, live);
    running = std::thread([this] { server->run(); });
  }
  void stop() {
    if (running.joinable()) {
      server->stop();
      running.join();
    }
  }
  RawClient client() const { return RawClient(server->port()); }
  /// A client with an open WebSocket.
  RawClient live_client(std::string_view lines = {}, int receive_buffer = 0) const {
    RawClient result(server->port(), receive_buffer);
    EXPECT_TRUE(result.upgrade("/secret/live", lines).starts_with("HTTP/1.1 101 "));
    return result;
  }

  HttpServerOptions options;
  RecordingHandler live;
  HttpHandler get = [](std::string_view path) -> HttpReply {
    if (path == "a b") return {200, "text/plain", std::make_shared<const std::string>("found")};
    if (path.empty()) return {200, "text/html", nullptr};
    return {404, {}, nullptr};
  };
  std::unique_ptr<HttpServer> server;
  std::thread running;
};

}  // namespace adasplats
