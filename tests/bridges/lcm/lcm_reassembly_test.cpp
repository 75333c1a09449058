// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_reassembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/bridges/lcm/datagrams.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using lcm_test::fragment_datagram;
using lcm_test::short_datagram;

constexpr DatagramSender sender{0x0a000001, 5000};
constexpr DatagramSender other{0x0a000001, 5001};

/// "channel=payload", or "" when the datagram completes nothing.
std::string reported(LcmReassembly& reassembly, const sim::Bytes& datagram, const DatagramSender& from = sender,
                     const std::function<bool(std::string_view)>& accepts = {}) {
  const auto message = reassembly.add(datagram, from, accepts);
  if (!message) return "";
  return std::string(message->channel) + "=" +
         std::string(reinterpret_cast<const char*>(message->payload.data()), message->payload.size());
}

/// A message of 9 bytes in three fragments.
std::vector<sim::Bytes> three_fragments(std::uint32_t sequence = 7, std::string_view text = "abcdefghi") {
  std::vector<sim::Bytes> datagrams;
  for (std::uint16_t i = 0; i < 3; ++i)
    datagrams.push_back(fragment_datagram({.sequence = sequence,
                                           .message_bytes = 9,
                                           .offset = 3u * i,
                                           .number = i,
                                           .count = 3,
                                           .channel = "a",
                                           .payload = text.substr(3u * i, 3)}));
  return datagrams;
}

TEST(LcmReassembly, AMessageInOneDatagramComesWithItsChannel) {
  LcmReassembly reassembly;
  EXPECT_EQ(reported(reassembly, short_datagram("rover1.cmd", "hello")), "rover1.cmd=hello");
  EXPECT_EQ(reported(reassembly, short_datagram("a", "")), "a=");
  const std::string longest(63, 'x');
  EXPECT_EQ(reported(reassembly, short_datagram(longest, "y")), longest + "=y");
  EXPECT_EQ(reassembly.counts().bad, 0u);
}

TEST(LcmReassembly, DatagramsThatBreakTheFormatAreDropped) {
  sim::Bytes unterminated = short_datagram("abc", "");
  unterminated.pop_back();
  sim::Bytes magic = short_datagram("a", "x");
  magic[3] = std::byte{0x34};
  const sim::Bytes whole = fragment_datagram({.message_bytes = 9, .count = 3, .channel = "a", .payload = "abc"});
  const std::vector<sim::Bytes> bad{
      {},
      bytes_of("LC0"),
      bytes_of("LC02abc"),
      bytes_of("LC02abcd"),
      unterminated,
      magic,
      short_datagram("", "x"),
      short_datagram(std::string(64, 'x'), "y"),
      short_datagram(std::string(100, 'x'), "y"),
      sim::Bytes(whole.begin(), whole.begin() + 19),
      sim::Bytes(whole.begin(), whole.begin() + 21),
      fragment_datagram({.message_bytes = 9, .count = 3, .channel = "", .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .count = 3, .channel = std::string(64, 'x'), .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .count = 0, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .number = 3, .count = 3, .payload = "abc"}),
      fragment_datagram({.message_bytes = 2, .count = 3, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .offset = 7, .count = 3, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .offset = 0xffffffff, .count = 3, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .offset = 0xfffffffe, .count = 3, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = 0xffffffff, .count = 3, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = (16u << 20) + 1, .count = 3, .channel = "a", .payload = "abc"}),
      // The first part is not where the message begins; the only part is not all of it.
      fragment_datagram({.message_bytes = 9, .offset = 1, .count = 3, .channel = "a", .payload = "abc"}),
      fragment_datagram({.message_bytes = 9, .count = 1, .channel = "a", .payload = "abc"}),
  };
  LcmReassembly reassembly;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_EQ(reported(reassembly, bad[i]), "") << i;
    EXPECT_EQ(reassembly.counts().bad, i + 1) << i;
  }
  EXPECT_EQ(reassembly.partial_messages(), 0u);
  EXPECT_EQ(reassembly.partial_bytes(), 0u);
}

TEST(LcmReassembly, FragmentsBecomeAMessageInAnyOrderAfterTheFirst) {
  std::vector<int> rest{1, 2};
  do {
    LcmReassembly reassembly;
    const auto datagrams = three_fragments();
    EXPECT_EQ(reported(reassembly, datagrams[0]), "");
    EXPECT_EQ(reported(reassembly, datagrams[static_cast<std::size_t>(rest[0])]), "");
    EXPECT_EQ(reported(reassembly, datagrams[static_cast<std::size_t>(rest[0])]), "") << "a repeated one";
    EXPECT_EQ(reported(reassembly, datagrams[static_cast<std::size_t>(rest[1])]), "a=abcdefghi");
    EXPECT_EQ(reassembly.partial_bytes(), 0u);
  } while (std::next_permutation(rest.begin(), rest.end()));
}

TEST(LcmReassembly, FragmentsBeforeTheOneThatNamesTheChannelAreDropped) {
  LcmReassembly reassembly;
  const auto datagrams = three_fragments();
  EXPECT_EQ(reported(reassembly, datagrams[1]), "");
  EXPECT_EQ(reported(reassembly, datagrams[0]), "");
  EXPECT_EQ(reported(reassembly, datagrams[2]), "");
  EXPECT_EQ(reported(reassembly, datagrams[1]), "a=abcdefghi");
  EXPECT_EQ(reassembly.counts().bad, 0u);
}

TEST(LcmReassembly, SendersAreKeptApartByAddressAndPort) {
  LcmReassembly reassembly;
  const DatagramSender elsewhere{0x0a000002, 5000};
  const auto ours = three_fragments(7, "abcdefghi"), theirs = three_fragments(7, "ABCDEFGHI");
  const auto thirds = three_fragments(7, "123456789");
  std::vector<std::string> messages;
  for (std::size_t i = 0; i < 3; ++i) {
    messages = {reported(reassembly, ours[i], sender), reported(reassembly, theirs[i], other),
                reported(reassembly, thirds[i], elsewhere)};
  }
  EXPECT_EQ(messages, (std::vector<std::string>{"a=abcdefghi", "a=ABCDEFGHI", "a=123456789"}));
}

TEST(LcmReassembly, ASenderThatStartsAgainBeginsANewMessage) {
  LcmReassembly reassembly;
  const auto before = three_fragments(7, "abcdefghi"), after = three_fragments(0, "ABCDEFGHI");
  reported(reassembly, before[0]);
  reported(reassembly, before[1]);
  reported(reassembly, after[0]);
  EXPECT_EQ(reported(reassembly, before[2]), "") << "of a message that was given up";
  EXPECT_EQ(reported(reassembly, after[1]), "");
  EXPECT_EQ(reported(reassembly, after[2]), "a=ABCDEFGHI");
  EXPECT_EQ(reassembly.counts().dropped, 1u);
}

TEST(LcmReassembly, PartsWithGapsOrOverlapsMakeNoMessage) {
  for (const std::uint32_t second_at : {2u, 4u}) {
    LcmReassembly reassembly;
    auto datagrams = three_fragments();
    datagrams[1] = fragment_datagram(
        {.sequence = 7, .message_bytes = 9, .offset = second_at, .number = 1, .count = 3, .payload = "def"});
    for (const sim::Bytes& datagram : datagrams) EXPECT_EQ(reported(reassembly, datagram), "");
    EXPECT_EQ(reassembly.partial_messages(), 0u) << "the message is given up";
    EXPECT_EQ(reassembly.counts().bad, 1u);
  }
}

TEST(LcmReassembly, HeadersThatContradictTheFirstOneAreNoPartOfTheMessage) {
  LcmReassembly reassembly;
  const auto datagrams = three_fragments();
  reported(reassembly, datagrams[0]);
  reported(
      reassembly,
      fragment_datagram({.sequence = 7, .message_bytes = 8, .offset = 3, .number = 1, .count = 3, .payload = "XYZ"}));
  reported(
      reassembly,
      fragment_datagram({.sequence = 7, .message_bytes = 9, .offset = 3, .number = 1, .count = 4, .payload = "XYZ"}));
  reported(
      reassembly,
      fragment_datagram({.sequence = 8, .message_bytes = 9, .offset = 3, .number = 1, .count = 3, .payload = "XYZ"}));
  reported(reassembly, datagrams[1]);
  EXPECT_EQ(reported(reassembly, datagrams[2]), "a=abcdefghi");
}

TEST(LcmReassembly, WhatNoOneWantsTakesNoMemory) {
  LcmReassembly reassembly;
  const auto nothing = [](std::string_view) { return false; };
  for (const sim::Bytes& datagram : three_fragments()) EXPECT_EQ(reported(reassembly, datagram, sender, nothing), "");
  EXPECT_EQ(reassembly.partial_bytes(), 0u);
}

TEST(LcmReassembly, TheLargestMessageComesWhole) {
  LcmReassembly reassembly;
  constexpr std::uint32_t size = 16u << 20, part = 65'000;
  const std::string text(size, 'x');
  const auto count = static_cast<std::uint16_t>((size + part - 1) / part);
  std::string message;
  for (std::uint16_t i = 0; i < count; ++i)
    message = reported(reassembly, fragment_datagram({.message_bytes = size,
                                                      .offset = i * part,
                                                      .number = i,
                                                      .count = count,
                                                      .channel = "a",
                                                      .payload = std::string_view(text).substr(i * part, part)}));
  EXPECT_EQ(message.size(), size + 2);
}

TEST(LcmReassembly, MemoryIsBoundedWhateverSendersBegin) {
  LcmReassembly::Limits limits;
  limits.max_partial_messages = 10;
  limits.max_partial_bytes = 3u << 20;
  LcmReassembly reassembly(limits);
  // Each claims 16 MiB, and the second fragment comes far too early.
  for (std::uint16_t port = 1; port < 1000; ++port) {
    for (const std::uint16_t number : {0, 200})
      reported(reassembly,
               fragment_datagram({.message_bytes = 16u << 20,
                                  .offset = number * 60'000u,
                                  .number = number,
                                  .count = 300,
                                  .channel = "a",
                                  .payload = std::string_view("xyz")}),
               {1, port});
    EXPECT_LE(reassembly.partial_messages(), 10u);
    EXPECT_LE(reassembly.partial_bytes(), limits.max_partial_bytes);
  }
  EXPECT_GT(reassembly.counts().dropped, 900u);
}

TEST(LcmReassembly, FragmentsThatComeTooEarlyAreBounded) {
  LcmReassembly::Limits limits;
  limits.max_early_bytes = 10'000;
  LcmReassembly reassembly(limits);
  const std::string part(1000, 'x');
  reported(reassembly, fragment_datagram({.message_bytes = 1'000'000, .count = 1000, .channel = "a", .payload = part}));
  for (std::uint16_t number = 2; number < 1000 && reassembly.partial_messages() > 0; ++number)
    reported(
        reassembly,
        fragment_datagram(
            {.message_bytes = 1'000'000, .offset = number * 1000u, .number = number, .count = 1000, .payload = part}));
  EXPECT_EQ(reassembly.partial_messages(), 0u);
  EXPECT_EQ(reassembly.partial_bytes(), 0u);
}

TEST(LcmReassembly, TheSenderThatIsBusyKeepsItsMessageBesideManyThatAreNot) {
  LcmReassembly::Limits limits;
  limits.max_partial_messages = 5;
  LcmReassembly reassembly(limits);
  const auto datagrams = three_fragments();
  std::uint16_t port = 1;
  std::string message;
  for (const sim::Bytes& datagram : datagrams) {
    message = reported(reassembly, datagram);
    for (int i = 0; i < 4; ++i) reported(reassembly, three_fragments()[0], {1, port++});
  }
  EXPECT_EQ(message, "a=abcdefghi");
}

TEST(LcmReassembly, RandomDatagramsDoNoHarm) {
  std::mt19937 random(1);
  LcmReassembly reassembly;
  const auto valid = three_fragments();
  for (int i = 0; i < 200'000; ++i) {
    sim::Bytes datagram = random() % 4 == 0 ? short_datagram("abc", "payload") : valid[random() % 3];
    for (auto changes = random() % 4; changes > 0; --changes)
      datagram[random() % datagram.size()] = static_cast<std::byte>(random());
    if (random() % 8 == 0) datagram.resize(random() % datagram.size());
    const auto message = reassembly.add(datagram, {1, static_cast<std::uint16_t>(random() % 4)});
    if (message) {
      EXPECT_GE(message->channel.size(), 1u);
      EXPECT_LE(message->channel.size(), 63u);
      EXPECT_EQ(message->channel.find('\0'), std::string_view::npos);
    }
  }
  EXPECT_LE(reassembly.partial_messages(), 4u);
}

}  // namespace
}  // namespace bridges
