// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_writer.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/film/encoder_program.hpp"

namespace {

using testing::HasSubstr;

sim::Image8 grey_frame(int level) {
  sim::Image8 frame(64, 48, 3);
  std::fill(frame.data.begin(), frame.data.end(), static_cast<std::uint8_t>(level));
  return frame;
}

std::string film_bytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

void write_frames(const std::string& file, int frames, bool finish = true) {
  const auto writer = viewer::make_film_writer(file, {64, 48, 30});
  for (int i = 0; i < frames; ++i) writer->add(grey_frame(20 * i));
  if (finish) writer->finish();
}

/// Puts a script in place of ffmpeg while it exists.
class OtherEncoder {
 public:
  explicit OtherEncoder(const std::string& script) {
    std::ofstream(folder_.file("ffmpeg")) << "#!/bin/sh\n" << script << '\n';
    chmod(folder_.file("ffmpeg").c_str(), 0755);
    setenv("PATH", (folder_.file("") + ":" + before_).c_str(), 1);
    signal(SIGPIPE, SIG_IGN);
  }
  ~OtherEncoder() { setenv("PATH", before_.c_str(), 1); }
  OtherEncoder(const OtherEncoder&) = delete;
  OtherEncoder& operator=(const OtherEncoder&) = delete;

 private:
  test_support::ScratchFolder folder_;
  std::string before_ = std::getenv("PATH");
};

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

TEST(FilmWriter, NumbersImages) {
  const test_support::ScratchFolder folder;
  write_frames(folder.file("b.png"), 2);
  write_frames(folder.file("frames/"), 3);
  EXPECT_EQ(sim::read_image(folder.file("b_00001.png")).data[0], 20);
  EXPECT_EQ(sim::read_image(folder.file("frames/frame_00002.png")).data[0], 40);
}

TEST(FilmWriter, NamesWhatIsWrongBeforeTheWork) {
  const test_support::ScratchFolder folder;
  const viewer::FilmFormat format{64, 48, 30};
  EXPECT_THROW(viewer::check_film_file(folder.file("a.mov"), format), std::invalid_argument);
  EXPECT_THROW(viewer::check_film_file(folder.file("no/a.avi"), format), viewer::FilmError);
  const OtherEncoder encoder("exit 0");
  EXPECT_THROW(viewer::check_film_file(folder.file("a.mp4"), {63, 48, 30}), std::invalid_argument);
  setenv("PATH", "/nowhere", 1);
  try {
    viewer::check_film_file(folder.file("a.mp4"), format);
    FAIL() << "no error";
  } catch (const viewer::FilmError& error) {
    EXPECT_THAT(error.what(), HasSubstr("needs the program ffmpeg"));
  }
}

TEST(FilmWriter, ReportsTheLastWordsOfAnEncoderThatFails) {
  const test_support::ScratchFolder folder;
  const OtherEncoder encoder("for last; do :; done\necho half > \"${last#file:}\"\necho 'No space left' >&2\nexit 3");
  try {
    write_frames(folder.file("a.mp4"), 400);
    FAIL() << "no error";
  } catch (const viewer::FilmError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.mp4: ffmpeg ended with exit code 3: No space left"));
  }
  EXPECT_EQ(files_in(folder.file("")), 0U);
}

TEST(FilmWriter, ReportsAnEncoderThatWasKilled) {
  const test_support::ScratchFolder folder;
  const OtherEncoder encoder("kill -KILL $$");
  try {
    write_frames(folder.file("a.webm"), 400);
    FAIL() << "no error";
  } catch (const viewer::FilmError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ffmpeg was ended by signal 9"));
  }
  EXPECT_EQ(files_in(folder.file("")), 0U);
}

TEST(FilmWriter, GivesTheEncoderEveryFrame) {
  const test_support::ScratchFolder folder;
  const OtherEncoder encoder("for last; do :; done\ncat > \"${last#file:}\"");
  write_frames(folder.file("a.mp4"), 12);
  const std::string bytes = film_bytes(folder.file("a.mp4"));
  EXPECT_EQ(bytes.size(), 12U * 64 * 48 * 3);
  EXPECT_EQ(static_cast<unsigned char>(bytes.back()), 220);
  EXPECT_EQ(files_in(folder.file("")), 1U);
}

}  // namespace
