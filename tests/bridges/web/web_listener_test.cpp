// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/web_listener.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <random>

#include "bridges/web/web_server.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/bridges/web/web_server_fixture.hpp"

namespace {

using namespace web_server_fixture;

using bridges::WebError;
using bridges::WebOptions;
using bridges::WebServer;
using testing::HasSubstr;
using web_test::await;
using web_test::Client;
using web_test::Json;

TEST_F(WebServerTest, TakesTheNextPortIfOneIsTaken) {
  const WebServer first(options());
  WebOptions same = options();
  same.port = first.port();
  const WebServer second(same);
  EXPECT_GT(second.port(), first.port());
  same.port_tries = 1;
  EXPECT_THROW(WebServer{same}, WebError);
}

TEST_F(WebServerTest, InvalidOptionsAreErrors) {
  WebOptions bad = options();
  bad.token = "short";
  EXPECT_THROW(WebServer{bad}, WebError);
  bad = options();
  bad.origins = {"example.org"};
  EXPECT_THROW(WebServer{bad}, WebError);
  bad = options();
  bad.host = "no host";
  EXPECT_THROW(WebServer{bad}, WebError);
  bad = options();
  bad.page_directory = "/no/such/folder";
  EXPECT_THROW(WebServer{bad}, WebError);
}

TEST_F(WebServerTest, AFrozenPageDoesNotDelayOthers) {
  WebServer server(options());
  server.retain("hello", R"({"op":"hello"})");
  constexpr int small_buffer = 4096;
  Client frozen = page_of(server, token, small_buffer);
  Client reader = page_of(server);
  const std::string large = R"({"op":"events","items":[")" + std::string(std::size_t{1} << 20, 'x') + R"("]})";
  for (int i = 0; i < 30; ++i) {
    server.send_text(large);
    EXPECT_EQ(reader.read_frame()->payload.size(), large.size());
  }
  // 30 MiB were sent; 8 MiB wait, one message and the buffers of the kernel are on their way.
  EXPECT_EQ(frozen.read_json()["op"], "events");
  const Json second = frozen.read_json();
  EXPECT_EQ(second["op"], "dropped");
  EXPECT_GE(second["count"], 20);
  EXPECT_LE(second["count"], 23);
}

TEST_F(WebServerTest, InvalidFramesCloseTheConnection) {
  WebServer server(options());
  server.retain("hello", R"({"op":"hello"})");
  const auto close_code_after = [&](const auto& send) {
    Client page = page_of(server);
    send(page);
    const auto frame = page.read_frame();
    EXPECT_TRUE(page.is_closed());
    return frame ? frame->close_code() : 0;
  };
  EXPECT_EQ(close_code_after([](Client& page) { page.send_frame(1, "{}", false); }), 1002);  // no mask
  EXPECT_EQ(close_code_after([](Client& page) { page.send_frame(3, "{}"); }), 1002);         // reserved opcode
  EXPECT_EQ(close_code_after([](Client& page) { page.send_frame(9, std::string(126, 'x')); }), 1002);  // long ping
  EXPECT_EQ(close_code_after([](Client& page) { page.send_frame(1, "\xff"); }), 1007);                 // no UTF-8
  EXPECT_EQ(close_code_after([](Client& page) { page.send_frame(1, std::string(65'537, ' ')); }), 1009);
  EXPECT_TRUE(await([&] { return server.clients() == 0; }));
}

TEST_F(WebServerTest, TheNumberOfClientsWithoutTheTokenIsLimited) {
  WebOptions two = options();
  two.max_clients = 2;
  WebServer server(two);
  server.retain("hello", R"({"op":"hello"})");
  Client first = page_of(server, ""), second = page_of(server, "");
  Client third = page_of(server, "");
  const auto frame = third.read_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->close_code(), 1008);
  EXPECT_THAT(frame->payload, HasSubstr("the limit of 2 clients is reached"));
  third.reset();                          // else the server waits ten seconds for its goodbye
  Client owner = page_of(server, token);  // those who may control get in
  second.reset();
  EXPECT_TRUE(await([&] { return server.clients() == 2; }));
  Client fourth = page_of(server, "");
  EXPECT_TRUE(await([&] { return server.clients() == 3; }));
}

TEST_F(WebServerTest, ClientsThatDoNotGreetKeepNobodyOut) {
  WebOptions two = options();
  two.max_clients = 2;
  WebServer server(two);
  server.retain("hello", R"({"op":"hello"})");
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 30; ++i) {
    silent.push_back(std::make_unique<Client>(server.port()));
    EXPECT_EQ(silent.back()->upgrade().status, 101) << i;
  }
  Client owner = page_of(server, token), reader = page_of(server, "");
  EXPECT_EQ(server.clients(), 2);
}

TEST_F(WebServerTest, SurvivesRandomDisconnects) {
  WebServer server(options());
  server.retain("hello", R"({"op":"hello"})");
  std::atomic<bool> ends = false;
  std::thread simulation([&] {
    for (std::uint32_t sequence = 1; !ends; ++sequence) {
      server.send_state(state(sequence, 20'000));
      server.send_text("{\"op\":\"events\"}");
      server.retain("status", "{\"op\":\"status\"}");
      while (server.take_request()) {
      }
      std::this_thread::yield();
    }
  });
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    Client client(server.port());
    const auto stage = random() % 5;
    if (stage == 0) client.write("GET / HT");
    if (stage >= 1) client.upgrade();
    if (stage >= 2) client.send_json({{"op", "hello"}, {"token", token}});
    if (stage >= 3) client.read_frame();
    if (stage >= 4) client.write(std::string_view("\x81\xfe\x10", 3));  // half of a head
    if (random() % 2 == 0) client.reset();
  }
  EXPECT_TRUE(await([&] { return server.clients() == 0; }));
  Client last(server.port());
  EXPECT_EQ(last.get("/").status, 200);
  ends = true;
  simulation.join();
}

TEST_F(WebServerTest, EndsWithClientsInEveryStage) {
  auto server = std::make_unique<WebServer>(options());
  server->retain("hello", R"({"op":"hello"})");
  const std::uint16_t port = server->port();
  Client page = page_of(*server), frozen = page_of(*server, token, 4096);
  Client idle(port), half(port), silent(port);
  half.write("GET / HTTP/1.1\r\nHo");
  silent.upgrade();
  for (int i = 0; i < 8; ++i) server->send_text(std::string(std::size_t{1} << 20, ' '));
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(page.read_frame()->is_text());
  std::thread reader([&] { EXPECT_EQ(page.read_frame()->close_code(), 1001); });
  server.reset();
  reader.join();
  EXPECT_TRUE(idle.is_closed());
  EXPECT_TRUE(half.is_closed());
  EXPECT_THROW(Client{port}, std::runtime_error);
}

}  // namespace
