// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Servers that take POST and DELETE; the oracle is RFC 9110 and http_server.h.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "adasplats/serve/test_client.h"

namespace adasplats {
namespace {

class HttpActionsTest : public ServerTest {
 protected:
  void start_actions() {
    const HttpActions act = [this](HttpRequest request, HttpAnswer answer) {
      if (request.path == "later") {
        waiting = std::move(answer);
        ++later;
        return;
      }
      if (request.path == "throws") throw std::runtime_error("no");
      const std::string text = request.method + " " + request.path + " " + request.body;
      answer({200, "text/plain", std::make_shared<const std::string>(text)});
      answer({500, "text/plain", nullptr});  // does nothing
    };
    server = std::make_unique<HttpServer>(options, act, live);
    running = std::thread([this] { server->run(); });
  }
  std::string ask(RawClient& one, std::string_view method, std::string_view target,
                  const std::string& body, std::string_view lines = {}) {
    one.get(target, "Content-Length: " + std::to_string(body.size()) + "\r\n" + std::string(lines),
            method);
    one.send(body);
    return one.reply();
  }

  /// Until so many requests wait for `waiting`.
  void wait_for_later(int count) const {
    while (later < count) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  HttpAnswer waiting;
  std::atomic<int> later = 0;
};

std::string status_of(const std::string& reply) { return reply.substr(9, 3); }
std::string body_of(const std::string& reply) { return reply.substr(reply.find("\r\n\r\n") + 4); }

TEST_F(HttpActionsTest, HaveMethodPathAndBody) {
  start_actions();
  RawClient one = client();
  EXPECT_EQ(body_of(ask(one, "POST", "/secret/a%20b?x=1", "{\"y\": 2}")), "POST a b {\"y\": 2}");
  EXPECT_EQ(body_of(ask(one, "POST", "/secret/none", "")), "POST none ");
  one.get("/secret/c", "", "DELETE");
  EXPECT_EQ(body_of(one.reply()), "DELETE c ");
  one.get("/secret/d");
  EXPECT_EQ(body_of(one.reply()), "GET d ");
  one.get("/secret/d", "", "HEAD");
  EXPECT_EQ(status_of(one.reply(true)), "200");
  EXPECT_EQ(status_of(ask(one, "POST", "/secret/throws", "")), "500");
}

TEST_F(HttpActionsTest, AnswersMayComeLaterFromAnotherThread) {
  start_actions();
  RawClient one = client();
  one.get("/secret/later", "Content-Length: 0\r\n", "POST");
  RawClient other = client();
  EXPECT_EQ(body_of(ask(other, "POST", "/secret/now", "")), "POST now ");  // the server goes on
  wait_for_later(1);
  std::thread([this] {
    waiting({200, "text/plain", std::make_shared<const std::string>("at last")});
  }).join();
  EXPECT_EQ(body_of(one.reply()), "at last");
  // An answer to a client that has gone does nothing.
  one.get("/secret/later", "Content-Length: 0\r\n", "POST");
  wait_for_later(2);
  one.reset();
  waiting({200, "text/plain", nullptr});
  EXPECT_EQ(body_of(ask(other, "POST", "/secret/now", "")), "POST now ");
}

TEST_F(HttpActionsTest, RejectsBadBodiesAndOrigins) {
  options.message_bytes_limit = 100;
  options.allowed_origins = {"https://tool.example"};
  start_actions();
  const auto status = [this](std::string_view method, const std::string& body,
                             std::string_view lines) {
    RawClient one = client();
    return status_of(ask(one, method, "/secret/x", body, lines));
  };
  EXPECT_EQ(status("POST", std::string(100, 'x'), ""), "200");
  EXPECT_EQ(status("POST", std::string(101, 'x'), ""), "413");
  EXPECT_EQ(status("POST", std::string(3 << 20, 'x'), ""), "413");
  EXPECT_EQ(status("DELETE", "body", ""), "400");
  EXPECT_EQ(status("GET", "body", ""), "400");
  EXPECT_EQ(status("PUT", "body", ""), "405");
  EXPECT_EQ(status("POST", "", "Origin: http://evil.example\r\n"), "403");
  EXPECT_EQ(status("DELETE", "", "Origin: http://evil.example\r\n"), "403");
  EXPECT_EQ(status("POST", "", "Origin: https://tool.example\r\n"), "200");
  RawClient one = client();
  EXPECT_EQ(status("POST", "", "Origin: http://" + one.host() + "\r\n"), "200");
  EXPECT_EQ(status("POST", "", "Origin: http://127.0.0.1:1\r\n"), "403");
  one.get("/secret/x", "Transfer-Encoding: chunked\r\n", "POST");
  EXPECT_EQ(status_of(one.reply()), "411");
}

TEST_F(HttpActionsTest, NamesTheSubprotocolToClientsThatOfferIt) {
  options.subprotocol = "messages.v1";
  start_actions();
  RawClient one(server->port());
  const std::string reply =
      one.upgrade("/secret/live", "Sec-WebSocket-Protocol: other, messages.v1\r\n");
  EXPECT_NE(reply.find("\r\nSec-WebSocket-Protocol: messages.v1\r\n"), std::string::npos) << reply;
  RawClient two(server->port());
  EXPECT_EQ(two.upgrade("/secret/live", "").find("Sec-WebSocket-Protocol"), std::string::npos);
}

}  // namespace
}  // namespace adasplats
