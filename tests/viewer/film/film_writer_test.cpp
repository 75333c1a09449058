// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_writer.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <cstdlib>

#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/film/film_frames.hpp"
#include "viewer/film/encoder_program.hpp"

namespace {

using namespace film_frames;

using testing::HasSubstr;

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

}  // namespace
