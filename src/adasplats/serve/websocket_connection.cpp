// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#ifdef ADASPLATS_HAVE_BOOST

#include <algorithm>
#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>
#include <optional>
#include <utility>

#include "adasplats/serve/connection.h"

namespace adasplats {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using ErrorCode = boost::system::error_code;
using Request = http::request<http::empty_body>;

/// Maximum bytes of a frame. Each frame that is sent shows that the client is alive, and control
/// frames need not wait for a complete scan.
constexpr std::size_t kFrameBytes = std::size_t{64} << 10;
/// Overhead of a message in the queue.
constexpr std::size_t kMessageBytes = 128;
/// Maximum time from the decision to close until the socket is closed.
constexpr std::chrono::milliseconds kCloseLimit{500};

enum class Queued : std::uint8_t { kept, dropped };

/// A close reason limited to 123 bytes (RFC 6455, 5.5) without splitting a character.
std::string_view cut_reason(std::string_view reason) {
  if (reason.size() <= 123) return reason;
  std::size_t size = 123;
  while (size > 0 && (reason[size] & 0xc0) == 0x80) --size;
  return reason.substr(0, size);
}

class WebSocketConnection final : public Connection,
                                  public WebSocketPeer,
                                  public std::enable_shared_from_this<WebSocketConnection> {
 public:
  WebSocketConnection(asio::ip::tcp::socket socket, std::shared_ptr<ServerCore> core,
                      Request request);
  void accept();

  // WebSocketPeer: callable from any thread.
  void send_text(std::string text) override;
  void send_binary(SharedBytes bytes) override;
  std::size_t queued_bytes() const override { return queued_bytes_; }
  void close(std::uint16_t code, std::string_view reason) override;

  // Connection: on the server's thread, like everything below.
  void abort() override;
  void stop() override;

 private:
  struct Message {
    SharedBytes bytes;
    bool binary = false;
    std::size_t cost() const { return bytes->size() + kMessageBytes; }
  };

  void enqueue(SharedBytes bytes, bool binary);
  template <class Function>
  void on_server_thread(Function function);
  void accepted(ErrorCode error);
  void read();
  void read_done(ErrorCode error);
  template <class Call>
  bool call_handler(Call call);
  void write();
  void written(ErrorCode error, std::size_t bytes);
  void begin_close(std::uint16_t code, std::string_view reason, Queued queued);
  void send_close();

  std::shared_ptr<ServerCore> core_;
  /// Without compression. Reset when the connection ends, because its timer would keep the server
  /// running.
  std::optional<websocket::stream<asio::ip::tcp::socket, false>> stream_;
  Request request_;
  beast::flat_buffer buffer_;
  std::deque<Message> queue_;
  std::size_t sent_bytes_ = 0;  // of the first message in the queue
  websocket::close_reason reason_;
  bool opened_ = false;
  bool writing_ = false;
  bool closing_ = false;     // further messages are dropped
  bool close_sent_ = false;  // async_close is pending
  bool ended_ = false;
  std::atomic<bool> open_{false};
  std::atomic<std::size_t> queued_bytes_{0};
};

WebSocketConnection::WebSocketConnection(asio::ip::tcp::socket socket,
                                         std::shared_ptr<ServerCore> core, Request request)
    : core_(std::move(core)), stream_(std::move(socket)), request_(std::move(request)) {
  set_has_token();
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = core_->options.stall_limit;
  // A ping is sent after half of this time without a frame.
  timeout.idle_timeout = core_->options.stall_limit;
  timeout.keep_alive_pings = true;
  stream_->set_option(timeout);
  const std::string& protocol = core_->options.subprotocol;
  const bool is_offered =
      !protocol.empty() &&
      http::token_list(request_[http::field::sec_websocket_protocol]).exists(protocol);
  stream_->set_option(websocket::stream_base::decorator(
      [name = is_offered ? protocol : std::string()](websocket::response_type& response) {
        response.set(http::field::server, "adasplats");  // instead of Beast and its version
        if (!name.empty()) response.set(http::field::sec_websocket_protocol, name);
        set_safety_headers(response);
      }));
  stream_->read_message_max(core_->options.message_bytes_limit);
  stream_->auto_fragment(false);
}

void WebSocketConnection::accept() {
  set_deadline(core_->stall_deadline());
  stream_->async_accept(request_,
                        [self = shared_from_this()](ErrorCode error) { self->accepted(error); });
}

void WebSocketConnection::accepted(ErrorCode error) {
  if (ended_) return;
  if (error) return abort();
  set_deadline(ServerClock::time_point::max());
  opened_ = true;
  open_ = true;
  if (call_handler([&] { core_->live.opened(shared_from_this()); })) read();
}

/// False if the handler threw; the connection is then being closed.
template <class Call>
bool WebSocketConnection::call_handler(Call call) {
  try {
    call();
    return true;
  } catch (...) {
    begin_close(1011, "internal server error", Queued::dropped);
    return false;
  }
}

void WebSocketConnection::read() {
  stream_->async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->read_done(error);
  });
}

void WebSocketConnection::read_done(ErrorCode error) {
  // After our close frame, async_close handles the end of the connection.
  if (ended_ || close_sent_) return;
  // Beast has sent the error to the client (RFC 6455, 7.1.7) or answered its close frame.
  if (error) return abort();
  if (closing_) return;
  if (stream_->got_binary()) return begin_close(1003, "text messages only", Queued::dropped);
  const auto bytes = buffer_.data();
  const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
  if (!call_handler([&] { core_->live.received(shared_from_this(), text); })) return;
  buffer_.consume(buffer_.size());
  read();
}

void WebSocketConnection::send_text(std::string text) {
  enqueue(std::make_shared<const std::string>(std::move(text)), false);
}

void WebSocketConnection::send_binary(SharedBytes bytes) {
  enqueue(bytes ? std::move(bytes) : std::make_shared<const std::string>(), true);
}

template <class Function>
void WebSocketConnection::on_server_thread(Function function) {
  asio::post(core_->context, [weak = weak_from_this(), function = std::move(function)]() mutable {
    const std::shared_ptr<WebSocketConnection> self = weak.lock();
    if (self && !self->ended_) function(*self);
  });
}

void WebSocketConnection::enqueue(SharedBytes bytes, bool binary) {
  Message message{std::move(bytes), binary};
  if (!open_) return;
  // Counted here to include messages that the server's thread has not received yet.
  if (queued_bytes_ += message.cost(); queued_bytes_ > core_->options.queued_bytes_limit) {
    open_ = false;
    on_server_thread([](WebSocketConnection& self) {
      self.begin_close(1008, "client too slow", Queued::dropped);
    });
    return;
  }
  on_server_thread([message = std::move(message)](WebSocketConnection& self) mutable {
    if (self.closing_) return;
    self.queue_.push_back(std::move(message));
    self.write();
  });
}

void WebSocketConnection::close(std::uint16_t code, std::string_view reason) {
  if (!open_) return;
  on_server_thread([code, text = std::string(reason)](WebSocketConnection& self) {
    self.begin_close(code, text, Queued::kept);
  });
}

void WebSocketConnection::write() {
  if (writing_ || close_sent_) return;
  if (queue_.empty()) {
    if (closing_) send_close();
    return;
  }
  writing_ = true;
  if (!closing_) set_deadline(core_->stall_deadline());
  const SharedBytes bytes = queue_.front().bytes;
  const std::size_t count = std::min(kFrameBytes, bytes->size() - sent_bytes_);
  stream_->binary(queue_.front().binary);
  stream_->async_write_some(sent_bytes_ + count == bytes->size(),
                            asio::buffer(bytes->data() + sent_bytes_, count),
                            [self = shared_from_this(), bytes, count](
                                ErrorCode error, std::size_t) { self->written(error, count); });
}

void WebSocketConnection::written(ErrorCode error, std::size_t bytes) {
  writing_ = false;
  if (ended_) return;
  if (error) return abort();
  if (!closing_) set_deadline(ServerClock::time_point::max());
  sent_bytes_ += bytes;
  if (!queue_.empty() && sent_bytes_ == queue_.front().bytes->size()) {
    queued_bytes_ -= queue_.front().cost();
    queue_.pop_front();
    sent_bytes_ = 0;
  }
  write();
}

void WebSocketConnection::begin_close(std::uint16_t code, std::string_view reason, Queued queued) {
  if (queued == Queued::dropped) queue_.clear();
  if (!closing_) {
    const std::string_view cut = cut_reason(reason);
    reason_ = websocket::close_reason(websocket::close_code(code), {cut.data(), cut.size()});
    set_deadline(ServerClock::now() + std::min(kCloseLimit, core_->options.stall_limit));
  }
  open_ = false;
  closing_ = true;
  write();
}

void WebSocketConnection::stop() {
  if (opened_)
    begin_close(1001, "server shutting down", Queued::dropped);
  else
    abort();
}

void WebSocketConnection::send_close() {
  close_sent_ = true;
  stream_->async_close(reason_, [self = shared_from_this()](ErrorCode) { self->abort(); });
}

void WebSocketConnection::abort() {
  if (ended_) return;
  ended_ = true;
  open_ = false;
  const auto self = shared_from_this();
  core_->connections.erase(self);
  ErrorCode ignored;
  stream_->next_layer().close(ignored);
  stream_.reset();
  queue_.clear();
  if (!opened_) return;
  try {
    core_->live.closed(self);
  } catch (...) {
    // The connection is closed already.
  }
}

}  // namespace

void start_websocket(asio::ip::tcp::socket socket, const std::shared_ptr<ServerCore>& core,
                     Request request) {
  const auto connection =
      std::make_shared<WebSocketConnection>(std::move(socket), core, std::move(request));
  core->connections.insert(connection);
  connection->accept();
}

}  // namespace adasplats

#endif
