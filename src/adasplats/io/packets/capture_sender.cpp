// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/packets/capture_sender.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using SendClock = std::chrono::steady_clock;

/// In network order.
std::uint32_t address_of_host(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int problem = getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (problem != 0 || found == nullptr)
    throw Error(ErrorKind::no_input, "unknown host '" + host + "': " + gai_strerror(problem));
  sockaddr_in address{};
  std::copy_n(reinterpret_cast<const char*>(found->ai_addr), sizeof address,
              reinterpret_cast<char*>(&address));
  freeaddrinfo(found);
  return address.sin_addr.s_addr;
}

}  // namespace

DatagramSender::DatagramSender(std::string host)
    : host_(std::move(host)), address_(address_of_host(host_)) {
  descriptor_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor_ < 0) throw system_error(ErrorKind::io, host_, "no socket", errno);
  const int yes = 1;
  setsockopt(descriptor_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
}

DatagramSender::~DatagramSender() {
  if (descriptor_ >= 0) close(descriptor_);
}

void DatagramSender::send(std::string_view bytes, std::uint16_t port, WhenFull full) {
  const int flags = MSG_NOSIGNAL | (full == WhenFull::fail ? MSG_DONTWAIT : 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = address_;
  address.sin_port = htons(port);
  ssize_t sent = -1;
  do {
    sent = sendto(descriptor_, bytes.data(), bytes.size(), flags,
                  reinterpret_cast<const sockaddr*>(&address), sizeof address);
  } while (sent < 0 && errno == EINTR);
  if (sent < 0)
    throw system_error(ErrorKind::io, host_ + ":" + std::to_string(port),
                       std::to_string(bytes.size()) + " bytes cannot be sent", errno);
}

void set_destination(const std::string& text, SendOptions& options) {
  const std::size_t colon = text.rfind(':');
  options.host = text.substr(0, colon);
  options.port = 0;
  if (colon != std::string::npos) {
    const auto port = parse_number<std::uint16_t>(std::string_view(text).substr(colon + 1));
    if (!port || *port == 0)
      throw Error(ErrorKind::usage, "'" + text +
                                        "' is not HOST or HOST:PORT, with a port from 1 to "
                                        "65535");
    options.port = *port;
  }
  if (options.host.empty())
    throw Error(ErrorKind::usage, "'" + text + "' is not HOST or HOST:PORT");
}

SendResult send_capture(const std::filesystem::path& path, const SendOptions& options,
                        FunctionRef<void(std::uint64_t)> waited) {
  constexpr auto kLongestWait = std::chrono::milliseconds(100);
  constexpr double kNanosecondsOfSecond = 1e9;
  DatagramReader reader(path);
  DatagramSender socket(options.host);
  SendResult result;
  const SendClock::time_point begin = SendClock::now();
  const auto since_begin_s = [&] {
    return std::chrono::duration<double>(SendClock::now() - begin).count();
  };
  std::uint64_t first_ns = 0;
  while (const auto datagram = reader.next()) {
    if (options.only_port != 0 && datagram->to_port != options.only_port) continue;
    if (result.datagrams == 0) first_ns = datagram->time_ns;
    const double captured_s =
        datagram->time_ns < first_ns
            ? 0
            : static_cast<double>(datagram->time_ns - first_ns) / kNanosecondsOfSecond;
    const double due_s = options.speed > 0 ? captured_s / options.speed : 0;
    waited(result.datagrams);
    for (double left_s = due_s - since_begin_s(); left_s > 0; left_s = due_s - since_begin_s()) {
      const std::chrono::duration<double> wait(left_s);
      std::this_thread::sleep_for(std::min<std::chrono::duration<double>>(wait, kLongestWait));
      waited(result.datagrams);
    }
    if (options.speed > 0) result.latest_s = std::max(result.latest_s, since_begin_s() - due_s);
    socket.send(datagram->payload, options.port != 0 ? options.port : datagram->to_port);
    ++result.datagrams;
    result.bytes += datagram->payload.size();
  }
  result.seconds = since_begin_s();
  result.counts = reader.counts();
  if (result.datagrams == 0)
    throw Error(
        ErrorKind::data,
        path.string() + ": contains no UDP datagram" +
            (options.only_port != 0 ? " to port " + std::to_string(options.only_port) : ""));
  return result;
}

}  // namespace adasplats
