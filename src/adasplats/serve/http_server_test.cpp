// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// HTTP over plain sockets; the oracle is RFC 9110 and 9112, and http_server.h.
#include "adasplats/serve/http_server.h"

#include <fcntl.h>
#include <sys/resource.h>

#include <csignal>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/serve/test_client.h"

namespace adasplats {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

using HttpServerTest = ServerTest;

std::string status_line(const std::string& reply) { return reply.substr(0, reply.find("\r\n")); }
std::string body(const std::string& reply) { return reply.substr(reply.find("\r\n\r\n") + 4); }
bool has_line(const std::string& reply, const std::string& line) {
  return reply.find(std::string("\r\n") + line + "\r\n") != std::string::npos;
}

/// Milliseconds until the other end closes.
double time_to_end(RawClient& client) {
  const auto start = Clock::now();
  client.take_all();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

TEST_F(HttpServerTest, AnswersGet) {
  start();
  EXPECT_EQ(server->url(),
            std::string("http://127.0.0.1:") + std::to_string(server->port()) + "/secret/");
  RawClient one = client();
  one.get("/secret/a%20b?x=1");
  const std::string reply = one.reply();
  EXPECT_EQ(status_line(reply), "HTTP/1.1 200 OK");
  EXPECT_TRUE(has_line(reply, "Content-Type: text/plain"));
  EXPECT_TRUE(has_line(reply, "Content-Length: 5"));
  EXPECT_EQ(body(reply), "found");
}

TEST_F(HttpServerTest, EveryResponseHasSafetyHeaders) {
  start();
  const std::string own = std::string("Host: ") + client().host() + "\r\n\r\n";
  for (const std::string& request : std::vector<std::string>{
           "GET /secret/ HTTP/1.1\r\n" + own, "GET / HTTP/1.1\r\n" + own,
           "PUT / HTTP/1.1\r\n" + own, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n",
           "nonsense\r\n\r\n"}) {
    RawClient one = client();
    one.send(request);
    const std::string reply = one.reply();
    for (const char* line :
         {"Cache-Control: no-store", "X-Content-Type-Options: nosniff", "X-Frame-Options: DENY",
          "Referrer-Policy: no-referrer", "Cross-Origin-Resource-Policy: same-origin"})
      EXPECT_TRUE(has_line(reply, line)) << reply;
    EXPECT_NE(reply.find("\r\nContent-Security-Policy: default-src 'self'; "), std::string::npos);
    EXPECT_EQ(reply.find("\r\nServer:"), std::string::npos);
  }
}

TEST_F(HttpServerTest, HeadHasTheHeadersOfGet) {
  start();
  RawClient one = client();
  one.get("/secret/a%20b", "", "HEAD");
  const std::string head = one.reply(true);
  one.get("/secret/a%20b");
  EXPECT_EQ(head + "found", one.reply());
}

TEST_F(HttpServerTest, ConnectionsAreReusedAndRequestsPipelined) {
  start();
  RawClient one = client();
  const std::string lines =
      std::string("GET /secret/a%20b HTTP/1.1\r\nHost: ") + one.host() + "\r\n";
  one.send(lines + "\r\n" + lines + "\r\n" + lines + "Connection: close\r\n\r\n");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(body(one.reply()), "found");
  EXPECT_TRUE(one.ended());
  RawClient old = client();
  old.send(std::string("GET /secret/a%20b HTTP/1.0\r\nHost: ") + old.host() + "\r\n\r\n");
  EXPECT_EQ(body(old.reply()), "found");
  EXPECT_TRUE(old.ended());
}

TEST_F(HttpServerTest, BytesMayComeOneByOne) {
  start();
  RawClient one = client();
  const std::string lines =
      std::string("GET /secret/ HTTP/1.1\r\nHost: ") + one.host() + "\r\n\r\n";
  for (const char byte : lines) one.send(std::string(1, byte));
  EXPECT_EQ(status_line(one.reply()), "HTTP/1.1 200 OK");
}

TEST_F(HttpServerTest, OtherMethodsAreRejected) {
  start();
  for (const char* method :
       {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "get", "BREW"}) {
    RawClient one = client();
    one.get("/secret/", "Content-Length: 5\r\n", method);
    one.send("12345");
    const std::string reply = one.reply();
    EXPECT_EQ(status_line(reply), "HTTP/1.1 405 Method Not Allowed") << method;
    EXPECT_TRUE(has_line(reply, "Allow: GET, HEAD"));
    EXPECT_TRUE(one.ended());
  }
}

TEST_F(HttpServerTest, UnknownPathsLookLikeAWrongToken) {
  start();
  RawClient one = client();
  one.get("/secret/nothing");
  const std::string unknown = one.reply();
  EXPECT_EQ(status_line(unknown), "HTTP/1.1 404 Not Found");
  for (const char* target :
       {"/", "/wrong!/", "/wrong!/a%20b", "/secret", "/secret/../secret/", "/secret/%2e%2e/x",
        "/secret/a\\b", "/secret/%", "//secret/", "/favicon.ico", "/SECRET/"}) {
    one.get(target);
    EXPECT_EQ(one.reply(), unknown) << target;
  }
}

TEST_F(HttpServerTest, MalformedRequestsAre400) {
  start();
  const std::string host = std::string("Host: ") + client().host() + "\r\n";
  for (const std::string& request : std::vector<std::string>{
           "\r\nnonsense\r\n\r\n", "GET\r\n\r\n", "GET /secret/\r\n\r\n",
           "GET /secret/ HTTP/2.0\r\n" + host + "\r\n", "GET /secret/ HTTP/1.1\r\n\r\n",
           "GET /secret/ HTTP/1.1\r\n" + host + host + "\r\n",
           "GET /secret/ HTTP/1.1\r\n" + host + "no colon\r\n\r\n",
           "GET /secret/ HTTP/1.1\r\n" + host + std::string("a: \0\r\n\r\n", 8),
           "GET http://" + client().host() + "/secret/ HTTP/1.1\r\n" + host + "\r\n",
           "GET secret/ HTTP/1.1\r\n" + host + "\r\n", "GET * HTTP/1.1\r\n" + host + "\r\n",
           "GET /secret/ HTTP/1.1\r\n" + host + "Content-Length: 3\r\n\r\nabc",
           "GET /secret/ HTTP/1.1\r\n" + host + "Content-Length: 99999999999999\r\n\r\n",
           "GET /secret/ HTTP/1.1\r\n" + host + "Content-Length: -1\r\n\r\n",
           "GET /secret/ HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
           "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", "\x16\x03\x01\x02\x01\r\n\r\n"}) {
    RawClient one = client();
    one.send(request);
    EXPECT_EQ(status_line(one.reply()), "HTTP/1.1 400 Bad Request") << request;
    EXPECT_TRUE(one.ended()) << request;
  }
}

TEST_F(HttpServerTest, ForeignHostsAreForbidden) {
  start();
  for (const char* host : {"evil.example", "localhost", "localhost:1", "192.168.1.1"}) {
    RawClient one = client();
    one.send(std::string("GET /secret/ HTTP/1.1\r\nHost: ") + host + "\r\n\r\n");
    EXPECT_EQ(status_line(one.reply()), "HTTP/1.1 403 Forbidden") << host;
  }
}

TEST_F(HttpServerTest, LongHeadersAreRejected) {
  start();
  const std::string longer(9000, 'a');
  RawClient fits = client();
  fits.get("/secret/", "A: " + longer.substr(0, 8000) + "\r\n");
  EXPECT_EQ(status_line(fits.reply()), "HTTP/1.1 200 OK");
  std::string lines;
  for (int i = 0; i < 1000; ++i) lines += "A: 12345\r\n";
  for (const auto& [target, header] : std::vector<std::pair<std::string, std::string>>{
           {"/secret/" + longer, ""}, {"/secret/", "A: " + longer + "\r\n"}, {"/secret/", lines}}) {
    RawClient one = client();
    one.get(target, header);
    EXPECT_EQ(status_line(one.reply()), "HTTP/1.1 431 Request Header Fields Too Large");
  }
  // A client that never ends the line.
  RawClient endless = client();
  for (int i = 0; i < 1000 && endless.send(longer); ++i) std::this_thread::sleep_for(100us);
  EXPECT_EQ(status_line(endless.reply()), "HTTP/1.1 431 Request Header Fields Too Large");
}

TEST_F(HttpServerTest, SlowHeadersEndTheConnection) {
  options.stall_limit = 100ms;
  start();
  RawClient silent = client();
  RawClient kept = client();
  kept.get("/secret/");
  kept.reply();
  RawClient slow = client();
  const auto begin = Clock::now();
  while (slow.send("G") && Clock::now() - begin < 20s) std::this_thread::sleep_for(10ms);
  EXPECT_LT(Clock::now() - begin, 10s);
  EXPECT_TRUE(silent.ended());
  EXPECT_TRUE(kept.ended());
}

TEST_F(HttpServerTest, AStalledDownloadIsClosed) {
  options.stall_limit = 100ms;
  const auto big = std::make_shared<const std::string>(std::size_t{32} << 20, 'x');
  get = [&](std::string_view) { return HttpReply{200, "text/plain", big}; };
  start();
  RawClient stalled(server->port(), 4096);
  stalled.get("/secret/");
  ASSERT_TRUE(soon([&] { return big.use_count() > 1; }));
  EXPECT_TRUE(soon([&] { return big.use_count() == 1; }));
  EXPECT_LT(stalled.take_all().size(), big->size());
}

TEST_F(HttpServerTest, ASlowDownloadIsCompleted) {
  options.stall_limit = 1s;
  const auto big = std::make_shared<const std::string>(std::size_t{24} << 20, 'x');
  get = [&](std::string_view) { return HttpReply{200, "text/plain", big}; };
  start();
  RawClient slow = client();
  slow.get("/secret/");
  std::size_t count = 0;
  for (int i = 0; i < 12; ++i) {
    std::this_thread::sleep_for(100ms);
    count += slow.take(std::size_t{2} << 20).size();
  }
  EXPECT_EQ(count, big->size());
}

TEST_F(HttpServerTest, ABodyIsNotCopiedForEachClient) {
  const auto big = std::make_shared<const std::string>(std::size_t{32} << 20, 'x');
  get = [&](std::string_view) { return HttpReply{200, "text/plain", big}; };
  start();
  const std::size_t before = resident_kb();
  std::deque<RawClient> clients;
  for (int i = 0; i < 20; ++i) {
    clients.push_back(client());
    clients.back().get("/secret/");
  }
  ASSERT_TRUE(soon([&] { return big.use_count() == 21; }));
  EXPECT_LT(resident_kb(), before + 8192 + kSanitizerKb);
  clients.clear();
  EXPECT_TRUE(soon([&] { return big.use_count() == 1; }));
}

TEST_F(HttpServerTest, TwentyClientsAtOnce) {
  start();
  std::atomic<int> good = 0;
  std::deque<std::thread> threads;
  for (int i = 0; i < 20; ++i)
    threads.emplace_back([&] {
      RawClient one = client();
      for (int k = 0; k < 20; ++k) {
        one.get("/secret/a%20b");
        good += body(one.reply()) == "found";
      }
    });
  for (std::thread& each : threads) each.join();
  EXPECT_EQ(good, 400);
}

TEST_F(HttpServerTest, ConnectionsBeyondTheLimitGet503) {
  options.connections_limit = 2;
  start();
  RawClient first = client();
  first.get("/secret/");
  first.reply();
  {
    RawClient second = client();
    second.get("/secret/");
    EXPECT_EQ(status_line(second.reply()), "HTTP/1.1 200 OK");
    RawClient third = client();
    third.get("/secret/");
    EXPECT_EQ(status_line(third.reply()), "HTTP/1.1 503 Service Unavailable");
    EXPECT_TRUE(third.ended());
  }
  EXPECT_TRUE(soon([&] {
    RawClient again = client();
    again.get("/secret/");
    return status_line(again.reply()) == "HTTP/1.1 200 OK";
  }));
}

TEST_F(HttpServerTest, ConnectionsWithoutTheTokenLockNobodyOut) {
  options.connections_limit = 3;
  start();
  RawClient user = client();
  user.get("/secret/");
  user.reply();
  std::deque<RawClient> crowd;
  for (int i = 0; i < 40; ++i) {
    crowd.push_back(client());
    if (i % 3 == 1) crowd.back().send("GET /secret/");  // and never the rest
    if (i % 3 == 2) {
      crowd.back().get("/wrong!/");
      crowd.back().reply();
    }
    RawClient next = client();
    next.get("/secret/", "Connection: close\r\n");
    EXPECT_EQ(status_line(next.reply()), "HTTP/1.1 200 OK") << i;
  }
  EXPECT_TRUE(crowd.front().ended());  // the oldest was closed
  user.get("/secret/");
  EXPECT_EQ(status_line(user.reply()), "HTTP/1.1 200 OK");
}

TEST_F(HttpServerTest, AHandlerThatThrowsIs500) {
  get = [](std::string_view path) -> HttpReply {
    if (path == "1") throw std::runtime_error("private words");
    if (path == "2") throw 2;
    return {200, "text/plain", nullptr};
  };
  start();
  RawClient one = client();
  for (const char* target : {"/secret/1", "/secret/2"}) {
    one.get(target);
    const std::string reply = one.reply();
    EXPECT_EQ(status_line(reply), "HTTP/1.1 500 Internal Server Error");
    EXPECT_EQ(reply.find("private"), std::string::npos);
  }
  one.get("/secret/3");
  EXPECT_EQ(status_line(one.reply()), "HTTP/1.1 200 OK");
}

TEST_F(HttpServerTest, AThousandConnectionsLeakNothing) {
  start();
  const auto round = [&](int count) {
    for (int i = 0; i < count; ++i) {
      RawClient one = client();
      if (i % 4 != 0) one.get(i % 4 == 1 ? "/secret/" : "/nothing", "Connection: close\r\n");
      if (i % 4 == 1) one.take_all();
      if (i % 4 == 3) one.reset();
    }
  };
  round(100);
  const std::size_t before = open_descriptors();
  const std::size_t memory = resident_kb();
  round(1000);
  EXPECT_TRUE(soon([&] { return open_descriptors() <= before; }))
      << open_descriptors() << " " << before;
  EXPECT_LT(resident_kb(), memory + 1024 + kSanitizerKb);
}

TEST_F(HttpServerTest, ContinuesAfterRunningOutOfDescriptors) {
  start();
  RawClient before = client();
  before.get("/secret/");
  before.reply();
  rlimit old{};
  getrlimit(RLIMIT_NOFILE, &old);
  const int next = ::dup(0);
  ::close(next);
  // The client's socket takes the last descriptor, so the server cannot accept it.
  const rlimit low{static_cast<rlim_t>(next) + 1, old.rlim_max};
  setrlimit(RLIMIT_NOFILE, &low);
  RawClient one = client();
  one.get("/secret/");
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::this_thread::sleep_for(150ms);
  rusage later{};
  getrusage(RUSAGE_SELF, &later);
  setrlimit(RLIMIT_NOFILE, &old);
  EXPECT_EQ(status_line(one.reply()), "HTTP/1.1 200 OK");
  const auto microseconds = [](const rusage& of) {
    return 1'000'000 * (of.ru_utime.tv_sec + of.ru_stime.tv_sec) + of.ru_utime.tv_usec +
           of.ru_stime.tv_usec;
  };
  EXPECT_LT(microseconds(later) - microseconds(usage), 50'000);
}

TEST_F(HttpServerTest, InvalidAddressesAndTokensAreErrors) {
  start();
  RecordingHandler nobody;
  const auto kind_of = [&](const std::string& address, std::uint16_t port) -> ErrorKind {
    try {
      HttpServer({address, port, "secret"}, get, nobody);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::software;
  };
  EXPECT_EQ(kind_of("127.0.0.1", server->port()), ErrorKind::unavailable);
  EXPECT_EQ(kind_of("192.0.2.1", 0), ErrorKind::unavailable);  // for documentation (RFC 5737)
  EXPECT_EQ(kind_of("localhost", 0), ErrorKind::usage);
  EXPECT_EQ(kind_of("", 0), ErrorKind::usage);
  EXPECT_THROW(HttpServer(HttpServerOptions{}, get, nobody), std::logic_error);
  for (const char* token : {"a/b", "a b", "a%20", "..", "\u00e4", "a?"})
    EXPECT_THROW(HttpServer({"127.0.0.1", 0, token}, get, nobody), Error) << token;
}

TEST_F(HttpServerTest, StopsWithClientsConnected) {
  start();
  std::deque<RawClient> clients;
  for (int i = 0; i < 10; ++i) clients.push_back(client());
  clients[0].get("/secret/");
  clients[0].reply();
  clients[1].send("GET /sec");
  const auto begin = Clock::now();
  stop();
  EXPECT_LT(Clock::now() - begin, 1s);
  for (RawClient& each : clients) EXPECT_TRUE(each.ended());
  EXPECT_LT(time_to_end(clients[2]), 100);
}

TEST_F(HttpServerTest, StopBeforeRunIsNotLost) {
  server = std::make_unique<HttpServer>(
      HttpServerOptions{"127.0.0.1", 0, "secret"}, [](auto) { return HttpReply{}; }, live);
  server->stop();
  server->run();
}

HttpServer* signalled = nullptr;

TEST_F(HttpServerTest, ASignalHandlerMayStopIt) {
  start();
  signalled = server.get();
  const auto old = std::signal(SIGUSR1, [](int) { signalled->stop(); });
  std::raise(SIGUSR1);
  running.join();
  std::signal(SIGUSR1, old);
}

}  // namespace
}  // namespace adasplats
