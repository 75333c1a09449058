// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_connection.hpp"

#include <gmock/gmock.h>

#include <memory>

#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/moos/small_moosdb.hpp"
#include "tests/own_ports.hpp"

namespace {

using bridges::MoosConnection;
using bridges::MoosMessage;
using lcm_test::await;
using moos_test::SmallMoosClient;
using moos_test::SmallMoosDb;
using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr auto limit = 120s;

class MoosConnectionTest : public testing::Test {
 protected:
  std::unique_ptr<MoosConnection> connection(const std::string& name = "shoal-moos") {
    MoosConnection::Options options;
    options.port = port_;
    options.terms = {name, {"DESIRED_SPEED"}, 1};
    options.on_received = [this](const std::vector<MoosMessage>& messages) {
      const std::lock_guard lock(mutex_);
      for (const MoosMessage& message : messages) inbox_ += message.key + "=" + std::to_string(message.number) + " ";
    };
    options.report = [this](const std::string& sentence) {
      const std::lock_guard lock(mutex_);
      reports_ += sentence + "\n";
    };
    return std::make_unique<MoosConnection>(std::move(options));
  }
  std::string received() {
    const std::lock_guard lock(mutex_);
    return inbox_;
  }
  std::string reports() {
    const std::lock_guard lock(mutex_);
    return reports_;
  }

  const int port_ = test_support::own_port(3);
  std::mutex mutex_;
  std::string inbox_, reports_;
};

TEST_F(MoosConnectionTest, CarriesValuesBothWays) {
  SmallMoosDb db(port_);
  const auto moos = connection();
  ASSERT_TRUE(moos->await_open(limit));
  moos->notify({{"NAV_X", 12.5}, {"NODE_REPORT_LOCAL", "NAME=alpha"}});
  EXPECT_TRUE(await([&] { return db.written("NODE_REPORT_LOCAL") == 1; }, limit));
  EXPECT_EQ(db.last("NAV_X").first.value, 12.5);
  EXPECT_EQ(db.last("NAV_X").first.source, "shoal-moos");
  SmallMoosClient helm(port_, "pHelmIvP", {});
  helm.notify("DESIRED_SPEED", 1.5);
  EXPECT_TRUE(await([&] { return received() == "DESIRED_SPEED=1.500000 "; }, limit)) << received();
  EXPECT_THAT(reports(), HasSubstr("connected to community 'alpha' as 'shoal-moos'"));
}

// The MOOSDB drops a client after 5 s of silence: here after 2 s, and the client has nothing to say.
TEST_F(MoosConnectionTest, StaysAliveWithoutValues) {
  SmallMoosDb db(port_, "alpha", 2);
  const auto moos = connection();
  ASSERT_TRUE(moos->await_open(limit));
  EXPECT_TRUE(await([&] { return db.timings() >= 4; }, limit));  // as many seconds
  EXPECT_TRUE(moos->is_open() || db.dropped_for_silence() > 0);
}

TEST_F(MoosConnectionTest, ComesBackWhenTheMoosdbIsStartedAgain) {
  const auto moos = connection();
  EXPECT_TRUE(await([&] { return reports().find("no connection") != std::string::npos; }, limit)) << reports();
  for (int start = 1; start <= 3; ++start) {
    EXPECT_TRUE(await([&] { return !moos->is_open(); }, limit)) << start;
    SmallMoosDb db(port_);
    ASSERT_TRUE(moos->await_open(limit)) << start;
    moos->notify({{"NAV_X", 1.0 * start}});
    EXPECT_TRUE(await([&] { return db.written("NAV_X") == 1; }, limit)) << start;
    SmallMoosClient helm(port_, "pHelmIvP", {});
    helm.notify("DESIRED_SPEED", start);  // it has subscribed again
    EXPECT_TRUE(await([&] { return received().find("=" + std::to_string(start) + ".0") != std::string::npos; }, limit));
  }
}

TEST_F(MoosConnectionTest, SaysThatItsNameIsTaken) {
  SmallMoosDb db(port_);
  SmallMoosClient other(port_, "shoal-moos", {});
  ASSERT_TRUE(await([&] { return db.has_client("shoal-moos"); }, limit));
  const auto moos = connection();
  EXPECT_TRUE(await([&] { return reports().find("is taken") != std::string::npos; }, limit)) << reports();
}

TEST_F(MoosConnectionTest, SurvivesAHostilePeer) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), yes = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address = moos_test::loopback(port_);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(listener, 4), 0);
  const auto moos = connection();
  moos_test::Msg welcome{'W'};
  welcome.text = "asynchronous";
  for (const std::string& bytes :
       {std::string("\xff\xff\xff\x7f"), std::string(1000, '\0'), moos_test::packet({welcome}) + std::string(64, 'x'),
        moos_test::packet({welcome}).substr(0, 20)}) {
    const int peer = accept(listener, nullptr, nullptr);  // it tries again each second
    ASSERT_GE(peer, 0);
    ASSERT_EQ(send(peer, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    char byte = 0;
    shutdown(peer, SHUT_WR);
    while (recv(peer, &byte, 1, 0) > 0) {
    }
    close(peer);
  }
  close(listener);
  SmallMoosDb db(port_);
  EXPECT_TRUE(moos->await_open(limit));
}

TEST_F(MoosConnectionTest, EndsAtOnceWhileItWaits) {
  for (int i = 0; i < 20; ++i) connection();  // a hang would be seen as such
  const auto begin = std::chrono::steady_clock::now();
  connection();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, limit);
}

}  // namespace
