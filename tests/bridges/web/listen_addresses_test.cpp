// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/listen_addresses.hpp"

#include <gmock/gmock.h>

#include "bridges/web/web_error.hpp"

namespace {

using testing::ElementsAre;

TEST(ListenAddresses, ThisMachineHasTwo) {
  for (const char* host : {"localhost", "127.0.0.1"}) {
    const bridges::ListenAddresses found = bridges::find_listen_addresses(host);
    EXPECT_THAT(found.numeric, ElementsAre("127.0.0.1", "::1"));
    EXPECT_TRUE(found.only_this_machine);
  }
}

TEST(ListenAddresses, AnAddressIsItself) {
  EXPECT_THAT(bridges::find_listen_addresses("0.0.0.0").numeric, ElementsAre("0.0.0.0"));
  EXPECT_FALSE(bridges::find_listen_addresses("0.0.0.0").only_this_machine);
  EXPECT_TRUE(bridges::find_listen_addresses("::1").only_this_machine);
  EXPECT_TRUE(bridges::find_listen_addresses("127.1.2.3").only_this_machine);
}

TEST(ListenAddresses, NoHostIsAnError) {
  EXPECT_THROW(bridges::find_listen_addresses(""), bridges::WebError);
}

}  // namespace
