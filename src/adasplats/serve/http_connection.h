// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/serve/connection.h"

namespace adasplats {

/// Answers the requests that come through a socket; where one asks for the WebSocket, that takes
/// the socket over. `refused`: the first request is answered with 503, as the server is full.
void start_http(boost::asio::ip::tcp::socket socket, const std::shared_ptr<ServerCore>& core,
                bool refused);

}  // namespace adasplats
