// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/signing/signed_message.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "bridges/base/bus_error.hpp"
#include "bridges/bus/network_check.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lockstep/control_guard.hpp"
#include "shoal/message_codec.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using bridges::ControlGuard;
using bridges::MessageSigner;
using bridges::RunKey;
using lcm_test::bytes_of;
using lcm_test::text_of;
using testing::HasSubstr;
using testing::IsEmpty;

RunKey some_key(char digit = 'a') {
  return RunKey::from_text(std::string(64, digit), "test");
}

std::string refusal_of(ControlGuard& guard, const std::string& channel, const sim::Bytes& payload) {
  return guard.open(channel, payload).refusal;
}

ControlGuard guard_of(const RunKey& key) {
  ControlGuard guard;
  guard.require(key);
  return guard;
}

TEST(SignedMessage, IsOpenedByTheKeyItWasSignedWith) {
  ControlGuard guard = guard_of(some_key());
  MessageSigner signer(some_key(), "pilot");
  const ControlGuard::Opened opened = guard.open("sim.ack", signer.sign("sim.ack", bytes_of("content")));
  EXPECT_EQ(text_of(opened.content), "content");
  EXPECT_EQ(opened.signer, "pilot");
  EXPECT_THAT(opened.refusal, IsEmpty());
}

TEST(SignedMessage, IsRefusedWithoutTheKeyAndOnAnotherChannel) {
  ControlGuard guard = guard_of(some_key());
  EXPECT_THAT(refusal_of(guard, "sim.ack", bytes_of("content")), HasSubstr("can only be controlled with its key"));
  MessageSigner other_run(some_key('b'), "pilot");
  EXPECT_THAT(refusal_of(guard, "sim.ack", other_run.sign("sim.ack", bytes_of("content"))),
              HasSubstr("signed by 'pilot', but not with the key of this run"));
  MessageSigner signer(some_key(), "pilot");
  EXPECT_THAT(refusal_of(guard, "sim.control", signer.sign("sim.ack", bytes_of("content"))),
              HasSubstr("not with the key of this run for channel 'sim.control'"));
}

TEST(SignedMessage, IsRefusedWithAnyBitChanged) {
  ControlGuard guard = guard_of(some_key());
  const sim::Bytes good = MessageSigner(some_key(), "pilot").sign("sim.ack", bytes_of("content"));
  for (std::size_t at = 8; at < good.size(); ++at) {  // without its fingerprint it is another type
    sim::Bytes bad = good;
    bad[at] ^= std::byte{1};
    try {
      EXPECT_THAT(refusal_of(guard, "sim.ack", bad), testing::Not(IsEmpty())) << at;
    } catch (const shoal::MessageError&) {
      // A length that does not fit.
    }
  }
  EXPECT_THAT(refusal_of(guard, "sim.ack", good), IsEmpty());
}

TEST(SignedMessage, ThatWasCapturedIsRefusedWhenItComesAgain) {
  ControlGuard guard = guard_of(some_key());
  MessageSigner signer(some_key(), "pilot");
  const sim::Bytes first = signer.sign("sim.control", bytes_of("quit"));
  const sim::Bytes second = signer.sign("sim.control", bytes_of("quit"));
  EXPECT_NE(first, second);
  EXPECT_THAT(refusal_of(guard, "sim.control", first), IsEmpty());
  EXPECT_THAT(refusal_of(guard, "sim.control", first), HasSubstr("it was sent before, and was received again"));
  EXPECT_THAT(refusal_of(guard, "sim.control", second), IsEmpty());
  EXPECT_THAT(refusal_of(guard, "sim.control", first), HasSubstr("is not above the last one"));
}

TEST(SignedMessage, IsNewOnEachChannelForTheyAreReadAtDifferentTimes) {
  ControlGuard guard = guard_of(some_key());
  MessageSigner signer(some_key(), "pilot");
  const sim::Bytes ack = signer.sign("sim.ack", bytes_of("ack"));
  const sim::Bytes leave = signer.sign("sim.control", bytes_of("leave"));
  EXPECT_THAT(refusal_of(guard, "sim.control", leave), IsEmpty());
  EXPECT_THAT(refusal_of(guard, "sim.ack", ack), IsEmpty());
}

TEST(SignedMessage, ThatWasCapturedIsRefusedAlsoWhenItsSenderHadToMakeRoom) {
  ControlGuard guard = guard_of(some_key());
  const sim::Bytes captured = MessageSigner(some_key(), "first").sign("sim.control", bytes_of("quit"));
  EXPECT_THAT(refusal_of(guard, "sim.control", captured), IsEmpty());
  sim::Bytes last;
  for (std::size_t i = 0; i < ControlGuard::max_senders; ++i) {
    last = MessageSigner(some_key(), "other").sign("sim.control", bytes_of("where"));
    ASSERT_THAT(refusal_of(guard, "sim.control", last), IsEmpty());
  }
  EXPECT_THAT(refusal_of(guard, "sim.control", captured), HasSubstr("start from the wall clock in microseconds"));
  EXPECT_THAT(refusal_of(guard, "sim.control", last), HasSubstr("was received again"));
}

TEST(SignedMessage, IsOpenedUncheckedWhereARunHasNoKey) {
  ControlGuard guard;
  const sim::Bytes stale = MessageSigner(some_key('c'), "pilot").sign("sim.ack", bytes_of("content"));
  for (int i = 0; i < 2; ++i) {
    const ControlGuard::Opened opened = guard.open("sim.ack", stale);
    EXPECT_EQ(text_of(opened.content), "content");
    EXPECT_THAT(opened.signer + opened.refusal, IsEmpty());
  }
}

TEST(SignedMessage, ThatIsCutOffIsNoMessage) {
  ControlGuard guard = guard_of(some_key());
  const sim::Bytes good = MessageSigner(some_key(), "pilot").sign("sim.ack", bytes_of("content"));
  for (std::size_t size = 8; size < good.size(); ++size)
    EXPECT_THROW(guard.open("sim.ack", std::span(good).first(size)), shoal::MessageError) << size;
}

}  // namespace
