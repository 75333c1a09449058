// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/web_server.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <random>

#include "tests/bridges/web/web_client.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using bridges::WebError;
using bridges::WebOptions;
using bridges::WebServer;
using testing::HasSubstr;
using web_test::Answer;
using web_test::await;
using web_test::Client;
using web_test::Json;

const std::string token = "0123456789abcdef";

/// A folder with a page of three files.
class PageFolder {
 public:
  PageFolder() {
    write("index.html", "<!doctype html><title>test</title>");
    std::filesystem::create_directory(folder_.file("vendor"));
    write("vendor/large.js", std::string(20'000, 'x'));
    write("LICENSE", "text");
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.file(name)) << text; }
  std::string path() const { return folder_.file(""); }

 private:
  test_support::ScratchFolder folder_;
};

class WebServerTest : public testing::Test {
 protected:
  WebOptions options() const {
    WebOptions options;
    options.port = 0;
    options.token = token;
    options.page_directory = page_.path();
    return options;
  }
  /// A page that has said hello and got the retained `hello`.
  static Client page_of(WebServer& server, const std::string& with = token, int receive_bytes = 0) {
    Client client(server.port(), false, receive_bytes);
    EXPECT_EQ(client.upgrade().status, 101);
    client.send_json({{"op", "hello"}, {"token", with}});
    EXPECT_EQ(client.read_json()["op"], "hello");
    return client;
  }
  static std::vector<std::byte> state(std::uint32_t sequence, std::size_t size = 52) {
    std::vector<std::byte> bytes(size);
    bytes[0] = std::byte{1};
    for (std::size_t i = 0; i < 4; ++i) bytes[4 + i] = static_cast<std::byte>(sequence >> (8 * i) & 255);
    return bytes;
  }

  PageFolder page_;
};

TEST_F(WebServerTest, ItsUrlAnswersWithThePage) {
  WebServer server(options());
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + std::to_string(server.port()) + "/#t=" + token);
  for (const bool ipv6 : {false, true}) {
    if (ipv6 && !std::filesystem::exists("/proc/net/if_inet6")) continue;
    Client client(server.port(), ipv6);
    const Answer answer = client.get("/");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, "<!doctype html><title>test</title>");
    EXPECT_EQ(answer.headers.at("content-type"), "text/html; charset=utf-8");
  }
}

TEST_F(WebServerTest, EveryAnswerHasTheHeadersThatKeepOtherSitesOut) {
  WebServer server(options());
  Client client(server.port());
  for (const char* target : {"/", "/none", "/LICENSE"}) {
    const Answer answer = client.get(target);
    EXPECT_THAT(answer.headers.at("content-security-policy"), HasSubstr("default-src 'self'; connect-src 'self'"));
    EXPECT_THAT(answer.headers.at("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
    EXPECT_EQ(answer.headers.at("cross-origin-resource-policy"), "same-origin");
    EXPECT_FALSE(answer.headers.contains("access-control-allow-origin"));
  }
}

TEST_F(WebServerTest, FilesComeCompressedAndOnlyWhenTheyHaveChanged) {
  WebServer server(options());
  Client client(server.port());
  const Answer plain = client.get("/vendor/large.js");
  EXPECT_EQ(plain.body.size(), 20'000u);
  EXPECT_EQ(plain.headers.at("content-type"), "text/javascript; charset=utf-8");
  const Answer small = client.get("/vendor/large.js", "Accept-Encoding: gzip, br\r\n");
  EXPECT_EQ(small.headers.at("content-encoding"), "gzip");
  EXPECT_LT(small.body.size(), 100u);
  const Answer again = client.get("/vendor/large.js", "If-None-Match: " + plain.headers.at("etag") + "\r\n");
  EXPECT_EQ(again.status, 304);
  const Answer head = client.request("HEAD /vendor/large.js HTTP/1.1\r\nHost: localhost\r\n\r\n", false);
  EXPECT_EQ(head.headers.at("content-length"), "20000");
  EXPECT_EQ(client.get("/").status, 200);  // no body came with HEAD
}

TEST_F(WebServerTest, OtherPathsAndMethodsAreRefused) {
  WebServer server(options());
  Client client(server.port());
  EXPECT_EQ(client.get("/favicon.ico").status, 204);
  for (const char* target : {"/none", "/../LICENSE", "/vendor/../LICENSE", "/%2e%2e/LICENSE", "/vendor", "/asset/1"})
    EXPECT_EQ(client.get(target).status, 404) << target;
  EXPECT_EQ(client.request("DELETE / HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 405);
  EXPECT_EQ(Client(server.port()).request("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc").status,
            413);
  EXPECT_EQ(Client(server.port()).request("nonsense\r\n\r\n").status, 400);
  EXPECT_EQ(Client(server.port()).get("/", "X: " + std::string(20'000, 'x') + "\r\n").status, 431);
}

TEST_F(WebServerTest, AReloadShowsTheFilesOfAFolder) {
  WebServer server(options());
  page_.write("index.html", "new");
  EXPECT_EQ(Client(server.port()).get("/").body, "new");
}

TEST_F(WebServerTest, WithoutAFolderItServesThePageInTheProgram) {
  WebOptions embedded = options();
  embedded.page_directory = "";
  WebServer server(embedded);
  const Answer answer = Client(server.port()).get("/");
  EXPECT_EQ(answer.status, 200);
  EXPECT_THAT(answer.body, HasSubstr("<title>Shoal</title>"));
}

TEST_F(WebServerTest, AssetsAreServedByTheirHash) {
  WebServer server(options());
  const std::vector<std::byte> bytes(1000, std::byte{7});
  server.set_asset(0xabc, bytes);
  EXPECT_EQ(bridges::asset_name(0xabc), "0000000000000abc");
  Client client(server.port());
  const Answer answer = client.get("/asset/0000000000000abc");
  EXPECT_EQ(answer.body, std::string(1000, '\7'));
  EXPECT_THAT(answer.headers.at("cache-control"), HasSubstr("immutable"));
  server.clear_assets();
  EXPECT_EQ(client.get("/asset/0000000000000abc").status, 404);
}

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

TEST_F(WebServerTest, TokensAreRandom) {
  WebOptions random = options();
  random.token = "";
  const WebServer first(random), second(random);
  const auto token_of = [](const WebServer& server) { return server.url().substr(server.url().find("#t=") + 3); };
  EXPECT_EQ(token_of(first).size(), 32u);
  EXPECT_NE(token_of(first), token_of(second));
}

TEST_F(WebServerTest, HostsAndOriginsOfOthersAreForbidden) {
  WebServer server(options());
  const std::string view = "Sec-WebSocket-Protocol: shoal.view.v1\r\n";
  EXPECT_EQ(Client(server.port()).get("/", "", "evil.example.org").status, 403);
  EXPECT_EQ(Client(server.port()).get("/", "Host: localhost\r\n").status, 403);
  EXPECT_EQ(Client(server.port()).request("GET / HTTP/1.0\r\n\r\n").status, 403);
  EXPECT_EQ(Client(server.port()).upgrade(view, "evil.example.org").status, 403);
  EXPECT_EQ(Client(server.port()).upgrade(view + "Origin: http://evil.example.org\r\n").status, 403);
  EXPECT_EQ(Client(server.port()).upgrade(view + "Origin: null\r\n").status, 403);
  EXPECT_EQ(Client(server.port()).upgrade(view + "Origin: file://\r\nOrigin: http://evil.example.org\r\n").status, 403);
  EXPECT_EQ(Client(server.port()).upgrade(view + "Origin: file://\r\n").status, 101);
  EXPECT_EQ(Client(server.port()).upgrade(view + "Origin: https://app.foxglove.dev\r\n").status, 101);
  EXPECT_EQ(Client(server.port()).upgrade(view).status, 101);
}

TEST_F(WebServerTest, AnotherSubprotocolIsRefusedWithTheKnownOnes) {
  WebServer server(options());
  for (const char* header : {"", "Sec-WebSocket-Protocol: other.v1\r\n"}) {
    const Answer answer = Client(server.port()).upgrade(header);
    EXPECT_EQ(answer.status, 400);
    EXPECT_THAT(answer.body, HasSubstr("must be one of: shoal.view.v1"));
  }
  const Answer answer = Client(server.port()).upgrade("Sec-WebSocket-Protocol: other.v1, shoal.view.v1\r\n");
  EXPECT_EQ(answer.headers.at("sec-websocket-protocol"), "shoal.view.v1");
}

TEST_F(WebServerTest, APageWithTheTokenSteersAndGetsReplies) {
  WebServer server(options());
  server.retain("hello", R"({"op":"hello","version":1})");
  server.retain("scene", R"({"op":"scene","revision":1})");
  Client client(server.port());
  ASSERT_EQ(client.upgrade().status, 101);
  client.send_json({{"op", "hello"}, {"token", token}});
  EXPECT_EQ(client.read_json(), Json({{"op", "hello"}, {"version", 1}, {"control", true}}));
  EXPECT_EQ(client.read_json()["op"], "scene");
  EXPECT_EQ(server.clients(), 1);

  client.send_json({{"op", "control"}, {"id", 1}, {"command", "pause"}});
  std::optional<bridges::ViewRequest> request;
  ASSERT_TRUE(await([&] { return (request = server.take_request()).has_value(); }));
  EXPECT_TRUE(request->may_control);
  server.reply(request->client, R"({"op":"reply","id":1,"ok":true})");
  EXPECT_EQ(client.read_json()["ok"], true);

  server.send_state(state(0x01020304));
  const auto frame = client.read_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 2);
  EXPECT_EQ(frame->payload.substr(4, 4), "\x04\x03\x02\x01");

  client.send_frame(8, std::string("\x03\xe8", 2));
  ASSERT_TRUE(await([&] { return (request = server.take_request()).has_value(); }));
  EXPECT_EQ(request->op, "left");
  EXPECT_EQ(server.clients(), 0);
}

TEST_F(WebServerTest, APageWithAnotherTokenIsReadOnly) {
  WebServer server(options());
  server.retain("hello", R"({"op":"hello"})");
  Client client(server.port());
  client.upgrade();
  client.send_json({{"op", "hello"}, {"token", "0123456789abcdee"}});
  EXPECT_EQ(client.read_json()["control"], false);
  EXPECT_EQ(client.read_json()["op"], "error");
  client.send_json({{"op", "control"}, {"id", 1}, {"command", "quit"}});
  EXPECT_EQ(client.read_json()["ok"], false);
  EXPECT_FALSE(server.take_request());
}

TEST_F(WebServerTest, OpenToOtherMachinesItIsReadOnlyWithTheToken) {
  WebOptions open = options();
  open.host = "0.0.0.0";
  WebServer server(open);
  EXPECT_TRUE(server.needs_token_to_read());
  server.retain("hello", R"({"op":"hello"})");
  Client visitor(server.port());
  visitor.upgrade();
  visitor.send_json({{"op", "hello"}});
  EXPECT_EQ(visitor.read_json()["op"], "error");
  const auto close = visitor.read_frame();
  ASSERT_TRUE(close);
  EXPECT_EQ(close->close_code(), 1008);
  EXPECT_EQ(server.clients(), 0);
  page_of(server);
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

TEST_F(WebServerTest, APageThatDoesNotAcknowledgeGetsTheNewestStateLater) {
  WebServer server(options());
  server.retain("hello", R"({"op":"hello"})");
  Client page = page_of(server);
  const auto sequence_read = [&] { return static_cast<unsigned char>(page.read_frame()->payload[4]); };
  server.send_state(state(1));
  EXPECT_EQ(sequence_read(), 1);
  server.send_state(state(2));
  EXPECT_EQ(sequence_read(), 2);
  for (std::uint32_t sequence = 3; sequence <= 100; ++sequence) server.send_state(state(sequence));
  server.send_text("{}");
  EXPECT_EQ(page.read_frame()->payload, "{}");  // no state before it
  page.send_json({{"op", "ack"}, {"sequence", 2}});
  EXPECT_EQ(sequence_read(), 100);
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

/// Subprotocol that sends each message back.
class Echo final : public bridges::WebProtocol {
 public:
  class Session final : public bridges::WebSession {
   public:
    explicit Session(bridges::WebLink& link) : link_(link) {}
    void receive(std::string_view bytes, bool is_text) override {
      frame_ = {std::make_shared<const std::string>(bytes), is_text};
      link_.wake();
    }
    bool next(bridges::WebFrame& frame) override {
      frame = std::exchange(frame_, {});
      return frame.bytes != nullptr;
    }

   private:
    bridges::WebLink& link_;
    bridges::WebFrame frame_{};
  };
  std::unique_ptr<bridges::WebSession> open(bridges::WebLink& link) override { return std::make_unique<Session>(link); }
  std::size_t max_message_bytes() const override { return 200'000; }
};

TEST_F(WebServerTest, FurtherSubprotocolsMayBeAdded) {
  WebServer server(options());
  server.add_protocol("echo.v1", std::make_shared<Echo>());
  Client client(server.port());
  EXPECT_EQ(client.upgrade("Sec-WebSocket-Protocol: x, echo.v1\r\n").headers.at("sec-websocket-protocol"), "echo.v1");
  client.send_frame(2, std::string(150'000, 'y'));
  const auto frame = client.read_frame();
  EXPECT_EQ(frame->opcode, 2);
  EXPECT_EQ(frame->payload, std::string(150'000, 'y'));
  EXPECT_EQ(server.clients(), 0);  // pages only
}

}  // namespace
