// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/access_token.hpp"

#include <gmock/gmock.h>

#include "bridges/web/web_server.hpp"
#include "tests/bridges/web/web_server_fixture.hpp"

namespace {

using namespace web_server_fixture;

using bridges::WebOptions;
using bridges::WebServer;

TEST_F(WebServerTest, TokensAreRandom) {
  WebOptions random = options();
  random.token = "";
  const WebServer first(random), second(random);
  const auto token_of = [](const WebServer& server) { return server.url().substr(server.url().find("#t=") + 3); };
  EXPECT_EQ(token_of(first).size(), 32u);
  EXPECT_NE(token_of(first), token_of(second));
}

}  // namespace
