// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_message.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/moos/small_moosdb.hpp"

namespace {

using bridges::MoosError;
using bridges::MoosMessage;
using bridges::MoosPacketReader;
using bridges::MoosType;
using testing::HasSubstr;

std::span<const std::byte> moos_bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::string error_of(const std::string& bytes) {
  try {
    MoosPacketReader().add(moos_bytes(bytes));
    return "none";
  } catch (const MoosError& error) {
    return error.what();
  }
}

TEST(MoosMessage, IsOnTheWireAsTheProtocolSays) {
  MoosMessage message;
  message.key = "NAV_X";
  message.number = 2;
  message.source = "a";
  message.time_s = 1;
  message.id = 5;
  const std::vector<std::byte> bytes = bridges::encode_moos_packet({&message, 1});
  // Message: length 4, id 4, two characters, texts 4+1, 4, 4, 4+5, numbers 3 x 8, text 4; before it length, count,
  // flag: 9.
  ASSERT_EQ(bytes.size(), 9U + 60U);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_EQ(moos_test::int_at(text, 0), 69U);
  EXPECT_EQ(moos_test::int_at(text, 4), 1U);
  EXPECT_EQ(text[8], 0);
  EXPECT_EQ(moos_test::int_at(text, 9), 60U);
  EXPECT_EQ(moos_test::int_at(text, 13), 5U);
  EXPECT_EQ(text.substr(17, 2), "ND");
  EXPECT_EQ(text.substr(19 + 4, 1), "a");
  EXPECT_EQ(moos_test::double_at(text, 19 + 5 + 4 + 4 + 9), 1);
  EXPECT_EQ(moos_test::double_at(text, 19 + 5 + 4 + 4 + 9 + 8), 2);
}

TEST(MoosMessage, OfAnotherProgramIsRead) {
  moos_test::Msg sent{'N', 'S', "NODE_MESSAGE", 0, "src_node=b"};
  sent.community = "alpha";
  sent.source = "pHelmIvP";
  const auto messages = MoosPacketReader().add(moos_bytes(moos_test::packet({sent, {'T', 'D', "_async_timing", 3.5}})));
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].key, "NODE_MESSAGE");
  EXPECT_EQ(messages[0].text, "src_node=b");
  EXPECT_EQ(messages[0].value_type, 'S');
  EXPECT_EQ(messages[0].community, "alpha");
  EXPECT_EQ(messages[0].source, "pHelmIvP");
  EXPECT_EQ(messages[1].type, MoosType::timing);
  EXPECT_EQ(messages[1].number, 3.5);
}

TEST(MoosMessage, ComesInAnyPieces) {
  const std::string bytes = moos_test::packet({{'N', 'D', "A", 1}}) + moos_test::packet({{'N', 'D', "B", 2}});
  MoosPacketReader reader;
  std::string keys;
  for (const char byte : bytes)
    for (const MoosMessage& message : reader.add(moos_bytes(std::string(1, byte)))) keys += message.key;
  EXPECT_EQ(keys, "AB");
}

TEST(MoosMessage, OfAHostilePeerIsRefusedWithTheReason) {
  std::string bytes = moos_test::packet({{'N', 'D', "A", 1}});
  const auto with = [&](std::size_t at, std::uint32_t number) {
    std::string changed = bytes, four;
    moos_test::put_int(four, number);
    return changed.replace(at, 4, four);
  };
  EXPECT_THAT(error_of(with(0, 8)), HasSubstr("a packet of MOOS has a length of 8"));
  EXPECT_THAT(error_of(with(0, 0x7fffffff)), HasSubstr("a packet of MOOS has a length of 2147483647"));
  EXPECT_THAT(error_of(with(4, 1000)), HasSubstr("and 1000 messages"));
  EXPECT_THAT(error_of(with(4, 0xffffffff)), HasSubstr("and -1 messages"));
  EXPECT_THAT(error_of(with(9, 20)), HasSubstr("a message of MOOS has a length of 20"));
  EXPECT_THAT(error_of(with(9, 5000)), HasSubstr("ends within a value"));
  EXPECT_THAT(error_of(with(19, 0x40000000)), HasSubstr("ends within a value"));  // the length of the source
  EXPECT_THAT(error_of(with(19, 0x80000000)), HasSubstr("a text of MOOS has a length of -2147483648"));
  bytes[8] = 1;
  EXPECT_THAT(error_of(bytes), HasSubstr("compressed"));
}

}  // namespace
