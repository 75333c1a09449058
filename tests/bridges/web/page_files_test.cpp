// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/page_files.hpp"

#include <gmock/gmock.h>

#include "bridges/web/web_server.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/bridges/web/web_server_fixture.hpp"

namespace {

using namespace web_server_fixture;

using bridges::WebOptions;
using bridges::WebServer;
using testing::HasSubstr;
using web_test::Answer;
using web_test::Client;

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

}  // namespace
