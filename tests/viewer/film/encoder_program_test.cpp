// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/encoder_program.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include "tests/scratch_folder.hpp"
#include "tests/viewer/film/film_frames.hpp"
#include "viewer/film/film_writer.hpp"

namespace {

using namespace film_frames;

using testing::HasSubstr;

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
