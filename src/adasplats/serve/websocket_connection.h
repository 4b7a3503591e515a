// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "adasplats/serve/connection.h"

namespace adasplats {

/// Answers a request for the WebSocket, and gives the handler what comes.
void start_websocket(boost::asio::ip::tcp::socket socket, const std::shared_ptr<ServerCore>& core,
                     boost::beast::http::request<boost::beast::http::empty_body> request);

}  // namespace adasplats
