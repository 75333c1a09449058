// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/signing/run_key.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <fstream>

#include "bridges/base/bus_error.hpp"
#include "bridges/bus/network_check.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lockstep/control_guard.hpp"
#include "bridges/signing/signed_message.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using bridges::BusError;
using bridges::RunKey;
using lcm_test::bytes_of;
using testing::HasSubstr;

const std::string key_text(64, 'a');

TEST(RunKey, AgreesWithTheHmacOfPython) {
  // hmac.new(b'Jefe' + bytes(28), b'what do ya want\0for nothing?', 'sha256').hexdigest()
  const RunKey key = RunKey::from_text("4a656665" + std::string(56, '0'), "test");
  const bridges::Mac mac = key.mac("what do ya want", bytes_of("for nothing?"));
  std::string text;
  for (const std::uint8_t byte : mac) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  EXPECT_EQ(text, "adf13648edae17564744ff0aef28b138a329fa4a8104ff63388d270cef395d2b");
}

TEST(RunKey, IsAnotherOneEachTime) {
  EXPECT_NE(RunKey::random().text(), RunKey::random().text());
  EXPECT_EQ(RunKey::random().text().size(), 64u);
}

TEST(RunKey, SaysWhereATextIsWrongAndNeverTheText) {
  for (const std::string& text : {std::string("5ecret"), std::string(63, 'a') + "x", std::string(65, 'a')}) {
    try {
      RunKey::from_text(text, "SHOAL_RUN_KEY");
      ADD_FAILURE() << text;
    } catch (const BusError& error) {
      EXPECT_EQ(std::string(error.what()),
                "SHOAL_RUN_KEY: must be the key of a run, 64 hexadecimal digits, got a text of " +
                    std::to_string(text.size()) + " characters");
    }
  }
  EXPECT_EQ(RunKey::from_text(" " + key_text + "\n", "test").text(), key_text);
}

TEST(RunKey, IsReadFromTheFolderOfItsRun) {
  const lcm_test::ScratchFolder folder;
  std::ofstream(folder.file("run.key")) << key_text << '\n';
  EXPECT_EQ(bridges::read_run_key(folder.file("")).text(), key_text);
  mkfifo(folder.file("fifo").c_str(), 0600);
  EXPECT_THAT([&] { bridges::read_run_key(folder.file("nowhere")); },
              testing::ThrowsMessage<BusError>(HasSubstr("nowhere/run.key: No such file or directory; the run has")));
}

}  // namespace
