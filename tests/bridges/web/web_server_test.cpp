// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/web_server.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/web/web_client.hpp"
#include "tests/bridges/web/web_server_fixture.hpp"

namespace {

using namespace web_server_fixture;

using bridges::WebOptions;
using bridges::WebServer;
using web_test::await;
using web_test::Client;
using web_test::Json;

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
