// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#ifdef ADASPLATS_HAVE_BOOST

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "adasplats/serve/connection.h"
#include "adasplats/serve/request_check.h"

namespace adasplats {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using ErrorCode = boost::system::error_code;
using Request = http::request<http::empty_body>;
using Response = http::response<http::span_body<const char>>;

/// After the last response, input is read and dropped up to these limits. Closing a socket with
/// unread bytes would reset the connection and lose the response.
constexpr std::chrono::milliseconds kLingerLimit{1000};
constexpr std::size_t kLingerBytes = std::size_t{1} << 20;

std::string_view to_std(beast::string_view text) { return {text.data(), text.size()}; }

/// `is_json`: as {"error": "Not Found"}, for programs.
HttpReply status_reply(http::status status, bool is_json) {
  const std::string reason(to_std(http::obsolete_reason(status)));
  const std::string text = is_json ? "{\"error\":\"" + reason + "\"}\n" : reason + "\n";
  return {static_cast<int>(status), is_json ? "application/json" : "text/plain; charset=utf-8",
          std::make_shared<const std::string>(text)};
}

constexpr bool is_read(http::verb method) {
  return method == http::verb::get || method == http::verb::head;
}
constexpr bool is_write(http::verb method) {
  return method == http::verb::post || method == http::verb::delete_;
}

/// The methods that a server has, as in the field Allow.
const char* methods_of(const ServerCore& core) {
  return core.takes_writes ? "GET, HEAD, POST, DELETE" : "GET, HEAD";
}

bool has_allowed_origin(const Request& request, const ServerCore& core) {
  const std::string_view host = to_std(request[http::field::host]);
  return std::all_of(request.begin(), request.end(), [&](const auto& field) {
    return field.name() != http::field::origin ||
           core.is_allowed_origin(to_std(field.value()), host);
  });
}

/// Status of a request that is invalid for any path; ok if it is valid.
http::status fault_of(const Request& request, bool has_body, const ServerCore& core) {
  const bool is_writing = core.takes_writes && is_write(request.method());
  if (!is_read(request.method()) && !is_writing) return http::status::method_not_allowed;
  // Only origin-form (RFC 9112, 3.2.1), because this is not a proxy. Exactly one Host (3.2).
  if ((has_body && request.method() != http::verb::post) || !request.target().starts_with('/') ||
      request.count(http::field::host) != 1)
    return http::status::bad_request;
  const std::string_view host = to_std(request[http::field::host]);
  if (!is_own_host(host, {core.options.address, core.port})) return http::status::forbidden;
  if (is_writing && !has_allowed_origin(request, core)) return http::status::forbidden;
  if (request.method() == http::verb::post && request.count(http::field::content_length) != 1)
    return http::status::length_required;
  return http::status::ok;
}

class HttpConnection final : public Connection,
                             public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(asio::ip::tcp::socket socket, std::shared_ptr<ServerCore> core)
      : core_(std::move(core)), socket_(std::move(socket)) {}

  void read();
  void abort() override;
  void stop() override { abort(); }

 private:
  void read_done(ErrorCode error);
  void answer();
  void read_body(std::string path);
  void answer_live();
  void act(HttpRequest request);
  HttpAnswer answer_of_this_request();
  void send(HttpReply reply, bool last);
  HttpReply status_reply(http::status status) const {
    return adasplats::status_reply(status, core_->takes_writes);
  }
  void send_some();
  void sent(ErrorCode error);
  void drop_input();
  void leave();

  std::shared_ptr<ServerCore> core_;
  asio::ip::tcp::socket socket_;
  bool ended_ = false;
  bool keeps_alive_ = false, is_head_ = false;  // of the request
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<http::request_parser<http::string_body>> body_parser_;
  SharedBytes body_;
  std::optional<Response> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
  std::array<char, 2048> dropped_{};
  std::size_t dropped_bytes_ = 0;
};

void HttpConnection::read() {
  // One deadline for the complete header: bytes that trickle in do not extend it.
  set_deadline(core_->stall_deadline());
  keeps_alive_ = is_head_ = false;
  body_parser_.reset();
  parser_.emplace();
  // read_body() has a smaller one. Boost 1.74 takes no value as 0.
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
  parser_->header_limit(static_cast<std::uint32_t>(core_->options.header_bytes_limit));
  http::async_read_header(
      socket_, buffer_, *parser_,
      [self = shared_from_this()](ErrorCode error, std::size_t) { self->read_done(error); });
}

void HttpConnection::read_done(ErrorCode error) {
  if (ended_) return;
  if (!error) {
    answer();
  } else if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    send(status_reply(http::status::request_header_fields_too_large), true);
  } else if (error.category() == http::make_error_code(http::error::bad_method).category() &&
             error != http::error::end_of_stream && error != http::error::partial_message) {
    send(status_reply(http::status::bad_request), true);
  } else {
    abort();
  }
}

void HttpConnection::answer() {
  const Request& request = parser_->get();
  keeps_alive_ = request.keep_alive();
  is_head_ = request.method() == http::verb::head;
  const http::status fault = fault_of(request, !parser_->is_done(), *core_);
  if (fault != http::status::ok) return send(status_reply(fault), true);
  const std::optional<std::string> path =
      path_after_token(to_std(request.target()), core_->options.token);
  if (!path)
    return send(status_reply(http::status::not_found), !keeps_alive_ || !parser_->is_done());
  if (!has_token() && core_->users() >= core_->options.connections_limit)
    return send(status_reply(http::status::service_unavailable), true);
  set_has_token();
  if (*path == "live" && is_read(request.method())) return answer_live();
  if (request.method() == http::verb::post) return read_body(*path);
  act({is_read(request.method()) ? "GET" : "DELETE", *path, {}});
}

/// Within the deadline of the header.
void HttpConnection::read_body(std::string path) {
  if (parser_->content_length().value_or(0) > core_->options.message_bytes_limit)
    return send(status_reply(http::status::payload_too_large), true);
  body_parser_.emplace(std::move(*parser_));
  http::async_read(
      socket_, buffer_, *body_parser_,
      [self = shared_from_this(), path = std::move(path)](ErrorCode error, std::size_t) {
        if (self->ended_) return;
        if (error) return self->abort();
        self->act({"POST", path, std::move(self->body_parser_->get().body())});
      });
}

void HttpConnection::answer_live() {
  Request& request = parser_->get();
  if (!beast::websocket::is_upgrade(request))
    return send(status_reply(http::status::upgrade_required), !request.keep_alive());
  if (!has_allowed_origin(request, *core_))
    return send(status_reply(http::status::forbidden), true);
  // The client must not send data before the response to the upgrade (RFC 6455, 4.1). The key is 16
  // bytes in base64 (4.2.1).
  const bool has_valid_key = request[http::field::sec_websocket_key].size() == 24;
  if (buffer_.size() > 0 || !has_valid_key)
    return send(status_reply(http::status::bad_request), true);
  const auto self = shared_from_this();
  leave();
  start_websocket(std::move(socket_), core_, parser_->release());
}

/// Sends a reply unless another one was sent or the connection has ended.
HttpAnswer HttpConnection::answer_of_this_request() {
  return [self = shared_from_this(),
          is_sent = std::make_shared<std::atomic<bool>>(false)](HttpReply reply) {
    if (is_sent->exchange(true)) return;
    asio::dispatch(self->core_->context, [self, reply = std::move(reply)]() mutable {
      if (self->ended_) return;
      // The same response as for a wrong token.
      if (reply.status == 404 && !reply.body) reply = self->status_reply(http::status::not_found);
      self->send(std::move(reply), !self->keeps_alive_);
    });
  };
}

void HttpConnection::act(HttpRequest request) {
  set_deadline(ServerClock::time_point::max());  // until the answer is there
  const HttpAnswer answer = answer_of_this_request();
  try {
    core_->act(std::move(request), answer);
  } catch (...) {
    answer(status_reply(http::status::internal_server_error));
  }
}

void HttpConnection::send(HttpReply reply, bool last) {
  body_ = std::move(reply.body);
  const std::string_view bytes = body_ ? std::string_view(*body_) : std::string_view();
  response_.emplace();
  response_->version(11);
  response_->result(static_cast<unsigned>(reply.status));
  response_->keep_alive(!last);
  response_->set(http::field::content_type, reply.content_type);
  set_safety_headers(*response_);
  if (response_->result() == http::status::method_not_allowed)
    response_->set(http::field::allow, methods_of(*core_));
  if (response_->result() == http::status::upgrade_required) {
    response_->set(http::field::upgrade, "websocket");
    response_->set(http::field::connection, last ? "upgrade, close" : "upgrade");
  }
  response_->content_length(bytes.size());
  if (!is_head_) response_->body() = {bytes.data(), bytes.size()};
  serializer_.emplace(*response_);
  send_some();
}

void HttpConnection::send_some() {
  // Each part that is sent extends the deadline for the next.
  set_deadline(core_->stall_deadline());
  http::async_write_some(
      socket_, *serializer_,
      [self = shared_from_this()](ErrorCode error, std::size_t) { self->sent(error); });
}

void HttpConnection::sent(ErrorCode error) {
  if (ended_) return;
  if (error) return abort();
  if (!serializer_->is_done()) return send_some();
  const bool last = !response_->keep_alive();
  serializer_.reset();
  response_.reset();
  body_.reset();
  if (!last) return read();
  socket_.shutdown(asio::ip::tcp::socket::shutdown_send, error);
  set_deadline(ServerClock::now() + std::min(kLingerLimit, core_->options.stall_limit));
  drop_input();
}

void HttpConnection::drop_input() {
  socket_.async_read_some(asio::buffer(dropped_),
                          [self = shared_from_this()](ErrorCode error, std::size_t count) {
                            if (self->ended_) return;
                            self->dropped_bytes_ += count;
                            if (error || self->dropped_bytes_ > kLingerBytes) return self->abort();
                            self->drop_input();
                          });
}

void HttpConnection::leave() {
  ended_ = true;
  core_->connections.erase(shared_from_this());
}

void HttpConnection::abort() {
  if (ended_) return;
  const auto self = shared_from_this();
  leave();
  ErrorCode ignored;
  socket_.close(ignored);
}

}  // namespace

void start_http(asio::ip::tcp::socket socket, const std::shared_ptr<ServerCore>& core) {
  const auto connection = std::make_shared<HttpConnection>(std::move(socket), core);
  core->connections.insert(connection);
  connection->read();
}

}  // namespace adasplats

#endif
