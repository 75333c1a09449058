// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_writer.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>

#include <iterator>

#include "bridges/base/bus_error.hpp"
#include "bridges/mcap/mcap_reader.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/mcap/mcap_files.hpp"

namespace {

using namespace mcap_files;
using namespace bridges::mcap;

using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using testing::ElementsAre;

TEST(McapWriter, WritesTheMagicAtBothEndsAndAFooter) {
  const ScratchFolder folder;
  write_file(folder.file("a.mcap"), 10);
  const std::string content = content_of(folder.file("a.mcap"));
  const std::string mark("\x89MCAP0\r\n", 8);
  EXPECT_TRUE(content.starts_with(mark));
  EXPECT_TRUE(content.ends_with(mark));
  // The footer has 20 bytes behind its opcode and length; the summary starts with a schema.
  const std::size_t footer = content.size() - 8 - 20 - 9;
  EXPECT_EQ(content[footer], 2);
  EXPECT_EQ(number_at<std::uint64_t>(content, footer + 1), 20u);
  const auto summary = number_at<std::uint64_t>(content, footer + 9);
  const auto offsets = number_at<std::uint64_t>(content, footer + 17);
  EXPECT_EQ(content[summary], 3);
  EXPECT_EQ(content[offsets], 14);
  // In front of the summary is the end of the data: an opcode, a length of 4 and a checksum.
  EXPECT_EQ(content[summary - 13], 15);
}

TEST(McapWriter, ReadsBackWhatItWrote) {
  const ScratchFolder folder;
  write_file(folder.file("a.mcap"), 3);
  McapReader reader(folder.file("a.mcap"));
  EXPECT_EQ(reader.next(), McapReader::Item::metadata);
  EXPECT_EQ(reader.profile(), "ros2");
  EXPECT_EQ(reader.metadata().entries.at("seed"), "7");
  EXPECT_EQ(reader.next(), McapReader::Item::attachment);
  EXPECT_EQ(reader.attachment().data, "name: x\n");
  EXPECT_EQ(reader.next(), McapReader::Item::message);
  EXPECT_EQ(reader.channel(reader.message().channel).topic, "/b");
  EXPECT_EQ(reader.next(), McapReader::Item::message);
  EXPECT_EQ(reader.message().log_time_ns, 1'000'000u);
  EXPECT_EQ(reader.message().sequence, 0u);
  const Channel& channel = reader.channel(reader.message().channel);
  EXPECT_EQ(channel.metadata.at("key"), "value");
  EXPECT_EQ(reader.schemas().at(channel.schema).text, "int32 x\n");
  EXPECT_EQ(reader.next(), McapReader::Item::message);
  EXPECT_EQ(reader.message().sequence, 1u);
  EXPECT_EQ(reader.next(), McapReader::Item::end);
  EXPECT_TRUE(reader.complete());
  EXPECT_THAT(reader.problems(), ElementsAre());
}

TEST(McapWriter, EndsAChunkAfterOneMebibyteOrFiveSeconds) {
  const ScratchFolder folder;
  const auto chunks = [&](std::uint64_t period_ns, std::size_t bytes, int count) {
    {
      McapWriter writer(file_at(folder.file("a.mcap")));
      const std::uint16_t channel = writer.add_channel({0, "/a", "lcm", {}});
      const sim::Bytes data(bytes);
      for (int i = 0; i < count; ++i)
        EXPECT_TRUE(writer.write(channel, period_ns * static_cast<std::uint64_t>(i), data));
      EXPECT_TRUE(writer.finish());
    }
    // Statistics, opcode 11, precede the chunk indexes in the summary; the count of chunks is at byte 22 of 24 + ...
    const std::string content = content_of(folder.file("a.mcap"));
    std::size_t at = number_at<std::uint64_t>(content, content.size() - 8 - 20);
    while (content[at] != 11) at += 9 + number_at<std::uint64_t>(content, at + 1);
    return number_at<std::uint32_t>(content, at + 9 + 8 + 2 + 4 + 4 + 4);
  };
  EXPECT_EQ(chunks(1'000'000'000, 10, 5), 1u);  // 0 to 4 s
  EXPECT_EQ(chunks(1'000'000'000, 10, 6), 2u);  // the sixth is 5 s after the first
  EXPECT_EQ(chunks(1, 1 << 18, 3), 1u);         // less than 1 MiB
  EXPECT_EQ(chunks(1, 1 << 18, 4), 2u);         // with the heads of the records more
  EXPECT_EQ(chunks(1, (1 << 21), 3), 3u);       // one message each
}

TEST(McapWriter, EqualCallsWriteEqualBytes) {
  const ScratchFolder folder;
  write_file(folder.file("a.mcap"), 30'000);
  write_file(folder.file("b.mcap"), 30'000);
  EXPECT_TRUE(content_of(folder.file("a.mcap")) == content_of(folder.file("b.mcap")));
}

TEST(McapWriter, AFullDiskIsReported) {
  McapWriter writer(bridges::FileDescriptor(open("/dev/full", O_WRONLY | O_CLOEXEC)));
  const std::uint16_t channel = writer.add_channel({0, "/a", "lcm", {}});
  writer.write(channel, 0, bytes_of("x"));
  EXPECT_FALSE(writer.finish());
  EXPECT_FALSE(writer.finish());
}

}  // namespace
