// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/background_writer.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace {

using testing::ElementsAre;

/// Writer that notes the first value of each frame, and fails at one of them.
class NotingWriter final : public viewer::FilmWriter {
 public:
  NotingWriter(std::vector<int>& notes, int fails_at) : notes_(notes), fails_at_(fails_at) {}
  void add(const sim::Image8& frame) override {
    if (frame.data[0] == fails_at_) throw viewer::FilmError("full");
    notes_.push_back(frame.data[0]);
  }
  void finish() override { notes_.push_back(-1); }

 private:
  std::vector<int>& notes_;
  int fails_at_;
};

void write_frames(viewer::FilmWriter& writer, int frames) {
  sim::Image8 frame(1, 1, 3);
  for (int i = 0; i < frames; ++i) {
    frame.data[0] = static_cast<std::uint8_t>(i);
    writer.add(frame);
  }
}

TEST(BackgroundWriter, WritesAllFramesInTheirOrder) {
  std::vector<int> notes;
  viewer::BackgroundWriter writer(std::make_unique<NotingWriter>(notes, 99));
  write_frames(writer, 5);
  writer.finish();
  EXPECT_THAT(notes, ElementsAre(0, 1, 2, 3, 4, -1));
}

TEST(BackgroundWriter, ThrowsTheErrorOfTheEncoder) {
  std::vector<int> notes;
  {
    viewer::BackgroundWriter writer(std::make_unique<NotingWriter>(notes, 2));
    EXPECT_THROW(write_frames(writer, 100), viewer::FilmError);
    EXPECT_THROW(writer.finish(), viewer::FilmError);
  }
  EXPECT_THAT(notes, ElementsAre(0, 1));
}

TEST(BackgroundWriter, DoesNotFinishAFilmThatIsGivenUp) {
  std::vector<int> notes;
  {
    viewer::BackgroundWriter writer(std::make_unique<NotingWriter>(notes, 99));
    write_frames(writer, 5);
  }
  EXPECT_THAT(notes, testing::Not(testing::Contains(-1)));
}

}  // namespace
