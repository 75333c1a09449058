// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/http_site.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "bridges/web/web_server.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/bridges/web/web_server_fixture.hpp"

namespace {

using namespace web_server_fixture;

using bridges::WebServer;
using testing::HasSubstr;
using web_test::Answer;
using web_test::Client;

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

}  // namespace
