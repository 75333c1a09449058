// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_writer.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "bridges/base/bus_error.hpp"
#include "bridges/mcap/mcap_reader.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges::mcap;
using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

bridges::FileDescriptor file_at(const std::string& path) {
  return bridges::FileDescriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void store(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

/// Texts of all messages that can be read: `time topic data`.
std::vector<std::string> messages_of(const std::string& path, std::vector<std::string>* problems = nullptr) {
  McapReader reader(path);
  std::vector<std::string> texts;
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;) {
    if (item != McapReader::Item::message) continue;
    const Message& message = reader.message();
    texts.push_back(std::to_string(message.log_time_ns) + " " + reader.channel(message.channel).topic + " " +
                    std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size()));
  }
  if (problems != nullptr) *problems = reader.problems();
  return texts;
}

/// Two channels, and `count` messages of 100 bytes, one each millisecond.
void write_file(const std::string& path, int count) {
  McapWriter writer(file_at(path));
  const std::uint16_t schema = writer.add_schema({"p/msg/A", "ros2msg", "int32 x\n"});
  const std::uint16_t a = writer.add_channel({schema, "/a", "cdr", {{"key", "value"}}});
  const std::uint16_t b = writer.add_channel({0, "/b", "lcm", {}});
  EXPECT_TRUE(writer.write(Metadata{"shoal", {{"seed", "7"}}}));
  EXPECT_TRUE(writer.write(Attachment{1, 2, "world.yaml", "application/yaml", "name: x\n"}));
  std::mt19937 random(1);
  for (int i = 0; i < count; ++i) {
    std::string text = std::to_string(i);
    while (text.size() < 100) text += static_cast<char>('a' + random() % 26);
    EXPECT_TRUE(writer.write(i % 3 == 0 ? b : a, 1'000'000 * static_cast<std::uint64_t>(i), bytes_of(text)));
  }
  EXPECT_TRUE(writer.finish());
}

template <class T>
T number_at(const std::string& content, std::size_t at) {
  T value{};
  std::memcpy(&value, content.data() + at, sizeof value);
  return value;
}

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

// Random contents compress badly, so that the file is cut in the middle of chunks too.
TEST(McapReader, AFileThatIsCutOffAnywhereHasItsFirstMessages) {
  const ScratchFolder folder;
  write_file(folder.file("a.mcap"), 10'000);
  const std::string content = content_of(folder.file("a.mcap"));
  const std::vector<std::string> all = messages_of(folder.file("a.mcap"));
  ASSERT_EQ(all.size(), 10'000u);
  std::mt19937_64 random(3);
  std::size_t in_the_middle = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t size = 8 + random() % (content.size() - 8);
    store(folder.file("cut.mcap"), content.substr(0, size));
    std::vector<std::string> problems;
    const std::vector<std::string> read = messages_of(folder.file("cut.mcap"), &problems);
    ASSERT_LE(read.size(), all.size()) << size;
    ASSERT_TRUE(std::equal(read.begin(), read.end(), all.begin())) << size;
    ASSERT_EQ(problems.size(), 1u) << size << " of " << content.size();
    // A message has 131 bytes; zstd writes blocks of 128 KiB, the last of which may be lost.
    const double part = static_cast<double>(size) / static_cast<double>(content.size());
    EXPECT_GT(static_cast<double>(read.size()), 10'000 * part * 0.9 - 2 * 131072.0 / 131) << size;
    in_the_middle += !read.empty() && read.size() < all.size();
  }
  EXPECT_GT(in_the_middle, 800u);
}

TEST(McapReader, ADamagedFileHasOneProblemForEachDamage) {
  const ScratchFolder folder;
  write_file(folder.file("a.mcap"), 3000);
  const std::string content = content_of(folder.file("a.mcap"));
  std::mt19937_64 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = content;
    // The data section; a damaged summary is not read.
    const std::size_t data_bytes = number_at<std::uint64_t>(content, content.size() - 8 - 20);
    damaged[8 + random() % (data_bytes - 8)] ^= static_cast<char>(1 << random() % 8);
    store(folder.file("bad.mcap"), damaged);
    std::vector<std::string> problems;
    EXPECT_LE(messages_of(folder.file("bad.mcap"), &problems).size(), 3000u);
    EXPECT_FALSE(problems.empty()) << i;
  }
}

TEST(McapReader, RefusesOtherFiles) {
  const ScratchFolder folder;
  store(folder.file("empty"), "");
  store(folder.file("text"), "name: world\n");
  for (const char* name : {"empty", "text"}) EXPECT_THROW(McapReader(folder.file(name)), bridges::BusError) << name;
  EXPECT_THROW(McapReader(folder.file("missing")), bridges::BusError);
  EXPECT_THROW(McapReader("/dev/null"), bridges::BusError);
}

TEST(McapReader, EndsWhereItsSchemasTakeTooMuchMemory) {
  const ScratchFolder folder;
  const std::string path = folder.file("bomb.mcap");
  McapWriter writer(file_at(path));
  constexpr int schemas = 6;
  const std::string text(max_kept_bytes / 4, ' ');
  for (int i = 0; i < schemas; ++i) {
    const std::uint16_t schema = writer.add_schema({"Type" + std::to_string(i), "ros2msg", text});
    const std::uint16_t channel = writer.add_channel({schema, "/t" + std::to_string(i), "cdr", {}});
    EXPECT_TRUE(writer.write(channel, 1, {}));
  }
  EXPECT_TRUE(writer.finish());
  std::vector<std::string> problems;
  EXPECT_EQ(messages_of(path, &problems).size(), 3u);  // with its name the fourth schema is beyond four quarters
  EXPECT_THAT(problems, ElementsAre(HasSubstr("its schemas and channels have more than 64 MB together")));
}

TEST(McapReader, DoesNotAllocateWhatALengthClaims) {
  const ScratchFolder folder;
  std::vector<std::byte> file;
  RecordBuilder out(file);
  out.bytes(std::as_bytes(std::span(magic)));
  out.number(static_cast<std::uint8_t>(Opcode::metadata));
  out.number(~std::uint64_t{0});
  store(folder.file("long"), std::string(reinterpret_cast<const char*>(file.data()), file.size()));
  std::vector<std::string> problems;
  EXPECT_THAT(messages_of(folder.file("long"), &problems), ElementsAre());
  EXPECT_THAT(problems, ElementsAre(HasSubstr("the file is cut off")));
}

}  // namespace
