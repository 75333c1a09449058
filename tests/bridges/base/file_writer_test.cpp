// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/file_writer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace bridges {
namespace {

using lcm_test::ScratchFolder;

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

FileWriter::Block block_of(std::string_view text) {
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  return {{bytes, bytes + text.size()}, text.size()};
}

TEST(FileWriter, WritesBlocksInTheOrderInWhichTheyWereHandedOver) {
  const ScratchFolder folder;
  const std::string path = folder.file("out");
  std::string expected;
  {
    FileWriter writer(FileDescriptor(open(path.c_str(), O_WRONLY | O_CREAT, 0666)));
    for (int i = 0; i < 1000; ++i) {
      const std::string text = std::to_string(i) + " ";
      FileWriter::Block block = block_of(text);
      ASSERT_TRUE(writer.hand_over(block));
      EXPECT_EQ(block.used, 0u);
      expected += text;
      if (i == 500) {
        ASSERT_TRUE(writer.finish());
        EXPECT_EQ(contents(path), expected) << "finish() waits until all is in the file";
      }
    }
  }
  EXPECT_EQ(contents(path), expected) << "the writer writes what is left before it goes away";
}

TEST(FileWriter, WritesOnlyTheUsedPartOfABlock) {
  const ScratchFolder folder;
  const std::string path = folder.file("out");
  FileWriter writer(FileDescriptor(open(path.c_str(), O_WRONLY | O_CREAT, 0666)));
  FileWriter::Block block = block_of("seen, not seen");
  block.used = 4;
  ASSERT_TRUE(writer.hand_over(block) && writer.finish());
  EXPECT_EQ(contents(path), "seen");
}

TEST(FileWriter, LosesNothingWhenTheFileIsSlowerThanWhatComes) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  std::string got;
  std::thread reader([&got, end = pipe_ends[0]] {  // a pipe holds 64 kB: the writer has to wait for it
    char part[4096];
    for (ssize_t size = 0; (size = read(end, part, sizeof part)) > 0;) got.append(part, static_cast<std::size_t>(size));
    close(end);
  });
  std::string expected;
  {
    FileWriter writer{FileDescriptor(pipe_ends[1])};
    for (int i = 0; i < 50; ++i) {
      const std::string text(100'000, static_cast<char>('a' + i % 26));
      FileWriter::Block block = block_of(text);
      ASSERT_TRUE(writer.hand_over(block));
      expected += text;
    }
  }
  reader.join();
  EXPECT_EQ(got, expected);
}

TEST(FileWriter, SaysThatTheDiskIsFullWhenItIsWaitedForAndEverAfter) {
  FileWriter writer(FileDescriptor(open("/dev/full", O_WRONLY)));
  FileWriter::Block block = block_of("no room");
  EXPECT_TRUE(writer.hand_over(block)) << "nothing is known yet";
  EXPECT_FALSE(writer.finish());
  EXPECT_EQ(errno, ENOSPC);
  block = block_of("more");
  EXPECT_FALSE(writer.hand_over(block));
  EXPECT_EQ(errno, ENOSPC);
}

TEST(FileWriter, WritesNothingThatWaitedWhileABlockFailed) {
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  const FileDescriptor reader(ends[1]);
  const timeval timeout{0, 300'000};  // then a write fails
  ASSERT_EQ(setsockopt(ends[0], SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout), 0);
  FileWriter writer{FileDescriptor(ends[0])};
  FileWriter::Block block = block_of(std::string(4'000'000, 'a'));  // more than the socket holds
  ASSERT_TRUE(writer.hand_over(block));
  block = block_of("b");
  ASSERT_TRUE(writer.hand_over(block));
  block = block_of("c");
  EXPECT_FALSE(writer.hand_over(block)) << "waits until the first has failed";
  std::string got;
  std::array<char, 65536> part{};
  for (pollfd readable{reader.number(), POLLIN, 0}; poll(&readable, 1, 500) == 1;) {
    const ssize_t size = read(reader.number(), part.data(), part.size());
    if (size <= 0) break;
    got.append(part.data(), static_cast<std::size_t>(size));
  }
  EXPECT_EQ(std::count(got.begin(), got.end(), 'a'), static_cast<std::ptrdiff_t>(got.size()));
}

}  // namespace
}  // namespace bridges
