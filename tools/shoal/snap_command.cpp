// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include <charconv>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "devices/ranging/camera.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/config/message_text.hpp"
#include "sim/image/image_file.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/experiment/images/overview.hpp"
#include "tools/experiment/world_files/world_by_name.hpp"
#include "tools/shoal/commands.hpp"
#include "tools/shoal/output_file.hpp"

namespace tools {

namespace {

struct SnapArguments {
  std::string world;
  sim::LoadOptions load;
  double at_s = 0;
  std::optional<double> every_s;
  double until_s = 0;
  std::string from, out, size = "1280x720", image, eye, look;
  double fov_deg = 60;
  std::optional<int> antialias;
  bool all = false;
  int quality = 90;
};

/// Camera and its pose.
struct View {
  sim::OpticsConfig optics;
  sim::Pose X_WS = sim::Pose::Identity();
  sim::RenderOptions options;
  bool grey = false;
  int antialias = 2;
  float gain = 1;
  std::optional<Overview> overview;
};

using Numbers = std::vector<double>;

/// Parses `count` numbers with `separator` between them.
Numbers parse_numbers(const char* option, const std::string& text, char separator, std::size_t count,
                      const char* form) {
  Numbers numbers;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at <= end) {
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || !std::isfinite(number)) break;
    numbers.push_back(number);
    if (next == end && numbers.size() == count) return numbers;
    if (next == end || *next != separator) break;
    at = next + 1;
  }
  throw CLI::ValidationError(option, std::string("must be ") + form + ", got '" + text + "'");
}

sim::Vector3d parse_point(const char* option, const std::string& text) {
  const Numbers numbers = parse_numbers(option, text, ',', 3, "three numbers in metres such as 4,-3,2.5");
  for (const double number : numbers)
    if (std::abs(number) > 1e7) throw CLI::ValidationError(option, "must be within 1e7 m, got '" + text + "'");
  return {numbers[0], numbers[1], numbers[2]};
}

const devices::Camera& find_camera(const sim::World& world, const std::string& name, const sim::MountedDevice*& found) {
  std::string cameras;
  for (const auto& device : world.devices()) {
    if (!device) continue;
    const auto* camera = dynamic_cast<const devices::Camera*>(device->sensor());
    if (!camera) continue;
    std::string dotted = device->vehicle().name() + "." + device->config().name;
    if (name == dotted || name == device->full_name()) {
      found = device.get();
      return *camera;
    }
    cameras += (cameras.empty() ? "" : ", ") + dotted;
  }
  throw CLI::ValidationError("--from",
                             "there is no camera '" + name + "'" +
                                 (cameras.empty() ? "; this world has none, see --eye" : "; there are: " + cameras));
}

/// Returns the view of a camera at its present pose: its lens and exposure, without noise, blur and rolling shutter.
View view_of_camera(const sim::World& world, const std::string& name) {
  const sim::MountedDevice* device = nullptr;
  const devices::Camera& camera = find_camera(world, name, device);
  const sim::DeviceConfig& config = device->config();
  const sim::Vehicle& vehicle = device->vehicle();
  const sim::Body& body = config.body.empty() ? vehicle.base() : vehicle.body(config.body);
  View view;
  view.optics = camera.params().optics;
  view.X_WS = body.X_WB() * config.X_BS();
  view.options = camera.render_options();
  view.grey = camera.params().image == devices::Camera::Kind::grey;
  view.antialias = camera.params().antialias;
  view.gain = static_cast<float>(camera.params().exposure.gain);
  return view;
}

View free_view(const SnapArguments& arguments, const sim::World& world) {
  const Numbers size = parse_numbers("--size", arguments.size, 'x', 2, "such as 1280x720");
  View view;
  for (const double side : size)
    if (!(side >= 1 && side <= sim::max_image_side_px) || side != std::floor(side))
      throw CLI::ValidationError(
          "--size", fmt::format("must be 1 to {} pixels a side, got '{}'", sim::max_image_side_px, arguments.size));
  view.optics.width = static_cast<int>(size[0]);
  view.optics.height = static_cast<int>(size[1]);
  view.optics.fov_rad = sim::degrees_to_radians(arguments.fov_deg);
  view.options.light = world.config().light;
  if (arguments.eye.empty()) {
    view.overview = overview_of(world, view.optics, arguments.all);
    view.X_WS = view.overview->X_WS;
    return view;
  }
  const sim::Vector3d eye_W = parse_point("--eye", arguments.eye), look_W = parse_point("--look", arguments.look);
  if ((look_W - eye_W).norm() < 1e-6) throw CLI::ValidationError("--look", "must not be the point of --eye");
  view.X_WS = look_at(eye_W, look_W);
  return view;
}

View make_view(const SnapArguments& arguments, const sim::World& world) {
  View view = arguments.from.empty() ? free_view(arguments, world) : view_of_camera(world, arguments.from);
  if (!arguments.image.empty()) {
    view.grey = arguments.image == "grey";
    view.options.kind = arguments.image == "depth"                   ? sim::ImageKind::depth
                        : arguments.image == "segmentation_parts"    ? sim::ImageKind::parts
                        : arguments.image == "segmentation_vehicles" ? sim::ImageKind::groups
                                                                     : sim::ImageKind::color;
  }
  if (arguments.antialias) view.antialias = *arguments.antialias;
  if (view.options.kind != sim::ImageKind::color) view.antialias = 1;
  const std::int64_t rays = std::int64_t{view.optics.width} * view.optics.height * view.antialias * view.antialias;
  if (rays > 4 * sim::max_image_pixels)
    throw CLI::ValidationError("--size", "with --antialias makes more than 64000000 rays in an image");
  return view;
}

sim::Image8 render_view(const sim::World& world, const View& view, sim::TextureLibrary& textures) {
  const auto rays = sim::make_pixel_rays(sim::Optics(view.optics), view.antialias);
  // The library outlives the renderer, which requires shared ownership.
  const std::shared_ptr<sim::TextureLibrary> shared(&textures, [](sim::TextureLibrary*) {});
  sim::Renderer renderer(world.physics(), rays, view.options, shared);
  sim::Frame frame;
  renderer.render(view.X_WS, frame);
  if (view.options.kind == sim::ImageKind::depth) return sim::depth_image(frame.depth_m);
  if (view.options.kind != sim::ImageKind::color) return sim::label_image(frame.labels);
  return sim::develop(view.grey ? sim::grey_of(frame.light) : frame.light, view.gain);
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
void warn(const View& view) {
  if (!view.overview) return;
  if (!view.overview->hidden.empty())
    spdlog::warn("hidden behind something in this view: {}; see --eye and --look",
                 sim::list_text(view.overview->hidden, 8));
  if (!view.overview->tiny.empty())
    spdlog::warn("only a few pixels wide in this view: {}; see --eye and --look",
                 sim::list_text(view.overview->tiny, 8));
}

void take_one(const SnapArguments& arguments, const sim::World& world, const std::string& path,
              sim::TextureLibrary& textures) {
  const View view = make_view(arguments, world);
  warn(view);
  const auto start = std::chrono::steady_clock::now();
  const sim::Image8 output = render_view(world, view, textures);
  const double render_s = seconds_since(start);
  try {
    sim::write_image(path, output, arguments.quality);
  } catch (const sim::ImageError& error) {
    throw std::runtime_error(path + ": " + error.what());  // the main program returns exit code 4 for it
  }
  const sim::Vector3d p_W = view.X_WS.translation();
  std::cout << fmt::format(
      "{}: {}x{}, {} at {:.3f} s from {}, rendered in {:.2f} s\n", path, output.width, output.height, arguments.world,
      sim::to_seconds(world.now()),
      arguments.from.empty() ? fmt::format("({:.2f}, {:.2f}, {:.2f})", p_W.x(), p_W.y(), p_W.z()) : arguments.from,
      render_s);
}

int snap(SnapArguments& arguments) {
  // Check the options.
  if (!sim::is_image_name(arguments.out))
    throw CLI::ValidationError("--out", "must end in .png, .jpg or .jpeg, got '" + arguments.out + "'");
  if (arguments.every_s && arguments.until_s < arguments.at_s)
    throw CLI::ValidationError("--until", "must not be before --at");
  // Load the world.
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::LoadedWorld loaded = sim::load_world(world_file(arguments.world), arguments.load);
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  world.use_threads(0);
  make_view(arguments, world);  // reports errors of the view before a long run
  check_writable(arguments.every_s ? numbered(arguments.out, 0) : arguments.out);
  // Take the images.
  sim::TextureLibrary textures;
  try {
    int number = 0;
    for (double at_s = arguments.at_s; number == 0 || at_s <= arguments.until_s + 1e-9; ++number) {
      while (world.now() < sim::from_seconds(at_s)) world.step();
      take_one(arguments, world, arguments.every_s ? numbered(arguments.out, number) : arguments.out, textures);
      if (!arguments.every_s) break;
      at_s = arguments.at_s + (number + 1) * *arguments.every_s;
    }
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
      command.add_option("--eye", arguments.eye, "position of the camera, m; without it all vehicles are in view")
          ->type_name("X,Y,Z");
  CLI::Option* all = command.add_flag("--all", arguments.all, "all objects are in view, too, apart from planes");
  CLI::Option* look =
      command.add_option("--look", arguments.look, "point that the camera looks at, m")->type_name("X,Y,Z");
  CLI::Option* fov =
      command.add_option("--fov", arguments.fov_deg, "horizontal field of view, degrees")->type_name("DEG");
  CLI::Option* size = command.add_option("--size", arguments.size, "of the image in pixels")->type_name("WIDTHxHEIGHT");
  eye->needs(look);
  look->needs(eye);
  fov->check(number_from(1, 170))->capture_default_str();
  size->capture_default_str();
  for (CLI::Option* option : {eye, fov, size, all}) option->excludes(from);
  all->excludes(eye);
  // Kind of image.
  command
      .add_option(
          "--image", arguments.image,
          "rgb, grey, depth, segmentation_parts or segmentation_vehicles; without it rgb, or as --from takes it")
      ->type_name("KIND")
      ->check(one_of({"rgb", "grey", "depth", "segmentation_parts", "segmentation_vehicles"}).description(""));
  command.add_option("--antialias", arguments.antialias, "rays along each side of a pixel; without it 2")
      ->type_name("N")
      ->check(whole_from(1, 4));
  command.add_option("--quality", arguments.quality, "of a JPEG")
      ->type_name("N")
      ->check(whole_from(1, 100))
      ->capture_default_str();
}

}  // namespace

void add_snap_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("snap", "Run a world as fast as possible, without a bus, and render an image");
  const auto arguments = std::make_shared<SnapArguments>();
  add_log_level_option(*command);
  // Output and times.
  command->add_option("WORLD", arguments->world, "world file, or the name of a shipped world")->required();
  command->add_option("--out", arguments->out, "file of the image: .png, .jpg or .jpeg")->type_name("FILE")->required();
  command->add_option("--at", arguments->at_s, "simulated time, s")
      ->type_name("S")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  CLI::Option* every =
      command
          ->add_option("--every", arguments->every_s, "interval of further images in seconds: NAME_0000.png and so on")
          ->type_name("S");
  CLI::Option* until =
      command->add_option("--until", arguments->until_s, "time of the last of them, s")->type_name("S");
  every->check(number_from(1e-6, 1e9))->needs(until);
  until->check(number_from(0, 1e9))->needs(every);
  // View and world.
  add_view_options(*command, *arguments);
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
                  "shoal snap worlds/arm_reach.yaml --every 0.5 --until 5 --size 640x480 --out reach.png"},
                 {{0, "success"},
                  {2, "wrong usage, or a mistake in the world"},
                  {3, "physics fault"},
                  {4, "the image cannot be written"}},
                 {}});
  command->callback([arguments, &exit_code] { exit_code = snap(*arguments); });
}

}  // namespace tools
