// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/serve/http_server.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "adasplats/core/error.h"

#ifdef ADASPLATS_HAVE_BOOST

#include <sys/eventfd.h>

#include <algorithm>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cctype>
#include <stdexcept>
#include <vector>

#include "adasplats/serve/connection.h"
#include "adasplats/serve/request_check.h"

namespace adasplats {
namespace {

namespace asio = boost::asio;
using ErrorCode = boost::system::error_code;
using asio::ip::tcp;

/// Pause before accepting again after an error (no descriptors, no memory), which may persist.
constexpr std::chrono::milliseconds kAcceptPause{100};
/// Limit of connections without the token as a multiple of the others. A client in a flood has the
/// time of that many new connections to send its request.
constexpr std::size_t kStrangersPerUser = 8;
/// Limits of the interval at which deadlines are checked.
constexpr std::chrono::milliseconds kMinSweep{10};
constexpr std::chrono::milliseconds kMaxSweep{250};

Error listen_error(const HttpServerOptions& options, const ErrorCode& error) {
  const std::string port = "port " + std::to_string(options.port) + " of " + options.address;
  if (error == asio::error::address_in_use)
    return {ErrorKind::unavailable,
            port + " is in use by another program; choose another port, or 0 for any free one"};
  return {ErrorKind::unavailable, "cannot listen on " + port + ": " + error.message()};
}

tcp::acceptor listening(asio::io_context& context, const HttpServerOptions& options) {
  ErrorCode error;
  const asio::ip::address address = asio::ip::make_address(options.address, error);
  if (error)
    throw Error(ErrorKind::usage, std::string("'") + options.address +
                                      "' is not a numeric address; expected one like 127.0.0.1");
  const tcp::endpoint endpoint(address, options.port);
  tcp::acceptor acceptor(context);
  acceptor.open(endpoint.protocol(), error);
  // Allows a port of recently ended connections, but not one on which another program listens.
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) throw listen_error(options, error);
  return acceptor;
}

void check_token(const std::string& token) {
  if (token.empty()) throw std::logic_error("HttpServer: the token is empty");
  // Characters that browsers do not encode (RFC 3986, 2.3), without dots, which may change the
  // path.
  const bool plain = std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_');
  });
  if (!plain)
    throw Error(ErrorKind::usage, std::string("'") + token +
                                      "' is not a valid token; use only letters, digits, '-' "
                                      "and '_'");
}

int new_event() {
  const int descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (descriptor < 0)
    throw system_error(ErrorKind::unavailable, "eventfd", "no descriptor for the server", errno);
  return descriptor;
}

}  // namespace

class HttpServer::Implementation {
 public:
  Implementation(HttpServerOptions options, HttpActions act, bool takes_writes,
                 WebSocketHandler& live)
      : core_(new ServerCore{std::move(options), std::move(act), takes_writes, live}),
        acceptor_(listening(core_->context, core_->options)),
        pause_(core_->context),
        sweep_(core_->context),
        event_(new_event()),
        stopped_(core_->context, event_) {
    core_->port = acceptor_.local_endpoint().port();
  }

  std::string host() const { return host_of({core_->options.address, core_->port}); }
  const ServerCore& core() const { return *core_; }
  void run();
  /// Only one system call, so that signal handlers may use it.
  void stop() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(event_, &one, sizeof one);
  }

 private:
  void accept();
  void accepted(ErrorCode error, tcp::socket socket);
  void make_room();
  void sweep();
  void begin_stop();
  template <class Call>
  void for_connections(Call call);

  std::shared_ptr<ServerCore> core_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  asio::steady_timer sweep_;
  int event_;
  asio::posix::stream_descriptor stopped_;  // owns event_
  bool stopping_ = false;
};

void HttpServer::Implementation::run() {
  stopped_.async_wait(asio::posix::stream_descriptor::wait_read, [this](ErrorCode error) {
    if (!error) begin_stop();
  });
  accept();
  sweep();
  while (true) {
    try {
      core_->context.run();
      return;
    } catch (const std::bad_alloc&) {
      // The connection without memory gets no response and is closed at its deadline.
      continue;
    }
  }
}

void HttpServer::Implementation::accept() {
  acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) {
    if (!stopping_) accepted(error, std::move(socket));
  });
}

void HttpServer::Implementation::accepted(ErrorCode error, tcp::socket socket) {
  if (error && error != asio::error::connection_aborted) {
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([this](ErrorCode) {
      if (!stopping_) accept();
    });
    return;
  }
  if (!error) {
    make_room();
    socket.set_option(tcp::no_delay(true), error);
    start_http(std::move(socket), core_);
  }
  accept();
}

/// Closes the oldest connection without the token if there are too many of them.
void HttpServer::Implementation::make_room() {
  const auto& all = core_->connections;
  const std::size_t limit = kStrangersPerUser * core_->options.connections_limit;
  if (all.size() - core_->users() < limit) return;
  const auto oldest = std::ranges::min_element(all, {}, [](const auto& connection) {
    return std::pair(connection->has_token(), connection->begin());
  });
  core_->connections.extract(oldest).value()->abort();
}

template <class Call>
void HttpServer::Implementation::for_connections(Call call) {
  // A copy, because connections that end remove themselves from the set.
  const std::vector<std::shared_ptr<Connection>> all(core_->connections.begin(),
                                                     core_->connections.end());
  for (const std::shared_ptr<Connection>& connection : all) call(*connection);
}

void HttpServer::Implementation::sweep() {
  const ServerClock::time_point now = ServerClock::now();
  for_connections([now](Connection& connection) {
    if (connection.deadline() <= now) connection.abort();
  });
  if (stopping_ && core_->connections.empty()) return;
  sweep_.expires_after(
      stopping_ ? kMinSweep : std::clamp(core_->options.stall_limit / 4, kMinSweep, kMaxSweep));
  sweep_.async_wait([this](ErrorCode) { sweep(); });
}

void HttpServer::Implementation::begin_stop() {
  stopping_ = true;
  ErrorCode ignored;
  acceptor_.close(ignored);
  pause_.cancel();
  for_connections([](Connection& connection) { connection.stop(); });
  sweep_.cancel();  // and sweep at the shortest interval from now on
}

std::size_t ServerCore::users() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(connections, [](const auto& one) { return one->has_token(); }));
}

bool ServerCore::is_allowed_origin(std::string_view origin, std::string_view host) const {
  return is_own_origin(origin, host) ||
         std::ranges::find(options.allowed_origins, origin) != options.allowed_origins.end();
}

HttpServer::HttpServer(HttpServerOptions options, HttpHandler get, WebSocketHandler& live) {
  check_token(options.token);
  HttpActions act = [get = std::move(get)](const HttpRequest& request, const HttpAnswer& answer) {
    answer(get(request.path));
  };
  implementation_ =
      std::make_unique<Implementation>(std::move(options), std::move(act), false, live);
}
HttpServer::HttpServer(HttpServerOptions options, HttpActions act, WebSocketHandler& live) {
  check_token(options.token);
  implementation_ =
      std::make_unique<Implementation>(std::move(options), std::move(act), true, live);
}
HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const { return implementation_->core().port; }

std::string HttpServer::url() const {
  return std::string("http://") + implementation_->host() + "/" +
         implementation_->core().options.token + "/";
}

void HttpServer::run() { implementation_->run(); }
void HttpServer::stop() { implementation_->stop(); }

bool has_http_server() { return true; }

}  // namespace adasplats

#else

namespace adasplats {

class HttpServer::Implementation {};

namespace {

[[noreturn]] void throw_no_server() {
  throw Error(ErrorKind::unavailable,
              "this build of adasplats has no local server: it was built without Boost (Asio and "
              "Beast, 1.74 or later); install the package libboost-dev and build again");
}

}  // namespace

// NOLINTNEXTLINE(performance-unnecessary-value-param): the signature of the build with Boost
HttpServer::HttpServer(HttpServerOptions, HttpHandler, WebSocketHandler&) { throw_no_server(); }
// NOLINTNEXTLINE(performance-unnecessary-value-param): likewise
HttpServer::HttpServer(HttpServerOptions, HttpActions, WebSocketHandler&) { throw_no_server(); }
HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const { return 0; }
std::string HttpServer::url() const { return {}; }
void HttpServer::run() {}
void HttpServer::stop() {}

bool has_http_server() { return false; }

}  // namespace adasplats

#endif

namespace adasplats {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getentropy(bytes.data(), bytes.size()) != 0)
    throw Error(ErrorKind::unavailable,
                std::string("cannot get random numbers from the system: ") + std::strerror(errno));
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

}  // namespace adasplats
