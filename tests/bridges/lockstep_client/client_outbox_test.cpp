// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/client_outbox.hpp"

#include <gmock/gmock.h>

#include "bridges/base/bus_error.hpp"
#include "sim/base/crc32.hpp"
#include "sim/run/lockstep.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using testing::ElementsAre;

/// An outbox, and the channels on which it sent.
struct Outbox {
  std::vector<std::string> named() const {
    shoal::sim_ack_t ack{};
    outbox.name_all(ack);
    EXPECT_EQ(ack.listed, 1);
    EXPECT_EQ(static_cast<std::size_t>(ack.count), ack.channel.size());
    EXPECT_EQ(ack.crc.size(), ack.channel.size());
    return ack.channel;
  }

  std::vector<std::string> sent;
  ClientOutbox outbox{"pilot",
                      [this](std::string_view channel, std::span<const std::byte>) { sent.emplace_back(channel); }};
};

TEST(ClientOutbox, AnswersNameWhatWasPublishedSinceTheTick) {
  Outbox box;
  box.outbox.open();
  box.outbox.publish("a", bytes_of("1"));
  box.outbox.publish("b", bytes_of("2"));
  EXPECT_THAT(box.sent, ElementsAre("a", "b"));
  box.outbox.close();
  EXPECT_THAT(box.named(), ElementsAre("a", "b"));
  shoal::sim_ack_t ack{};
  box.outbox.name_all(ack);
  EXPECT_EQ(static_cast<std::uint32_t>(ack.crc[1]), sim::crc32(bytes_of("2")));
  box.outbox.open();
  box.outbox.close();
  EXPECT_THAT(box.named(), ElementsAre());
}

TEST(ClientOutbox, WhatIsPublishedBetweenTicksWaitsForTheNext) {
  Outbox box;
  box.outbox.publish("early", bytes_of("1"));
  EXPECT_THAT(box.sent, ElementsAre());
  box.outbox.open();
  box.outbox.release();
  box.outbox.publish("late", bytes_of("2"));
  EXPECT_THAT(box.sent, ElementsAre("early", "late"));
  box.outbox.close();
  EXPECT_THAT(box.named(), ElementsAre("early", "late"));
}

TEST(ClientOutbox, SendsAgainFromAPlaceOfTheList) {
  Outbox box;
  box.outbox.open();
  for (const char* channel : {"a", "b", "c"}) box.outbox.publish(channel, bytes_of(channel));
  box.outbox.close();
  std::vector<std::string> again;
  const auto send = [&](const shoal::sim_resent_t& bundle) {
    EXPECT_EQ(bundle.first, 1);
    for (const shoal::sim_payload_t& message : bundle.message) again.push_back(message.channel);
  };
  box.outbox.send_again({}, 1, send);
  EXPECT_THAT(again, ElementsAre("b", "c"));
  for (const std::int32_t nowhere : {-1, 3, 1'000'000}) box.outbox.send_again({}, nowhere, send);
  EXPECT_EQ(again.size(), 2u);
}

TEST(ClientOutbox, RefusesMoreThanAnAnswerMayName) {
  Outbox box;
  box.outbox.open();
  for (std::size_t i = 0; i < sim::max_named_messages; ++i) box.outbox.publish("a", {});
  try {
    box.outbox.publish("a", {});
    FAIL();
  } catch (const BusError& error) {
    EXPECT_STREQ(error.what(), "'pilot' publishes more than 10000 messages between two ticks");
  }
  EXPECT_EQ(box.sent.size(), sim::max_named_messages);
}

TEST(ClientOutbox, StartsAnewAndKeepsWhatWaitsForATick) {
  Outbox box;
  box.outbox.publish("waits", bytes_of("1"));
  box.outbox.open();
  box.outbox.publish("a", bytes_of("2"));
  box.outbox.restart();
  EXPECT_FALSE(box.outbox.is_open());
  EXPECT_THAT(box.named(), ElementsAre());
  box.outbox.open();
  box.outbox.release();
  EXPECT_THAT(box.sent, ElementsAre("a", "waits"));
  box.outbox.clear();
  box.outbox.close();
  EXPECT_THAT(box.named(), ElementsAre());
}

}  // namespace
}  // namespace bridges
