// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/serve/http_server.h"

#ifndef ADASPLATS_HAVE_BOOST

#include "adasplats/core/error.h"

namespace adasplats {

class HttpServer::Implementation {};

// NOLINTNEXTLINE(performance-unnecessary-value-param): as where there is Boost
HttpServer::HttpServer(HttpServerOptions, HttpHandler, WebSocketHandler&) {
  throw Error(ErrorKind::unavailable,
              "the local server needs Boost (Asio and Beast, 1.74 or later), which was not there "
              "when adasplats was built: install the package libboost-dev and build again");
}
HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const { return 0; }
std::string HttpServer::url() const { return {}; }
void HttpServer::run() {}
void HttpServer::stop() {}

bool has_http_server() { return false; }

}  // namespace adasplats

#endif
