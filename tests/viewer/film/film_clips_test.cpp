// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_clips.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "bridges/view/view_publisher.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"

namespace {

using testing::HasSubstr;

class FilmClips : public test::ReplayTest {
 protected:
  /// A run of 3 s with two events, of which the second has the name of the vehicle in its text.
  void record_events(const std::string& more = "") {
    test::RecordedRun run(test::driven_world("events:\n  - {name: half, at: 1, do: [{log: half way}]}\n"
                                             "  - {name: late, at: 2.5, do: [{log: r1 is late}]}\n" +
                                             more),
                          log);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    run.run(test::steps, [&](std::int64_t step) {
      if (step % 10 == 0) run.send("r1.drive.cmd", test::forward(0.5));
      view.after_step();
    });
  }
  viewer::FilmOptions film() const {
    viewer::FilmOptions film;
    film.source = log;
    film.format = {80, 60, 10};
    film.overlays = viewer::parse_overlays("labels,clock");
    film.quiet = true;
    film.threads = 1;
    return film;
  }
  viewer::ClipOptions clips() const {
    viewer::ClipOptions clips;
    clips.directory = folder.file("clips");
    clips.ending = ".avi";
    clips.before_s = 0.5;
    clips.after_s = 0.5;
    return clips;
  }
  std::string error_of(const viewer::ClipOptions& options) const {
    try {
      viewer::make_clips(film(), options);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(FilmClips, AreNamedByTimeAndEventAndFollowItsVehicle) {
  record_events();
  viewer::ClipOutcome outcome;
  const auto clips = find_clips(log, FilmClips::clips(), outcome);
  ASSERT_GE(clips.size(), 2U);
  EXPECT_EQ(clips.size(), 2U) << "what an event logs belongs to it";
  EXPECT_THAT(clips[0].file, HasSubstr("clips/000001.0"));
  EXPECT_THAT(clips[0].file, HasSubstr("s_event_half.avi"));
  EXPECT_EQ(clips[0].vehicle, "");
  EXPECT_NEAR(clips[0].at_s, 1, 0.02);
  EXPECT_NEAR(clips[0].from_s, 0.5, 0.02);
  EXPECT_NEAR(clips[0].to_s, 1.5, 0.02);
  EXPECT_THAT(clips[1].file, HasSubstr("s_event_late.avi"));
  EXPECT_EQ(clips[1].vehicle, "r1");
}

TEST_F(FilmClips, HaveTheFramesAroundTheirEvents) {
  record_events();
  const viewer::ClipOutcome outcome = viewer::make_clips(film(), clips());
  ASSERT_GE(outcome.clips.size(), 2U);
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_GE(outcome.frames, 20);
  EXPECT_LE(outcome.frames, 11 * static_cast<std::int64_t>(outcome.clips.size()));
  for (const viewer::Clip& clip : outcome.clips) EXPECT_GT(std::filesystem::file_size(clip.file), 1000U) << clip.file;
  EXPECT_THAT(outcome.to_text(), HasSubstr("follows r1"));
}

TEST_F(FilmClips, AreBoundedInNumber) {
  record_events();
  viewer::ClipOptions options = clips();
  options.max_clips = 1;
  const viewer::ClipOutcome outcome = viewer::make_clips(film(), options);
  EXPECT_EQ(outcome.clips.size(), 1U);
  EXPECT_EQ(outcome.without, outcome.events - 2) << "the clip has the event and what it logged";
  EXPECT_THAT(outcome.to_text(), HasSubstr("have no clip: the limits are --max-clips"));
}

TEST_F(FilmClips, SayWhyThereAreNone) {
  record(test::driven_world());
  EXPECT_THAT(error_of(clips()), HasSubstr("has no events (sim.event)"));
  log = folder.file("world.yaml");
  EXPECT_THAT(error_of(clips()), HasSubstr("is not a log"));
}

}  // namespace
