// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "sim/image/image_file.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/film/image_options.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film_source.hpp"
#include "viewer/film/overlay.hpp"
#include "viewer/film/scene_painter.hpp"
#include "viewer/images/overview.hpp"

namespace tools {

namespace {

struct SnapArguments {
  std::string world, log;
  sim::LoadOptions load;
  double at_s = 0;
  std::optional<double> every_s;
  double until_s = 0;
  std::string from, out, size = "1280x720", image, eye, look;
  double fov_deg = 60;
  std::optional<int> antialias;
  bool all = false;
  int quality = 90;
  std::string visibility, overlays = "none", shapes = "drawn";
  // Values parsed from the texts above.
  std::optional<double> visibility_m;
  viewer::OverlayChoice overlay;

  /// Returns the log or the world.
  const std::string& source() const { return log.empty() ? world : log; }
};

/// View of an image, and which vehicles it shows badly.
struct SnapView {
  viewer::SceneView scene;
  std::optional<viewer::Overview> overview;
};

sim::Vector3d parse_point(const char* option, const std::string& text) {
  const auto point = command_line::point_in(text);
  if (!point)
    throw CLI::ValidationError(
        option, "must be three numbers in meters such as 4,-3,2.5, each within 1e7 m, got '" + text + "'");
  return *point;
}

std::optional<sim::WaterLook> water_of(const SnapArguments& arguments) {
  if (!arguments.visibility_m) return std::nullopt;
  return sim::WaterLook{sim::water_optics(*arguments.visibility_m)};
}

SnapView free_view(const SnapArguments& arguments, const sim::World& world) {
  const ImageSize size = parse_image_size(arguments.size);
  SnapView view;
  view.scene.optics.width = size.width;
  view.scene.optics.height = size.height;
  view.scene.optics.fov_rad = sim::degrees_to_radians(arguments.fov_deg);
  view.scene.options.light = world.config().light;
  view.scene.water = water_of(arguments);
  if (arguments.eye.empty()) {
    view.overview = viewer::overview_of(world, view.scene.optics, arguments.all);
    view.scene.X_WS = view.overview->X_WS;
    return view;
  }
  const sim::Vector3d eye_W = parse_point("--eye", arguments.eye), look_W = parse_point("--look", arguments.look);
  // The direction would be undefined.
  if ((look_W - eye_W).norm() < 1e-6) throw CLI::ValidationError("--look", "must not be the point of --eye");
  view.scene.X_WS = viewer::look_at(eye_W, look_W);
  return view;
}

/// Returns the view of a camera of a vehicle; with --visibility, with this water in place of that of the camera.
SnapView camera_view(const SnapArguments& arguments, const sim::World& world) {
  try {
    SnapView view{viewer::view_of_camera(world, arguments.from), std::nullopt};
    if (arguments.visibility.empty()) return view;
    view.scene.water = water_of(arguments);
    view.scene.follows_daylight = true;
    return view;
  } catch (const viewer::CameraError& error) {
    const std::string text = error.what();
    throw CLI::ValidationError("--from", text + (text.ends_with("has none") ? ", see --eye" : ""));
  }
}

SnapView make_view(const SnapArguments& arguments, const sim::World& world) {
  SnapView made = arguments.from.empty() ? free_view(arguments, world) : camera_view(arguments, world);
  viewer::SceneView& view = made.scene;
  if (!arguments.image.empty()) {
    view.grey = arguments.image == "grey";
    view.options.kind = arguments.image == "depth"                   ? sim::ImageKind::depth
                        : arguments.image == "segmentation_parts"    ? sim::ImageKind::parts
                        : arguments.image == "segmentation_vehicles" ? sim::ImageKind::groups
                                                                     : sim::ImageKind::color;
  }
  if (arguments.antialias) view.antialias = *arguments.antialias;
  // Averages of depths or labels mean nothing.
  if (view.options.kind != sim::ImageKind::color) view.antialias = 1;
  if (view.options.kind != sim::ImageKind::color && arguments.overlay.shapes != viewer::BodyShapes::drawn)
    throw CLI::ValidationError("--shapes", "must be drawn for an image without color");
  const std::int64_t rays = std::int64_t{view.optics.width} * view.optics.height * view.antialias * view.antialias;
  if (rays > 4 * sim::max_image_pixels)
    throw CLI::ValidationError("--size", "with --antialias makes more than 64000000 rays in an image");
  return made;
}

/// `image.png`, or `image_0003.png` for one of several.
std::string numbered(const std::string& path, int number) {
  const std::size_t dot = path.rfind('.');
  return fmt::format("{}_{:04}{}", path.substr(0, dot), number, path.substr(dot));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Reports vehicles that cannot be seen in an automatic view.
void warn(const SnapView& view) {
  if (!view.overview) return;
  if (!view.overview->hidden.empty())
    sim::log_warn("hidden behind something in this view: {}; see --eye and --look",
                  sim::list_text(view.overview->hidden, 8));
  if (!view.overview->tiny.empty())
    sim::log_warn("only a few pixels wide in this view: {}; see --eye and --look",
                  sim::list_text(view.overview->tiny, 8));
}

void take_one(const SnapArguments& arguments, const sim::World& world, const std::string& path,
              viewer::ScenePainter& painter, viewer::Overlay& overlay) {
  SnapView view = make_view(arguments, world);
  warn(view);
  overlay.prepare(view.scene);
  const auto start = std::chrono::steady_clock::now();
  viewer::RenderedScene& rendered = painter.paint(view.scene);
  overlay.observe();
  if (arguments.overlay.any() && view.scene.options.kind == sim::ImageKind::color) overlay.draw(rendered, view.scene);
  const sim::Image8& output = rendered.image;
  const double render_s = seconds_since(start);
  try {
    sim::write_image(path, output, arguments.quality);
  } catch (const sim::ImageError& error) {
    throw std::runtime_error(path + ": " + error.what());  // the main program returns exit code 4 for it
  }
  const sim::Vector3d p_W = view.scene.X_WS.translation();
  std::cout << fmt::format(
      "{}: {}x{}, {} at {:.3f} s from {}, rendered in {:.2f} s\n", path, output.width, output.height,
      arguments.source(), sim::to_seconds(world.now()),
      arguments.from.empty() ? fmt::format("({:.2f}, {:.2f}, {:.2f})", p_W.x(), p_W.y(), p_W.z()) : arguments.from,
      render_s);
}

/// Runs to the times of the images, and takes them.
void take_all(const SnapArguments& arguments, viewer::FilmSource& source) {
  constexpr double trail_s = 60;
  viewer::LogEstimates estimates;
  if (arguments.overlay.ellipses && !source.log().empty())
    estimates =
        viewer::LogEstimates(source.log(), arguments.at_s - trail_s, std::max(arguments.at_s, arguments.until_s), 0.5);
  viewer::LogPaths paths;
  if (arguments.overlay.paths && !source.log().empty())
    paths = viewer::LogPaths(source.log(), std::max(arguments.at_s, arguments.until_s));
  viewer::Overlay overlay(source.world(), {arguments.overlay, trail_s, 2000, ""}, std::move(estimates),
                          std::move(paths));
  const viewer::PingObserver pings(source.world(), overlay);
  viewer::ScenePainter painter(source.world());
  int number = 0;
  for (double at_s = arguments.at_s; number == 0 || at_s <= arguments.until_s + 1e-9; ++number) {
    while (source.world().now() < sim::from_seconds(at_s) && source.step())
      if (arguments.overlay.any() && sim::to_seconds(source.world().now()) > at_s - trail_s) overlay.observe();
    if (source.world().now() < sim::from_seconds(at_s)) return sim::log_warn("the log ends before {:.6g} s", at_s);
    take_one(arguments, source.world(), arguments.every_s ? numbered(arguments.out, number) : arguments.out, painter,
             overlay);
    if (!arguments.every_s) return;
    at_s = arguments.at_s + (number + 1) * *arguments.every_s;
  }
}

int snap(SnapArguments& arguments) {
  // Check the options.
  if (!sim::is_image_name(arguments.out))
    throw CLI::ValidationError("--out", "must end in .png, .jpg or .jpeg, got '" + arguments.out + "'");
  if (arguments.every_s && arguments.until_s < arguments.at_s)
    throw CLI::ValidationError("--until", "must not be before --at");
  if (arguments.world.empty() == arguments.log.empty())
    throw CLI::ValidationError("WORLD", "either a world or --log LOG must be given");
  arguments.visibility_m = parse_visibility(arguments.visibility);
  arguments.overlay = parse_overlay_option(arguments.overlays);
  arguments.overlay.shapes = parse_shapes(arguments.shapes);
  // Load the world, or the log.
  if (!arguments.log.empty() && !viewer::is_event_log(arguments.log))
    throw std::runtime_error(arguments.log + ": is not an LCM log: it cannot be read, or begins with something else");
  const std::unique_ptr<viewer::FilmSource> source = viewer::open_film_source(arguments.source(), arguments.load);
  if (sim::from_seconds(arguments.at_s) < source->world().now() || arguments.at_s > source->end_s() + 1e-9)
    throw std::runtime_error(fmt::format("{}: the log goes from {:.6g} s to {:.6g} s, --at is {:.6g} s", arguments.log,
                                         sim::to_seconds(source->world().now()), source->end_s(), arguments.at_s));
  make_view(arguments, source->world());  // reports errors of the view before a long run
  check_writable(arguments.every_s ? numbered(arguments.out, 0) : arguments.out);
  try {
    take_all(arguments, *source);
  } catch (const sim::PhysicsFault& fault) {
    std::cerr << "shoal: " << fault.what() << '\n';
    return exit_physics;
  }
  return exit_ok;
}

void add_view_options(CLI::App& command, SnapArguments& arguments) {
  // View.
  CLI::Option* from =
      command.add_option("--from", arguments.from, "a camera of the world")->type_name("VEHICLE.DEVICE");
  CLI::Option* eye =
      command.add_option("--eye", arguments.eye, "position of the camera, m; default: all vehicles are in view")
          ->type_name("X,Y,Z");
  CLI::Option* all = command.add_flag("--all", arguments.all, "all objects are in view too, except planes");
  CLI::Option* look =
      command.add_option("--look", arguments.look, "point that the camera looks at, m")->type_name("X,Y,Z");
  CLI::Option* fov =
      command.add_option("--fov", arguments.fov_deg, "horizontal field of view, degrees")->type_name("DEG");
  CLI::Option* size = command.add_option("--size", arguments.size, "image size in pixels")->type_name("WIDTHxHEIGHT");
  eye->needs(look);
  look->needs(eye);
  fov->check(number_from(1, 170))->capture_default_str();
  size->capture_default_str();
  for (CLI::Option* option : {eye, fov, size, all}) option->excludes(from);
  all->excludes(eye);
  // Kind of image.
  command
      .add_option("--image", arguments.image,
                  "rgb, grey, depth, segmentation_parts or segmentation_vehicles; default rgb, or that of --from")
      ->type_name("KIND")
      ->check(one_of({"rgb", "grey", "depth", "segmentation_parts", "segmentation_vehicles"}).description(""));
  command.add_option("--antialias", arguments.antialias, "rays along each side of a pixel; default 2")
      ->type_name("N")
      ->check(whole_from(1, 4));
  command.add_option("--quality", arguments.quality, "of a JPEG")
      ->type_name("N")
      ->check(whole_from(1, 100))
      ->capture_default_str();
}

}  // namespace

static void add_snap_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("snap");
  const auto arguments = std::make_shared<SnapArguments>();
  add_log_level_option(*command);
  // Output and times.
  command->add_option("WORLD", arguments->world, "world file, or the name of a shipped world");
  command
      ->add_option("--log", arguments->log,
                   "log of shoal run --record instead of a world: replays the run with its recorded inputs")
      ->type_name("LOG");
  command->add_option("--out", arguments->out, "image file: .png, .jpg or .jpeg")->type_name("FILE")->required();
  command->add_option("--at", arguments->at_s, "simulated time, s")
      ->type_name("S")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  CLI::Option* every =
      command->add_option("--every", arguments->every_s, "interval between images, s: writes NAME_0000.png and so on")
          ->type_name("S");
  CLI::Option* until = command->add_option("--until", arguments->until_s, "time of the last image, s")->type_name("S");
  every->check(number_from(1e-6, 1e9))->needs(until);
  until->check(number_from(0, 1e9))->needs(every);
  // View and world.
  add_view_options(*command, *arguments);
  add_visibility_option(*command, arguments->visibility);
  add_overlay_option(*command, arguments->overlays)->capture_default_str();
  add_shapes_option(*command, arguments->shapes);
  command->add_option("--seed", arguments->load.seed, "seed of every random stream")
      ->type_name("N")
      ->check(command_line::seed());
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  add_plugin_option(*command);
  // End of the help and action.
  command_line::set_help_end(
      *command, {{"shoal snap worlds/coop_land.yaml --out coop_land.png",
                  "shoal snap worlds/dynamic_warehouse.yaml --at 12.5 --eye -6,-8,5 --look 4,2,0 --out hall.jpg",
                  "shoal snap worlds/proving_ground.yaml --at 3 --from turntable.camera --out seen.png",
                  "shoal snap erl_room --at 1 --overlay rays,labels --out rays.png",
                  "shoal snap --log run.lcm --at 40 --overlay trails,ellipses,labels --out run.png",
                  "shoal snap worlds/arm_reach.yaml --every 0.5 --until 5 --size 640x480 --out reach.png"},
                 {{0, "success"},
                  {2, "wrong usage, or a mistake in the world"},
                  {3, "physics fault"},
                  {4, "the image cannot be written, or the log cannot be replayed"}},
                 {}});
  command->callback([arguments, &exit_code] { exit_code = snap(*arguments); });
}

SHOAL_COMMAND(look, "snap", "Render an image of a world or a recorded run at a given time", add_snap_command);

}  // namespace tools
