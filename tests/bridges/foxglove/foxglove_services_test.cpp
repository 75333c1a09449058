// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_services.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "bridges/foxglove/foxglove_message.hpp"
#include "bridges/web/web_error.hpp"
#include "tests/bridges/foxglove/foxglove_bytes.hpp"

namespace {

using namespace foxglove_bytes;
using namespace bridges::foxglove;

using testing::HasSubstr;

TEST(FoxgloveServices, ReadTheirArgumentInBothEncodings) {
  const std::string header("\0\1\0\0", 4);
  const Service& rewind = *find_service(5);
  EXPECT_EQ(rewind.command, "rewind");
  EXPECT_EQ(read_request(rewind, "cdr", header + bytes_of_number(2.5)).value, 2.5);
  EXPECT_EQ(read_request(rewind, "json", R"({"seconds":2.5})").value, 2.5);
  const Service& action = *find_service(7);
  EXPECT_EQ(read_request(action, "cdr", header + text_bytes(std::string("open\0", 5))).text, "open");
  EXPECT_EQ(read_request(action, "json", R"({"action":"open"})").text, "open");
  EXPECT_EQ(read_request(*find_service(3), "cdr", header + bytes_of_number(std::int64_t{10})).value, 10);
  EXPECT_EQ(read_request(*find_service(1), "cdr", "").value, 0);
}

TEST(FoxgloveServices, RefuseArgumentsOfAWrongForm) {
  const std::string header("\0\1\0\0", 4);
  const Service& rewind = *find_service(5);
  EXPECT_THAT(error_of([&] { read_request(rewind, "cdr", header); }), HasSubstr("/shoal/rewind: 'seconds'"));
  EXPECT_THAT(error_of([&] { read_request(rewind, "cdr", "x"); }), HasSubstr("00 01 00 00"));
  EXPECT_THAT(error_of([&] { read_request(rewind, "protobuf", ""); }), HasSubstr("'cdr' or 'json'"));
  EXPECT_THAT(
      error_of([&] { read_request(rewind, "cdr", header + bytes_of_number(std::numeric_limits<double>::infinity())); }),
      HasSubstr("a finite number"));
  EXPECT_THAT(error_of([&] { read_request(rewind, "json", R"({"seconds":"2"})"); }), HasSubstr("a number"));
  EXPECT_THAT(error_of([&] { read_request(*find_service(3), "json", R"({"steps":1.5})"); }), HasSubstr("an integer"));
  EXPECT_THAT(error_of([&] { read_request(*find_service(7), "cdr", header + bytes_of_number(std::uint32_t{9})); }),
              HasSubstr("a text"));
  EXPECT_EQ(find_service(0), nullptr);
  EXPECT_EQ(find_service(8), nullptr);
}

}  // namespace
