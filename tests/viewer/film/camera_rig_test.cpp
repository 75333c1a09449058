// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/camera_rig.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "sim/image/image_file.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/viewer/film/film_of_a_log.hpp"
#include "viewer/film/film.hpp"
#include "viewer/film/film_source.hpp"
#include "viewer/film/scene_painter.hpp"
#include "viewer/images/overview.hpp"

namespace {

using namespace film_of_a_log;

using test::driven_world;
using testing::HasSubstr;

TEST_F(FilmTest, NamesVehiclesAndCamerasThatAreMissing) {
  record(driven_world());
  const auto with_camera = [&](const std::string& camera) {
    viewer::FilmOptions film = options("a.avi");
    film.cameras = {camera};
    return film_error(film);
  };
  EXPECT_THAT(with_camera("chase:r9"), HasSubstr("there is no vehicle 'r9' at 0.000 s; vehicles: r1"));
  EXPECT_THAT(with_camera("from:r1/eye"), HasSubstr("there is no camera 'r1/eye'; this world has none"));
  EXPECT_THAT(with_camera("chase"), HasSubstr("must be all, top,"));
  EXPECT_THAT(with_camera("no.yaml"), HasSubstr("no.yaml"));
  viewer::FilmOptions film = options("a.avi");
  film.split = true;
  EXPECT_THAT(film_error(film), HasSubstr("vehicle 'r1' has no camera for --split 2"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.avi")));
}

TEST_F(FilmTest, CamerasSeeTheVehicleInTheMiddle) {
  record(driven_world());
  const auto source = viewer::open_film_source(log, {});
  source->advance_to(sim::from_seconds(1));
  const sim::Vector3d p_W = source->world().find_vehicle("r1")->X_WV().translation();
  viewer::SceneView like;
  like.optics.width = 160, like.optics.height = 120;
  for (const char* text : {"chase:r1", "orbit:r1", "top:r1", "top", "all"}) {
    const auto rig = viewer::make_camera_rig(text, source->world(), like);
    const viewer::SceneView view = rig->view(0);
    const auto pixel = sim::Optics(view.optics).project(view.X_WS.inverse() * p_W);
    ASSERT_TRUE(pixel) << text;
    EXPECT_NEAR(pixel->x(), 80, 16) << text;
    EXPECT_NEAR(pixel->y(), 60, 16) << text;
  }
}

}  // namespace
