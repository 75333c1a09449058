// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_reader.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "bridges/base/bus_error.hpp"
#include "bridges/mcap/mcap_writer.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/mcap/mcap_files.hpp"

namespace {

using namespace mcap_files;
using namespace bridges::mcap;

using lcm_test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

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
