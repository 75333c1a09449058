// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_file.hpp"

#include <gmock/gmock.h>

#include "sim/config/diagnostics.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* mission = R"(// a comment = 1
serverhost = localhost   // case does not matter
ServerPort = 9001
Community  = alpha
MOOSTimeWarp = 4
LatOrigin  = 43.825300
LongOrigin = -70.330400
ProcessConfig = ANTLER
{
  ServerPort = 9999
  Run = MOOSDB @ NewConsole = false
}
)";

std::vector<std::string> errors_of(const std::string& text) {
  try {
    bridges::read_moos_text(text, "a.moos");
    return {};
  } catch (const sim::ConfigError& error) {
    return error.lines();
  }
}

template <class Work>
std::string moos_error(const Work& work) {
  try {
    work();
    return "none";
  } catch (const sim::ConfigError& error) {
    return error.lines().front();
  }
}

TEST(MoosFile, HasTheSettingsBeforeTheBlocksOfTheApplications) {
  const bridges::MoosFile file = bridges::read_moos_text(mission, "a.moos");
  EXPECT_EQ(file.host, "localhost");
  EXPECT_EQ(file.port, 9001);
  EXPECT_EQ(file.community, "alpha");
  EXPECT_EQ(file.time_warp, 4);
  EXPECT_EQ(file.latitude_deg, 43.8253);
  EXPECT_EQ(file.longitude_deg, -70.3304);
}

TEST(MoosFile, IsRefusedWithAllErrors) {
  EXPECT_THAT(errors_of("ServerPort = 70000\nMOOSTimeWarp = fast\nLatOrigin = 91\n"),
              ElementsAre("a.moos:1: 'ServerPort' must be a whole number from 1 to 65535, got '70000'",
                          "a.moos:2: 'MOOSTimeWarp' must be a number from 0.001 to 1000, got 'fast'",
                          "a.moos:3: 'LatOrigin' must be a number from -90 to 90, got '91'"));
  EXPECT_THAT(errors_of("LatOrigin = 43\n"), ElementsAre("a.moos: needs both 'LatOrigin' and 'LongOrigin', or none"));
  EXPECT_THAT(errors_of("ServerPort = ${PORT}\n"), ElementsAre(HasSubstr("got '${PORT}'")));
  EXPECT_THAT(moos_error([] { bridges::read_moos_file("no_such.moos"); }), "no_such.moos: does not exist");
}

TEST(MoosFile, NamesNoOtherMachineByItself) {
  const bridges::MoosFile file = bridges::read_moos_text("// 1\nServerHost = 10.0.0.5\n", "a.moos");
  EXPECT_EQ(moos_error([&] { bridges::moos_host(file, ""); }),
            "a.moos:2: 'ServerHost' is another machine, '10.0.0.5'; only the command line allows it: --peer 10.0.0.5");
  EXPECT_EQ(bridges::moos_host(file, "10.0.0.5"), "10.0.0.5");
  EXPECT_EQ(bridges::moos_host({}, ""), "localhost");
  EXPECT_TRUE(bridges::is_loopback("127.0.0.1"));
  EXPECT_FALSE(bridges::is_loopback("127.evil.org"));
  EXPECT_FALSE(bridges::is_loopback("localhost.evil.org"));
}

TEST(MoosFile, MustHaveTheOriginOfTheWorld) {
  const bridges::MoosFile file = bridges::read_moos_text(mission, "a.moos");
  bridges::check_moos_origin(file, "sea", 43.8253, -70.3304);
  bridges::check_moos_origin({}, "sea", 10, 20);  // it has none
  // A degree of latitude is 111.1 km here.
  EXPECT_EQ(moos_error([&] { bridges::check_moos_origin(file, "sea", 42.8253, -70.3304); }),
            "a.moos: LatOrigin and LongOrigin are 43.8253, -70.3304, and 'origin' of world 'sea' is 42.8253, -70.3304, "
            "111000 m away: positions would not agree");
}

}  // namespace
