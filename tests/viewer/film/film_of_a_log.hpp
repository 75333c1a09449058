// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/experiment/replay/replay_fixture.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film.hpp"
#include "viewer/film/film_source.hpp"
#include "viewer/film/scene_painter.hpp"
#include "viewer/images/overview.hpp"

namespace film_of_a_log {

class FilmTest : public test::ReplayTest {
 protected:
  viewer::FilmOptions options(const std::string& out) const {
    viewer::FilmOptions film;
    film.source = log;
    film.out = folder.file(out);
    film.format = {80, 60, 10};
    film.cameras = {"chase:r1"};
    film.overlays = viewer::parse_overlays("all");
    film.quiet = true;
    film.threads = 2;
    return film;
  }
  std::string film_error(const viewer::FilmOptions& film) const {
    try {
      viewer::make_film(film);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }
};

}  // namespace film_of_a_log
