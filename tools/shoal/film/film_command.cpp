// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>

#include "experiment/process/signals.hpp"
#include "sim/image/image.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/film/image_options.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film.hpp"
#include "viewer/film/film_clips.hpp"

namespace tools {

namespace {

struct FilmArguments {
  viewer::FilmOptions film;
  viewer::ClipOptions clips;
  std::string size = "640x480", overlays = "labels,clock", shapes = "drawn", visibility;
  double fov_deg = 60;
  int split = 1;
};

/// Makes the film, or the clips.
int render(const FilmArguments& arguments) {
  if (!arguments.clips.directory.empty()) {
    const viewer::ClipOutcome outcome = viewer::make_clips(arguments.film, arguments.clips);
    std::cout << outcome.to_text();
    return outcome.interrupted ? 128 + experiment::caught_signal() : exit_ok;
  }
  const viewer::FilmOutcome outcome = viewer::make_film(arguments.film);
  if (outcome.interrupted) {
    std::cerr << "shoal: interrupted after " << outcome.frames << " frames; no film was written\n";
    return 128 + experiment::caught_signal();
  }
  std::cout << outcome.to_text(arguments.film);
  return exit_ok;
}

int film(FilmArguments& arguments) {
  // Options of which the text is parsed.
  viewer::FilmOptions& film = arguments.film;
  const ImageSize size = parse_image_size(arguments.size);
  film.format.width = size.width;
  film.format.height = size.height;
  film.fov_rad = sim::degrees_to_radians(arguments.fov_deg);
  film.split = arguments.split == 2;
  film.visibility_m = parse_visibility(arguments.visibility);
  film.overlays = parse_overlay_option(arguments.overlays);
  film.overlays.shapes = parse_shapes(arguments.shapes);
  if (film.cameras.empty()) film.cameras.push_back("all");
  if (film.cameras.size() > 2) throw CLI::ValidationError("--camera", "may be given twice at most");
  if (film.out.empty() && arguments.clips.directory.empty())
    throw CLI::ValidationError("--out", "is required, or --clips");
  if (film.until_s && *film.until_s < film.from_s) throw CLI::ValidationError("--to", "must not be before --from");
  experiment::catch_signals(true);
  // Film, with one error for each cause.
  try {
    return render(arguments);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(film.out.empty() ? "--clips-as" : "--out", error.what());
  } catch (const viewer::CameraError& error) {
    throw CLI::ValidationError("--camera", error.what());
  } catch (const sim::PhysicsFault& fault) {
    std::cerr << "shoal: " << fault.what() << '\n';
    return exit_physics;
  }
}

void add_film_options(CLI::App& command, FilmArguments& arguments) {
  viewer::FilmOptions& film = arguments.film;
  command
      .add_option("--camera", film.cameras,
                  "all, top, top:VEHICLE, chase:VEHICLE, orbit:VEHICLE, from:VEHICLE/CAMERA, or a file *.yaml with key "
                  "poses; default all. Given twice: side by side")
      ->type_name("CAMERA")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_option("--split", arguments.split, "2: split screen with the vehicle's on-board camera")
      ->type_name("N")
      ->check(whole_from(1, 2));
  command.add_option("--from", film.from_s, "simulated time of the first frame, s")
      ->type_name("S")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  command
      .add_option("--to", film.until_s,
                  "simulated time of the last frame, s; default: the end of the log, or 10 s of film")
      ->type_name("S")
      ->check(number_from(0, 1e9));
  command.add_option("--speed", film.speed, "playback speed: simulated seconds per second of film")
      ->type_name("FACTOR")
      ->check(number_from(0.001, 1e6))
      ->capture_default_str();
  command.add_option("--fps", film.format.fps, "frames per second of the film")
      ->type_name("N")
      ->check(whole_from(1, 240))
      ->capture_default_str();
  command.add_option("--size", arguments.size, "frame size in pixels")
      ->type_name("WIDTHxHEIGHT")
      ->capture_default_str();
  command.add_option("--fov", arguments.fov_deg, "horizontal field of view, degrees")
      ->type_name("DEG")
      ->check(number_from(1, 170))
      ->capture_default_str();
  command.add_option("--antialias", film.antialias, "rays along each side of a pixel")
      ->type_name("N")
      ->check(whole_from(1, 4))
      ->capture_default_str();
  add_visibility_option(command, arguments.visibility);
  add_overlay_option(command, arguments.overlays)->capture_default_str();
  add_shapes_option(command, arguments.shapes);
  add_threads_option(command, film.threads);
  command.add_flag("--quiet", film.quiet, "no progress");
}

void add_clip_options(CLI::App& command, viewer::ClipOptions& clips) {
  CLI::Option* directory = command
                               .add_option("--clips", clips.directory,
                                           "write a clip of each event of a log to this folder instead of one film; "
                                           "the camera follows the vehicle that the event names")
                               ->type_name("DIR");
  for (const char* other : {"--out", "--camera", "--split", "--from", "--to"})
    directory->excludes(command.get_option(other));
  command.add_option("--before", clips.before_s, "lead-in before each event, s of simulated time")
      ->type_name("S")
      ->check(number_from(0, 1e6))
      ->capture_default_str()
      ->needs(directory);
  command.add_option("--after", clips.after_s, "time after each event, s")
      ->type_name("S")
      ->check(number_from(0, 1e6))
      ->capture_default_str()
      ->needs(directory);
  command.add_option("--max-clips", clips.max_clips, "maximum number of clips")
      ->type_name("N")
      ->check(whole_from(1, 10'000))
      ->capture_default_str()
      ->needs(directory);
  command.add_option("--clips-as", clips.ending, "file type of the clips: .mp4, .webm, .avi")
      ->type_name("ENDING")
      ->check(one_of({".mp4", ".webm", ".avi"}).description(""))
      ->capture_default_str()
      ->needs(directory);
}

}  // namespace

static void add_film_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("film");
  const auto arguments = std::make_shared<FilmArguments>();
  add_log_level_option(*command);
  command->add_option("LOG|WORLD", arguments->film.source, "log of shoal run --record, world file, or shipped world")
      ->required();
  command
      ->add_option("--out", arguments->film.out,
                   "file: .mp4 or .webm (by ffmpeg), .avi, .png (NAME_00000.png and so on), or FOLDER/")
      ->type_name("FILE");
  add_film_options(*command, *arguments);
  add_clip_options(*command, arguments->clips);
  // World.
  command->add_option("--seed", arguments->film.load.seed, "seed of every random stream of a world")
      ->type_name("N")
      ->check(command_line::seed());
  add_set_option(*command, arguments->film.load.sets);
  add_allow_path_option(*command, arguments->film.load);
  add_plugin_option(*command);
  command_line::set_help_end(
      *command,
      {{"shoal run coop_underwater --launch --record auv.lcm",
        "shoal film auv.lcm --camera chase:auv --speed 8 --out auv.mp4",
        "shoal film auv.lcm --camera top --overlay trails,ellipses,clock --speed 20 --from 40 --to 900 --out map.webm",
        "shoal film auv.lcm --clips clips --before 5",
        "shoal film dynamic_warehouse --to 20 --size 1280x720 --antialias 2 --out hall.mp4",
        "shoal film erl_room --camera orbit:robot --split 2 --out room.avi"},
       {{0, "success"},
        {2, "wrong usage, a mistake in the world, a camera or vehicle that does not exist"},
        {3, "physics fault"},
        {4, "the log cannot be replayed, the film cannot be written, or ffmpeg failed or is missing"},
        {130, "ended by Ctrl-C; no film is written"}},
       {"A log is replayed with its recorded inputs, without verifying it: see shoal replay. A world is run without "
        "its "
        "programs."}});
  command->callback([arguments, &exit_code] { exit_code = film(*arguments); });
}

SHOAL_COMMAND(look, "film", "Make a film of a recorded run, or of a world without programs", add_film_command);

}  // namespace tools
