// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "shoal/estimate_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "sim/image/image_file.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/viewer/film/film_of_a_log.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film_source.hpp"
#include "viewer/film/scene_painter.hpp"
#include "viewer/images/overview.hpp"

namespace {

using namespace film_of_a_log;

using test::driven_world;
using test::RecordedRun;
using testing::HasSubstr;

std::string png_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(FilmTest, ShowsTheRunOfALogWhereItWas) {
  record(driven_world());
  // The last sim.state of the record.
  shoal::sim_state_t state{};
  bridges::EventLogReader reader(log);
  while (const auto event = reader.next())
    if (event->channel == "sim.state") state = shoal::decode<shoal::sim_state_t>(event->payload, shoal::Finite::any);
  const auto source = viewer::open_film_source(log, {});
  const double step_s = sim::to_seconds(source->world().step_time());
  ASSERT_TRUE(source->advance_to(sim::from_seconds(static_cast<double>(test::steps) * step_s)));
  EXPECT_EQ(source->world().state().hash(), state_hash);
  EXPECT_FALSE(source->step());
  ASSERT_EQ(state.vehicle.size(), 1U);
  const sim::Vector3d p_W(state.position_m[0][0], state.position_m[0][1], state.position_m[0][2]);
  EXPECT_GT(p_W.x(), 0.3);
  // The segmentation shows the vehicle at the projection of this position, seen from above.
  viewer::SceneView view;
  view.optics.width = 160, view.optics.height = 120;
  view.options.kind = sim::ImageKind::groups;
  view.X_WS = viewer::look_at(p_W + sim::Vector3d(0.3, 0.2, 4), p_W + sim::Vector3d(0.3, 0.2, 0));
  view.antialias = 1;
  viewer::ScenePainter painter(source->world(), 2);
  const sim::Image8 image = painter.paint(view).image;
  const auto pixel = sim::Optics(view.optics).project(view.X_WS.inverse() * p_W);
  ASSERT_TRUE(pixel);
  const auto label = static_cast<std::uint16_t>(source->world().find_vehicle("r1")->group() + 1);
  const std::uint8_t* seen = image.at(static_cast<int>(pixel->x()), static_cast<int>(pixel->y()));
  const auto color = sim::label_color(label);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(seen[i], color[i]);
}

TEST_F(FilmTest, HasAFrameForEachStepOfTheFilmAndEqualFramesTwice) {
  record(driven_world());
  viewer::FilmOptions film = options("a/");
  film.from_s = 0.5;
  film.until_s = 1.5;
  film.speed = 0.5;
  const viewer::FilmOutcome outcome = viewer::make_film(film);
  EXPECT_EQ(outcome.frames, 21);  // 1 s of the run is 2 s of film, and both ends
  EXPECT_NEAR(outcome.sim_s, 1, 1e-9);
  film.out = folder.file("b/");
  film.threads = 1;
  viewer::make_film(film);
  for (const char* frame : {"frame_00000.png", "frame_00011.png", "frame_00020.png"})
    EXPECT_EQ(png_text(folder.file("a/") + frame), png_text(folder.file("b/") + frame)) << frame;
  EXPECT_NE(png_text(folder.file("a/frame_00000.png")), png_text(folder.file("a/frame_00020.png")));
}

TEST_F(FilmTest, EndsWithTheLog) {
  record(driven_world());
  viewer::FilmOptions film = options("a.avi");
  film.until_s = 100;
  EXPECT_EQ(viewer::make_film(film).frames, 31);
  film.from_s = 50;
  EXPECT_THAT(film_error(film), HasSubstr("ends at 3 s, before --from"));
}

TEST_F(FilmTest, DrawsTheEstimatesOfTheLog) {
  const auto with_estimates = [this] {
    RecordedRun run(driven_world("metrics: [{name: error, type: position_error, vehicle: r1, channel: r1.estimate}]\n"),
                    log);
    const auto mailbox = run.gate.open_mailbox("r1.estimate");
    run.run(test::steps, [&](std::int64_t step) {
      shoal::estimate_t estimate{};
      estimate.utime = run.world.epoch_us() + run.world.now().count();
      estimate.position_m[1] = 0.5;
      for (const int i : {0, 4, 8}) estimate.covariance_m2[i] = 0.01;
      if (step % 10 == 0) run.send("r1.estimate", estimate);
    });
  };
  with_estimates();
  const viewer::LogEstimates estimates(log, 0, 10, 0.05);
  const viewer::LogEstimate* found = estimates.find("r1", 1.05, 1);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->time_s, 1, 0.11);
  EXPECT_EQ(found->position_m, sim::Vector3d(0, 0.5, 0));
  EXPECT_EQ(estimates.find("r1", 20, 1), nullptr);
  EXPECT_EQ(estimates.find("r2", 1, 1), nullptr);
  EXPECT_EQ(estimates.vehicles(), std::vector<std::string>{"r1"});
  // The image differs by them.
  viewer::FilmOptions film = options("with/");
  film.until_s = film.from_s = 1;
  film.cameras = {"top"};
  viewer::make_film(film);
  film.out = folder.file("without/");
  film.overlays.ellipses = false;
  viewer::make_film(film);
  EXPECT_NE(png_text(folder.file("with/frame_00000.png")), png_text(folder.file("without/frame_00000.png")));
}

}  // namespace
