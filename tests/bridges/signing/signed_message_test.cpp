// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/signing/signed_message.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "bridges/base/bus_error.hpp"
#include "bridges/bus/bus_reach.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "bridges/lockstep/control_guard.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_signed_t.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using bridges::BusError;
using bridges::ControlGuard;
using bridges::MessageSigner;
using bridges::RunKey;
using lcm_test::bytes_of;
using lcm_test::text_of;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string key_text(64, 'a');

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

TEST(BusReach, IsAboveTheMachineWithATtlOrAServer) {
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?recv_buf_size=100&ttl=0",
                          "udpm://:7667?", "udpm://:7667?ttl=00", "memq://"})
    EXPECT_FALSE(bridges::leaves_machine(bridges::resolve_lcm_url(url))) << url;
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=1", "udpm://:7667?recv_buf_size=100&ttl=255",
                          "udpm://:7667?recv_buf_size=100,ttl=2", "tcpq://127.0.0.1:7700"})
    EXPECT_TRUE(bridges::leaves_machine(bridges::resolve_lcm_url(url))) << url;
}

}  // namespace
