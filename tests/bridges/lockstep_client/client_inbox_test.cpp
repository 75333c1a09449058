// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/client_inbox.hpp"

#include <gmock/gmock.h>

#include "sim/base/crc32.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using testing::ElementsAre;

/// An inbox with the channels "a" and "b", and what it handed over.
struct Inbox : ClientInbox {
  Inbox() {
    add_channel("a");
    add_channel("b");
  }
  void come(const std::string& channel, const std::string& text) {
    Received message{channel, bytes_of(text)};
    EXPECT_TRUE(hold(message));
  }
  bool name(const std::vector<std::pair<std::int32_t, std::string>>& messages) {
    shoal::sim_due_t due{};
    for (const auto& [channel, text] : messages) {
      due.channel.push_back(channel);
      due.crc.push_back(static_cast<std::int64_t>(sim::crc32(bytes_of(text))));
    }
    due.count = static_cast<std::int32_t>(due.channel.size());
    return expect(due);
  }
  std::vector<std::string> handled() {
    std::vector<std::string> all;
    hand_over([&](const std::string& channel, std::span<const std::byte> payload) {
      all.push_back(channel + ":" + lcm_test::text_of({payload.begin(), payload.end()}));
    });
    return all;
  }
};

TEST(ClientInbox, HandlesInTheOrderOfTheTickWhateverTheOrderOfArrival) {
  Inbox inbox;
  inbox.come("b", "1");
  ASSERT_TRUE(inbox.name({{0, "2"}, {1, "1"}, {0, "3"}}));
  EXPECT_FALSE(inbox.complete());
  EXPECT_EQ(inbox.first_missing(), 0);
  inbox.come("a", "3");
  inbox.come("a", "2");
  EXPECT_TRUE(inbox.complete());
  EXPECT_THAT(inbox.handled(), ElementsAre("a:2", "b:1", "a:3"));
}

TEST(ClientInbox, TakesWhatIsSentAgainOnlyWhenItIsWhatWasNamed) {
  Inbox inbox;
  ASSERT_TRUE(inbox.name({{0, "1"}, {0, "2"}}));
  inbox.come("a", "1");
  EXPECT_FALSE(inbox.complete());
  EXPECT_EQ(inbox.first_missing(), 1);
  shoal::sim_payload_t wrong{}, right{};
  wrong.data = {'x'};
  right.data = {'2'};
  inbox.add(1, {wrong});
  EXPECT_FALSE(inbox.complete());
  inbox.add(-1, {right, right});
  inbox.add(1, {right, right});  // there is no place 2
  EXPECT_TRUE(inbox.complete());
  EXPECT_EQ(inbox.counts().requested, 1u);
  EXPECT_THAT(inbox.handled(), ElementsAre("a:1", "a:2"));
}

TEST(ClientInbox, DropsWhatCameTwice) {
  Inbox inbox;
  inbox.come("a", "1");
  inbox.come("a", "1");
  ASSERT_TRUE(inbox.name({{0, "1"}}));
  ASSERT_TRUE(inbox.complete());
  EXPECT_THAT(inbox.handled(), ElementsAre("a:1"));
  EXPECT_EQ(inbox.counts().repeated, 1u);
}

TEST(ClientInbox, HandlesWhatThreeTicksDidNotNameAndNotAgainWhenOneDoes) {
  Inbox inbox;
  inbox.come("a", "stray");
  for (int tick = 0; tick < 2; ++tick) {
    ASSERT_TRUE(inbox.name({}));
    EXPECT_THAT(inbox.handled(), ElementsAre());
  }
  ASSERT_TRUE(inbox.name({}));
  EXPECT_THAT(inbox.handled(), ElementsAre("a:stray"));
  EXPECT_EQ(inbox.counts().unnamed, 1u);
  inbox.come("a", "stray");  // sent again
  ASSERT_TRUE(inbox.name({{0, "stray"}}));
  ASSERT_TRUE(inbox.complete());
  EXPECT_THAT(inbox.handled(), ElementsAre());
}

TEST(ClientInbox, RefusesATickThatNamesOtherChannels) {
  Inbox inbox;
  inbox.come("a", "1");
  ASSERT_TRUE(inbox.name({{0, "1"}}));
  EXPECT_FALSE(inbox.name({{2, "1"}}));
  EXPECT_FALSE(inbox.name({{-1, "1"}}));
  ASSERT_TRUE(inbox.complete());  // as before
  EXPECT_THAT(inbox.handled(), ElementsAre("a:1"));
}

TEST(ClientInbox, LeavesOtherChannelsAlone) {
  Inbox inbox;
  Received message{"c", bytes_of("1")};
  EXPECT_FALSE(inbox.hold(message));
  EXPECT_EQ(lcm_test::text_of(message.payload), "1");
  EXPECT_FALSE(ClientInbox::is_named("sim.tick"));
  EXPECT_TRUE(ClientInbox::is_named("sim.clock"));
}

TEST(ClientInbox, AHandlerMayAddChannels) {
  Inbox inbox;
  inbox.come("a", "1");
  inbox.come("a", "2");
  ASSERT_TRUE(inbox.name({{0, "1"}, {0, "2"}}));
  ASSERT_TRUE(inbox.complete());
  int handled = 0;
  inbox.hand_over([&](const std::string& channel, std::span<const std::byte>) {
    for (int i = 0; i < 100; ++i) inbox.add_channel("new" + std::to_string(i));
    EXPECT_EQ(channel, "a");
    ++handled;
  });
  EXPECT_EQ(handled, 2);
  EXPECT_EQ(inbox.channels().size(), 102u);
}

TEST(ClientInbox, AfterGoingBackTheSameMessageIsHandledAgain) {
  Inbox inbox;
  for (int branch = 0; branch < 2; ++branch) {
    inbox.come("a", "1");
    ASSERT_TRUE(inbox.name({{0, "1"}}));
    ASSERT_TRUE(inbox.complete());
    EXPECT_THAT(inbox.handled(), ElementsAre("a:1")) << branch;
    inbox.discard();
  }
  EXPECT_EQ(inbox.counts().repeated, 0u);
}

}  // namespace
}  // namespace bridges
