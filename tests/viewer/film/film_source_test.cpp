// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_source.hpp"

#include <gmock/gmock.h>

#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/viewer/film/film_of_a_log.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film.hpp"
#include "viewer/film/scene_painter.hpp"
#include "viewer/images/overview.hpp"

namespace {

using namespace film_of_a_log;

using test::driven_world;
using testing::HasSubstr;

TEST_F(FilmTest, NamesWhatALogLacks) {
  const std::string foreign = folder.file("foreign.lcm");
  record(driven_world());
  test::copy_log(log, foreign, [](const bridges::LogEvent& event) { return event.channel == "sim.info"; });
  viewer::FilmOptions film = options("a.avi");
  film.source = foreign;
  EXPECT_THAT(film_error(film), HasSubstr("contains no sim.info, which describes the world"));
  film.source = log;
  film.load.seed = 4;
  EXPECT_THAT(film_error(film), HasSubstr("--seed and --set are for worlds"));
}

}  // namespace
