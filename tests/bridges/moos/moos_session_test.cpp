// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_session.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/moos/small_moosdb.hpp"

namespace {

using bridges::MoosError;
using bridges::MoosSession;
using moos_test::Msg;
using testing::HasSubstr;

/// A session with a MOOSDB that is this test, whose clock is a number.
class MoosSessionTest : public testing::Test {
 protected:
  /// What the session has written since the last call.
  std::vector<Msg> written() {
    const auto output = session_.output();
    std::string bytes(reinterpret_cast<const char*>(output.data()), output.size());
    session_.sent(output.size());
    std::vector<Msg> messages;
    if (bytes.starts_with("ELKS")) bytes.erase(0, 32);
    while (moos_test::take_packet(bytes, messages)) {
    }
    return messages;
  }
  void answer(const Msg& msg) {
    const std::string bytes = moos_test::packet({msg});
    session_.receive(std::as_bytes(std::span(bytes.data(), bytes.size())), now_s_);
  }
  void welcome() {
    written();
    Msg welcome{'W'};
    welcome.text = "asynchronous";
    welcome.community = "alpha";
    answer(welcome);
  }

  double now_s_ = 1000;
  MoosSession session_{{"shoal", {"DESIRED_SPEED", "*"}, 2}, now_s_};
};

TEST_F(MoosSessionTest, GreetsAndNamesItself) {
  const auto output = session_.output();
  const std::string bytes(reinterpret_cast<const char*>(output.data()), output.size());
  EXPECT_EQ(bytes.substr(0, 32), std::string("ELKS CAN'T DANCE 2/8/10") + std::string(9, '\0'));
  const auto messages = written();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].type, 'i');
  EXPECT_EQ(messages[0].key, "asynchronous");
  EXPECT_EQ(messages[0].text, "shoal");
}

TEST_F(MoosSessionTest, SubscribesWhenItIsWelcome) {
  EXPECT_FALSE(session_.is_open());
  welcome();
  EXPECT_TRUE(session_.is_open());
  EXPECT_EQ(session_.community(), "alpha");
  const auto orders = written();
  ASSERT_EQ(orders.size(), 2U);
  EXPECT_EQ(orders[0].type, 'R');
  EXPECT_EQ(orders[0].key, "DESIRED_SPEED");
  EXPECT_EQ(orders[1].type, '*');
  EXPECT_THAT(orders[1].text, HasSubstr("VarPattern=*"));
}

TEST_F(MoosSessionTest, ReportsARefusal) {
  Msg refusal{'K', 'S'};
  refusal.text = "a client of this name exists";
  try {
    answer(refusal);
    FAIL();
  } catch (const MoosError& error) {
    EXPECT_THAT(error.what(), HasSubstr("refuses the client 'shoal': a client of this name exists"));
  }
}

TEST_F(MoosSessionTest, RefusesAServerThatIsNoMoosdb) {
  EXPECT_THROW(answer({'N', 'D', "X", 1}), MoosError);
  const std::string http = "HTTP/1.1 400 Bad Request\r\n";
  EXPECT_THROW(session_.receive(std::as_bytes(std::span(http.data(), http.size())), now_s_), MoosError);
}

TEST_F(MoosSessionTest, StampsValuesWithWallTimeTimesTheWarp) {
  const std::vector<bridges::MoosValue> values{{"NAV_X", 1.5}, {"NODE_REPORT_LOCAL", "NAME=alpha"}};
  session_.notify(values, now_s_);  // not yet: there is no one
  welcome();
  written();
  session_.notify(values, now_s_);
  const auto messages = written();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].value, 1.5);
  EXPECT_EQ(messages[0].time, 2000);
  EXPECT_EQ(messages[1].text, "NAME=alpha");
  EXPECT_EQ(messages[1].data, 'S');
}

TEST_F(MoosSessionTest, GivesNoticeEachSecondAndTakesFiveSecondsOfSilenceForDeath) {
  welcome();
  written();
  session_.keep_alive(now_s_ + 0.9);
  EXPECT_TRUE(written().empty());
  session_.keep_alive(now_s_ + 1);
  const auto timing = written();
  ASSERT_EQ(timing.size(), 1U);
  EXPECT_EQ(timing[0].type, 'T');
  EXPECT_EQ(timing[0].key, "_async_timing");
  EXPECT_EQ(timing[0].time, 1001);  // without the warp
  session_.keep_alive(now_s_ + 5);
  EXPECT_THROW(session_.keep_alive(now_s_ + 5.1), MoosError);
}

TEST_F(MoosSessionTest, DropsValuesForAMoosdbThatDoesNotRead) {
  welcome();
  const std::string megabyte(1 << 20, 'x');
  for (int i = 0; i < 10; ++i) session_.notify(std::vector<bridges::MoosValue>{{"BIG", megabyte}}, now_s_);
  EXPECT_LT(session_.output().size(), std::size_t{7} << 20);
  EXPECT_GT(session_.dropped(), 0U);
}

// A day of a vehicle with five variables a second, on a clock that does not wait: memory and meaning stay.
TEST_F(MoosSessionTest, LastsForADay) {
  welcome();
  written();
  constexpr int seconds_of_a_day = 24 * 3600;
  std::size_t notified = 0, timings = 0, received = 0;
  for (int i = 1; i <= seconds_of_a_day; ++i) {
    now_s_ += 1;
    session_.notify(
        std::vector<bridges::MoosValue>{
            {"NAV_X", 0.1 * i}, {"NAV_Y", 0.0}, {"NAV_SPEED", 1.0}, {"NAV_HEADING", 90.0}, {"SHOAL_TIME", now_s_}},
        now_s_);
    session_.keep_alive(now_s_);
    answer({'N', 'D', "DESIRED_SPEED", 1});
    received += session_.take_received().size();
    if (i % 10 == 0)  // so much waits in the socket
      for (const Msg& msg : written()) (msg.type == 'T' ? timings : notified) += 1;
  }
  EXPECT_EQ(notified, 5U * seconds_of_a_day);
  EXPECT_EQ(timings, static_cast<std::size_t>(seconds_of_a_day));
  EXPECT_EQ(received, static_cast<std::size_t>(seconds_of_a_day));
  EXPECT_EQ(session_.dropped(), 0U);
  EXPECT_TRUE(session_.output().empty());
}

}  // namespace
