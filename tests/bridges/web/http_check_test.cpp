// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/http_check.hpp"

#include <gmock/gmock.h>

namespace {

using bridges::accepts_gzip;
using bridges::AccessRules;
using bridges::asset_of;
using bridges::host_of;
using bridges::is_host_allowed;
using bridges::is_origin;
using bridges::is_origin_allowed;
using bridges::lists_etag;
using bridges::path_of;

TEST(HttpCheck, HostsAreReadWithAndWithoutPort) {
  EXPECT_EQ(host_of("LocalHost"), "localhost");
  EXPECT_EQ(host_of("localhost:8765"), "localhost");
  EXPECT_EQ(host_of("[::1]:8765"), "::1");
  EXPECT_EQ(host_of("[FE80::1]"), "fe80::1");
  EXPECT_EQ(host_of("a-b.example_1.org:0"), "a-b.example_1.org");
}

TEST(HttpCheck, OtherHostsAreRefused) {
  for (const char* text : {"", ":80", "a:", "a:b", "a:65536", "a:99999999999", "::1", "[::1", "[::1]80", "[]", "[a]",
                           "[1.2.3.4]", "a b", "a@b", "a/b", "a:80:80", "\xc3\xa9"})
    EXPECT_EQ(host_of(text), std::nullopt) << text;
  EXPECT_EQ(host_of(std::string(300, 'a')), std::nullopt);
  EXPECT_EQ(host_of(std::string("[::1\0/ x]", 9)), std::nullopt);
}

TEST(HttpCheck, OnlyNamesOfThisServerAreItsHosts) {
  const AccessRules local{"127.0.0.1", {}}, named{"Sim.example.org", {}}, any{"0.0.0.0", {}};
  for (const char* host : {"localhost", "localhost:8765", "127.0.0.1:1", "[::1]:8765"}) {
    EXPECT_TRUE(is_host_allowed(host, local)) << host;
    EXPECT_TRUE(is_host_allowed(host, named)) << host;
  }
  for (const char* host :
       {"evil.example.org", "localhost.evil.org", "127.0.0.1.evil.org", "192.168.1.5", "[fe80::1]", ""})
    EXPECT_FALSE(is_host_allowed(host, local)) << host;
  EXPECT_TRUE(is_host_allowed("sim.example.org:8765", named));
  EXPECT_TRUE(is_host_allowed("192.168.1.5:8765", any));
  EXPECT_TRUE(is_host_allowed("[fe80::1]:8765", any));
  EXPECT_FALSE(is_host_allowed("evil.example.org", any));
}

TEST(HttpCheck, OnlyKnownOriginsMayConnect) {
  const AccessRules rules{"127.0.0.1", {"https://lab.example.org"}};
  const std::string host = "127.0.0.1:8765";
  for (const char* origin : {"http://127.0.0.1:8765", "https://127.0.0.1:8765", "file://", "http://localhost",
                             "http://localhost:8080", "https://app.foxglove.dev", "https://lab.example.org"})
    EXPECT_TRUE(is_origin_allowed(origin, host, rules)) << origin;
  for (const char* origin : {"null", "", "http://127.0.0.1:8766", "http://evil.example.org", "https://localhost:8080",
                             "http://localhost.evil.org", "http://localhost:8080@evil.org", "http://localhost:x",
                             "https://app.foxglove.dev.evil.org", "http://app.foxglove.dev", "http://lab.example.org",
                             "file:///tmp/x", "ftp://127.0.0.1:8765", "://127.0.0.1:8765", "127.0.0.1:8765"})
    EXPECT_FALSE(is_origin_allowed(origin, host, rules)) << origin;
}

TEST(HttpCheck, OriginsOfOptionsHaveSchemeAndHost) {
  EXPECT_TRUE(is_origin("https://a.org"));
  EXPECT_TRUE(is_origin("https://a.org:444"));
  for (const char* text : {"a.org", "https://", "https://a.org/", "*", "ht tp://a", "https://a:b"})
    EXPECT_FALSE(is_origin(text)) << text;
}

TEST(HttpCheck, PathsAreAbsoluteAndPlain) {
  EXPECT_EQ(path_of("/"), "/");
  EXPECT_EQ(path_of("/vendor/three.js?v=%31"), "/vendor/three.js");
  for (const char* target : {"", "*", "http://a/", "/%2e%2e/x", "/a b", "/\\x", "a"})
    EXPECT_EQ(path_of(target), std::nullopt) << target;
}

TEST(HttpCheck, AssetsHaveSixteenDigits) {
  EXPECT_EQ(asset_of("/asset/00000000000000ff"), 255u);
  EXPECT_EQ(asset_of("/asset/ffffffffffffffff"), ~std::uint64_t{0});
  for (const char* path : {"/asset/", "/asset/ff", "/asset/00000000000000FF", "/asset/00000000000000ff0",
                           "/asset/0000000000000 ff", "/other/00000000000000ff"})
    EXPECT_EQ(asset_of(path), std::nullopt) << path;
}

TEST(HttpCheck, GzipIsUsedOnlyIfAccepted) {
  for (const char* header : {"gzip", "deflate, GZIP;q=0.5", "br, *", " gzip ;q=1"})
    EXPECT_TRUE(accepts_gzip(header)) << header;
  for (const char* header : {"", "br", "gzip;q=0", "gzip; q=0.000, *", "*;q=0", "gzipped"})
    EXPECT_FALSE(accepts_gzip(header)) << header;
}

TEST(HttpCheck, EntityTagsAreFoundInLists) {
  EXPECT_TRUE(lists_etag(R"("a", W/"b")", R"("b")"));
  EXPECT_TRUE(lists_etag("*", R"("b")"));
  EXPECT_FALSE(lists_etag(R"("a")", R"("b")"));
  EXPECT_FALSE(lists_etag("", R"("b")"));
}

TEST(HttpCheck, ListsAreBounded) {
  EXPECT_EQ(bridges::header_list(" a ,, b,").size(), 2u);
  EXPECT_EQ(bridges::header_list(std::string(1000, ',') + "a").size(), 1u);
  std::string many;
  for (int i = 0; i < 100; ++i) many += "x,";
  EXPECT_EQ(bridges::header_list(many).size(), 32u);
}

}  // namespace
