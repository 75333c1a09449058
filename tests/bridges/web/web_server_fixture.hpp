// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bridges/web/web_server.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/scratch_folder.hpp"

namespace web_server_fixture {

inline const std::string token = "0123456789abcdef";

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
  bridges::WebOptions options() const {
    bridges::WebOptions options;
    options.port = 0;
    options.token = token;
    options.page_directory = page_.path();
    return options;
  }
  /// A page that has said hello and got the retained `hello`.
  static web_test::Client page_of(bridges::WebServer& server, const std::string& with = token, int receive_bytes = 0) {
    web_test::Client client(server.port(), false, receive_bytes);
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

}  // namespace web_server_fixture
