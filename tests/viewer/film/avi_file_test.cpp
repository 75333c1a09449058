// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/avi_file.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <iterator>

#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/film/film_frames.hpp"
#include "viewer/film/encoder_program.hpp"
#include "viewer/film/film_writer.hpp"

namespace {

using namespace film_frames;

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

TEST(FilmWriter, WritesAnAviWhoseHeaderAndIndexDescribeItsFrames) {
  const test_support::ScratchFolder folder;
  write_frames(folder.file("a.avi"), 5);
  const std::string bytes = film_bytes(folder.file("a.avi"));
  ASSERT_EQ(bytes.substr(0, 4) + bytes.substr(8, 4), "RIFFAVI ");
  EXPECT_EQ(number_at(bytes, 4), bytes.size() - 8);
  const std::size_t main = bytes.find("avih") + 8;
  EXPECT_EQ(number_at(bytes, main + 16), 5U);
  EXPECT_EQ(number_at(bytes, main + 32), 64U);
  EXPECT_EQ(number_at(bytes, main + 36), 48U);
  // Each entry of the index leads to a JPEG of its level.
  const std::size_t movi = bytes.find("movi"), index = bytes.rfind("idx1") + 8;
  ASSERT_EQ(number_at(bytes, index - 4), 5U * 16);
  for (std::size_t i = 0; i < 5; ++i) {
    const std::size_t at = movi + number_at(bytes, index + 16 * i + 8);
    EXPECT_EQ(bytes.substr(at, 4), "00dc");
    const std::string jpeg = bytes.substr(at + 8, number_at(bytes, index + 16 * i + 12));
    const sim::Image8 frame = sim::decode_image(std::as_bytes(std::span(jpeg)));
    EXPECT_EQ(frame.width, 64);
    EXPECT_NEAR(frame.data[0], 20 * static_cast<int>(i), 2);
  }
  EXPECT_EQ(files_in(folder.file("")), 1U);
}

TEST(FilmWriter, LeavesNothingBehindThatIsNotFinished) {
  const test_support::ScratchFolder folder;
  for (const char* name : {"a.avi", "b.png", "frames/"}) write_frames(folder.file(name), 3, false);
  EXPECT_EQ(files_in(folder.file("frames")), 0U);
  EXPECT_EQ(files_in(folder.file("")), 1U);  // the folder
}

}  // namespace
