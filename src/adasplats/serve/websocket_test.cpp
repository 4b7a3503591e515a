// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// WebSockets over plain sockets; the oracle is RFC 6455 and http_server.h.
#include <stdexcept>

#include "adasplats/serve/http_server.h"
#include "adasplats/serve/test_client.h"

namespace adasplats {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;
using Clock = std::chrono::steady_clock;
using Frame = RawClient::Frame;

class WebSocketTest : public ServerTest {
 protected:
  /// Waits until `count` peers were opened and each was closed once.
  bool all_closed_once(std::size_t count) {
    return soon([&] { return live.closings() == std::vector<int>(count, 1); });
  }
  /// The close code after a client has sent these bytes.
  int code_after(const std::string& bytes) {
    RawClient one = live_client();
    one.send(bytes);
    const Frame close = one.read_message();
    one.send(RawClient::frame(0x88, close.payload));
    EXPECT_TRUE(one.ended());
    return close.close_code();
  }
};

TEST_F(WebSocketTest, HandshakeAndEcho) {
  live.on_open = [](const auto& peer) { peer->send_text("hello"); };
  start();
  RawClient one = client();
  const std::string answer = one.upgrade("/secret/live");
  // The key and its answer of RFC 6455, 1.3.
  EXPECT_NE(answer.find("\r\nSec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"),
            std::string::npos);
  EXPECT_NE(answer.find("\r\nContent-Security-Policy: "), std::string::npos);
  EXPECT_EQ(answer.find("Beast"), std::string::npos);
  EXPECT_EQ(one.read_message().payload, "hello");
  for (const std::size_t size : {0, 1, 125, 126, 127, 5000, 16384}) {
    one.send_text(std::string(size, 'x'));
    const Frame echo = one.read_message();
    EXPECT_EQ(echo.opcode, 1);
    EXPECT_EQ(echo.payload, std::string(size, 'x'));
  }
}

TEST_F(WebSocketTest, FragmentsAndPings) {
  start();
  RawClient one = live_client();
  one.send(RawClient::frame(0x01, "a\xc3") + RawClient::frame(0x89, "ping") +
           RawClient::frame(0x00, "\xa4") + RawClient::frame(0x8a, "unasked") +
           RawClient::frame(0x80, ""));
  const Frame pong = one.read_frame();
  EXPECT_EQ(pong.opcode, 10);
  EXPECT_EQ(pong.payload, "ping");
  EXPECT_EQ(one.read_message().payload, "a\xc3\xa4");
}

TEST_F(WebSocketTest, NothingIsCompressed) {
  start();
  RawClient one = client();
  const std::string answer =
      one.upgrade("/secret/live", "Sec-WebSocket-Extensions: permessage-deflate\r\n");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 101 "));
  EXPECT_EQ(answer.find("permessage"), std::string::npos);
}

TEST_F(WebSocketTest, OtherOriginsAreForbidden) {
  start();
  const std::string port = std::to_string(server->port());
  const auto status = [&](const std::string& lines) {
    return client().upgrade("/secret/live", lines).substr(9, 3);
  };
  EXPECT_EQ(status("Origin: http://127.0.0.1:" + port + "\r\n"), "101");
  EXPECT_EQ(status(""), "101");
  for (const std::string& origin :
       {"http://evil.example"s, "null"s, ""s, "http://127.0.0.1"s, "http://localhost:" + port,
        "https://127.0.0.1:" + port, "http://127.0.0.1:" + port + ".evil.example"})
    EXPECT_EQ(status("Origin: " + origin + "\r\n"), "403") << origin;
  EXPECT_EQ(status("Origin: http://127.0.0.1:" + port + "\r\nOrigin: http://evil.example\r\n"),
            "403");
}

TEST_F(WebSocketTest, InvalidHandshakesAreRejected) {
  start();
  RawClient plain = client();
  plain.get("/secret/live");
  const std::string answer = plain.reply();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 426 "));
  EXPECT_NE(answer.find("\r\nUpgrade: websocket\r\n"), std::string::npos);
  EXPECT_TRUE(client().upgrade("/secret/").starts_with("HTTP/1.1 200 "));
  EXPECT_TRUE(client().upgrade("/wrong!/live").starts_with("HTTP/1.1 404 "));
  EXPECT_TRUE(client().upgrade("/secret/live/x").starts_with("HTTP/1.1 404 "));
  const std::string upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\n";
  for (const char* lines :
       {"Sec-WebSocket-Version: 12\r\nSec-WebSocket-Key: YQ==\r\n", "Sec-WebSocket-Version: 13\r\n",
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: \r\n"}) {
    RawClient one = client();
    one.get("/secret/live", upgrade + lines);
    EXPECT_EQ(one.reply().substr(9, 1), "4") << lines;
    EXPECT_TRUE(one.ended());
  }
  EXPECT_TRUE(live.closings().empty());
}

TEST_F(WebSocketTest, BadMessagesEndTheConnection) {
  start();
  using Raw = RawClient;
  const std::string big(16385, 'x');
  EXPECT_EQ(code_after(Raw::frame(0x81, big)), 1009);
  EXPECT_EQ(
      code_after(Raw::frame(0x01, big.substr(0, 16000)) + Raw::frame(0x80, big.substr(0, 385))),
      1009);
  EXPECT_EQ(code_after("\x81\xff\x40\x00\x00\x00\x00\x00\x00\x00"s + "abcd"), 1009);
  EXPECT_NE(code_after("\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff"s + "abcd"), 0);
  EXPECT_EQ(code_after(Raw::frame(0x82, "x")), 1003);
  EXPECT_EQ(code_after(Raw::frame(0x82, "")), 1003);
  EXPECT_EQ(code_after(Raw::frame(0x81, "\xff")), 1007);
  EXPECT_EQ(code_after(Raw::frame(0x81, "\xc3")), 1007);              // truncated
  EXPECT_EQ(code_after(Raw::frame(0x81, "\xed\xa0\x80")), 1007);      // a surrogate
  EXPECT_EQ(code_after(Raw::frame(0x81, "text", false)), 1002);       // not masked
  EXPECT_EQ(code_after(Raw::frame(0xc1, "text")), 1002);              // a reserved bit
  EXPECT_EQ(code_after(Raw::frame(0x83, "text")), 1002);              // no such opcode
  EXPECT_EQ(code_after(Raw::frame(0x8b, "")), 1002);                  // reserved opcode
  EXPECT_EQ(code_after(Raw::frame(0x09, "")), 1002);                  // a fragmented ping
  EXPECT_EQ(code_after(Raw::frame(0x89, big.substr(0, 126))), 1002);  // a long ping
  EXPECT_EQ(code_after(Raw::frame(0x80, "text")), 1002);              // a continuation of nothing
  EXPECT_EQ(code_after(Raw::frame(0x01, "a") + Raw::frame(0x81, "b")), 1002);
  EXPECT_EQ(code_after(Raw::frame(0x88, "x")), 1002);  // half a close code
  EXPECT_TRUE(all_closed_once(18));
}

TEST_F(WebSocketTest, AClientThatCloses) {
  start();
  EXPECT_EQ(code_after(RawClient::frame(0x88, "\x03\xe8ok")), 1000);
  RawClient one = live_client();
  one.send(RawClient::frame(0x88, ""));
  EXPECT_EQ(one.read_frame().opcode, 8);
  EXPECT_TRUE(one.ended());
  one.drop();
  EXPECT_TRUE(all_closed_once(2));
}

TEST_F(WebSocketTest, ClientsThatVanish) {
  live.on_open = [](const auto& peer) {
    peer->send_binary(std::make_shared<const std::string>(std::size_t{8} << 20, 'x'));
  };
  start();
  for (int i = 0; i < 20; ++i) {
    RawClient one = live_client();
    if (i % 3 == 0) one.reset();
    if (i % 3 == 1) one.send(RawClient::frame(0x01, "half a mess"));
  }
  EXPECT_TRUE(all_closed_once(20));
}

TEST_F(WebSocketTest, TheServerCloses) {
  options.stall_limit = 200ms;
  live.on_text = [](const auto& peer, std::string_view text) {
    peer->send_text("before");
    peer->close(4001, text);
    peer->close(4002, "again");
    peer->send_text("after");
  };
  start();
  const std::string reason = std::string(122, 'x') + "\u00e4 and more";
  for (const auto& [sent, heard] : {std::pair{"why"s, "why"s}, {reason, reason.substr(0, 122)}}) {
    RawClient one = live_client();
    one.send_text(sent);
    EXPECT_EQ(one.read_message().payload, "before");
    const Frame close = one.read_message();
    EXPECT_EQ(close.close_code(), 4001);
    EXPECT_EQ(close.payload.substr(2), heard);
    one.send(RawClient::frame(0x88, close.payload));
    EXPECT_TRUE(one.ended());
  }
  EXPECT_TRUE(all_closed_once(2));
  // A client that does not answer the close frame is closed, too.
  RawClient mute = live_client();
  mute.send_text("why");
  EXPECT_TRUE(all_closed_once(3));
}

TEST_F(WebSocketTest, HandlersThatThrow) {
  live.on_text = [](const auto&, std::string_view) { throw 1; };
  start();
  EXPECT_EQ(code_after(RawClient::frame(0x81, "x")), 1011);
  live.on_open = [](const auto&) { throw std::runtime_error("x"); };
  EXPECT_EQ(code_after(""), 1011);
  EXPECT_TRUE(all_closed_once(2));
}

TEST_F(WebSocketTest, AClientThatReadsNothingIsClosed) {
  options.stall_limit = 150ms;
  const auto big = std::make_shared<const std::string>(std::size_t{16} << 20, 'x');
  live.on_text = [&](const auto& peer, std::string_view) { peer->send_binary(big); };
  start();
  RawClient stalled = live_client({}, 4096);
  stalled.send_text("go");
  ASSERT_TRUE(soon([&] { return big.use_count() > 1; }));
  // The client sends all the time but does not read.
  EXPECT_TRUE(soon([&] { return !stalled.send(RawClient::frame(0x8a, "")); }));
  EXPECT_TRUE(all_closed_once(1));
  EXPECT_EQ(big.use_count(), 1);
}

TEST_F(WebSocketTest, ASilentClientGetsAPingAndIsClosed) {
  options.stall_limit = 1s;
  start();
  RawClient silent = live_client();
  RawClient alive = live_client();
  for (int i = 0; i < 3; ++i) {
    const Frame ping = alive.read_frame();
    EXPECT_EQ(ping.opcode, 9);
    alive.send(RawClient::frame(0x8a, ping.payload));
  }
  EXPECT_TRUE(soon([&] { return live.closings() == std::vector{1, 0}; }));
  EXPECT_EQ(silent.read_frame().opcode, 9);
  EXPECT_TRUE(silent.ended());
  alive.send_text("still here");
  EXPECT_EQ(alive.read_message().payload, "still here");
}

TEST_F(WebSocketTest, ASlowClientReceivesEverything) {
  options.stall_limit = 1s;
  const auto big = std::make_shared<const std::string>(std::size_t{24} << 20, 'x');
  live.on_text = [&](const auto& peer, std::string_view) { peer->send_binary(big); };
  start();
  RawClient slow = live_client();
  slow.send_text("go");
  std::size_t count = 0;
  for (int i = 0; i < 12; ++i) {
    std::this_thread::sleep_for(100ms);
    slow.send(RawClient::frame(0x8a, ""));
    count += slow.take(std::size_t{2} << 20).size();
  }
  EXPECT_EQ(count, std::size_t{24} << 20);
}

TEST_F(WebSocketTest, TheQueueHasALimit) {
  options.queued_bytes_limit = std::size_t{8} << 20;
  options.stall_limit = 400ms;
  const auto part = std::make_shared<const std::string>(std::size_t{1} << 20, 'x');
  live.on_text = [&](const auto& peer, std::string_view text) {
    for (int i = 0; i < (text == "few" ? 6 : 40); ++i) peer->send_binary(part);
  };
  start();
  RawClient one = live_client();
  // A part that was just read may still count as queued; six plus that one are within 8 MiB.
  for (int i = 0; i < 12; ++i) {
    if (i % 6 == 0) one.send_text("few");
    EXPECT_EQ(one.read_message().payload.size(), part->size());
  }
  EXPECT_EQ(live.closings(), std::vector{0});
  one.send_text("many");
  EXPECT_TRUE(all_closed_once(1));
  EXPECT_EQ(part.use_count(), 1);
  EXPECT_LT(one.take_all().size(), 9 * part->size());
}

TEST_F(WebSocketTest, EmptyMessagesFillTheQueue) {
  options.queued_bytes_limit = 1 << 20;
  options.stall_limit = 200ms;
  live.on_text = [](const auto& peer, std::string_view) {
    for (int i = 0; i < 100'000; ++i) peer->send_binary(nullptr);
  };
  start();
  RawClient one = live_client();
  one.send_text("go");
  EXPECT_TRUE(all_closed_once(1));
}

TEST_F(WebSocketTest, TwentyClientsAtOnce) {
  std::deque<SharedBytes> scans;
  for (int i = 0; i < 5; ++i)
    scans.push_back(std::make_shared<const std::string>(300'000 + i, static_cast<char>('a' + i)));
  live.on_text = [&](const auto& peer, std::string_view text) {
    peer->send_binary(scans.at(static_cast<std::size_t>(text[0] - '0')));
  };
  start();
  std::atomic<int> good = 0;
  std::deque<std::thread> threads;
  for (int i = 0; i < 20; ++i)
    threads.emplace_back([&] {
      RawClient one = live_client();
      for (std::size_t k = 0; k < scans.size(); ++k) one.send_text(std::to_string(k));
      for (const SharedBytes& scan : scans) {
        const Frame message = one.read_message();
        good += message.opcode == 2 && message.payload == *scan;
      }
    });
  for (std::thread& each : threads) each.join();
  EXPECT_EQ(good, 100);
  EXPECT_TRUE(all_closed_once(20));
}

TEST_F(WebSocketTest, AStalledClientDelaysNobody) {
  const auto big = std::make_shared<const std::string>(std::size_t{32} << 20, 'x');
  live.on_text = [&](const auto& peer, std::string_view text) {
    if (text == "big")
      peer->send_binary(big);
    else
      peer->send_text("quick");
  };
  start();
  RawClient stalled = live_client({}, 4096);
  stalled.send_text("big");
  RawClient other = live_client();
  const auto begin = Clock::now();
  for (int i = 0; i < 100; ++i) {
    other.send_text("x");
    EXPECT_EQ(other.read_message().payload, "quick");
  }
  EXPECT_LT(Clock::now() - begin, 500ms);
}

TEST_F(WebSocketTest, AnyThreadMaySend) {
  start();
  RawClient one = live_client();
  ASSERT_TRUE(soon([&] { return live.closings().size() == 1; }));
  const std::shared_ptr<WebSocketPeer> peer = live.peer(0);
  std::deque<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&, i] {
      for (int k = 0; k < 100; ++k) peer->send_text(std::to_string(1000 * i + k));
    });
  std::vector<int> next(4, 0);
  for (int i = 0; i < 400; ++i) {
    const int number = std::stoi(one.read_message().payload);
    EXPECT_EQ(next.at(static_cast<std::size_t>(number / 1000))++, number % 1000);
  }
  for (std::thread& each : threads) each.join();
  EXPECT_EQ(next, std::vector(4, 100));
}

TEST_F(WebSocketTest, StopClosesClientsAndPeersOutliveTheServer) {
  const auto big = std::make_shared<const std::string>(std::size_t{32} << 20, 'x');
  start();
  RawClient polite = live_client();
  RawClient mute = live_client();
  RawClient stalled = live_client({}, 4096);
  ASSERT_TRUE(soon([&] { return live.closings().size() == 3; }));
  live.peer(2)->send_binary(big);
  std::thread answering([&] {
    const Frame close = polite.read_message();
    EXPECT_EQ(close.close_code(), 1001);
    polite.send(RawClient::frame(0x88, close.payload));
    EXPECT_TRUE(polite.ended());
  });
  const auto begin = Clock::now();
  stop();
  EXPECT_LT(Clock::now() - begin, 1s);
  answering.join();
  EXPECT_EQ(live.closings(), (std::vector{1, 1, 1}));
  EXPECT_EQ(mute.read_message().close_code(), 1001);
  EXPECT_EQ(big.use_count(), 1);
  const std::shared_ptr<WebSocketPeer> peer = live.peer(0);
  live.forget();
  server.reset();
  peer->send_text("lost");
  peer->send_binary(big);
  peer->close(1000, "");
  EXPECT_EQ(big.use_count(), 1);
}

TEST_F(WebSocketTest, AThousandConnectionsLeakNothing) {
  start();
  const auto round = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      RawClient one = live_client();
      one.send_text("x");
      EXPECT_EQ(one.read_message().payload, "x");
      if (i % 2 == 0) {
        one.send(RawClient::frame(0x88, "\x03\xe8"));
        one.take_all();
      } else {
        one.reset();
      }
    }
    EXPECT_TRUE(all_closed_once(count));
    live.forget();
  };
  round(100);
  const std::size_t descriptors_before = open_descriptors();
  const std::size_t memory_before = resident_kb();
  for (int i = 0; i < 10; ++i) round(100);
  EXPECT_LE(open_descriptors(), descriptors_before);
  EXPECT_LT(resident_kb(), memory_before + 1024 + kSanitizerKb);
}

}  // namespace
}  // namespace adasplats
