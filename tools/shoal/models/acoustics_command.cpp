// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>

#include "devices/comms/acoustic_modem.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/acoustics/channel.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "verification/acoustics/acoustic_closed_forms.hpp"
#include "verification/acoustics/acoustic_link.hpp"
#include "verification/acoustics/ray_picture.hpp"

namespace tools {

namespace {

/// World without a file: water, and a wind that causes ambient noise.
constexpr const char* plain_world = "shoal: 1\nmedium: {water: {}, wind: {velocity_mps: [5, 0, 0]}}\n";

struct AcousticsArguments {
  std::string world;
  sim::LoadOptions load;
  std::string from, to, ranges, image, rays, closed_forms;
  std::vector<std::string> packets;
  bool micromodem = false;
  double range_m = 1000, depth_m = 10;
  std::optional<double> level_dB, frequency_Hz, bandwidth_Hz, coding_gain_dB;  ///< unset: of the sending modem
  std::optional<double> detection_dB;
  std::optional<double> water_depth_m;
};

std::vector<double> parse_ranges(const std::string& text) {
  const auto numbers = command_line::numbers_in(text, ':', 3);
  if (!numbers || !((*numbers)[0] > 0) || (*numbers)[1] < (*numbers)[0] || (*numbers)[1] > 1e7 ||
      !((*numbers)[2] > 0) || ((*numbers)[1] - (*numbers)[0]) / (*numbers)[2] > 10000)
    throw CLI::ValidationError("--ranges",
                               "must be from:to:step in meters, 10000 steps at most, such as 100:5000:100, "
                               "got '" +
                                   text + "'");
  std::vector<double> ranges_m;
  // By multiplication, since sums of the step would miss the end by rounding.
  for (int i = 0; (*numbers)[0] + i * (*numbers)[2] <= (*numbers)[1] * (1 + 1e-12); ++i)
    ranges_m.push_back((*numbers)[0] + i * (*numbers)[2]);
  return ranges_m;
}

/// Parses a position `x,y,z`, a transducer `vehicle/device`, or a vehicle.
verification::LinkEnd find_end(const char* option, const std::string& text, const sim::World& world) {
  verification::LinkEnd end;
  if (const auto p_W = command_line::point_in(text)) {
    end.p_W = *p_W;
    return end;
  }
  std::string known;
  for (const sim::Transducer* transducer : world.acoustics().transducers()) {
    if (transducer == nullptr) continue;
    known += (known.empty() ? "; transducers: " : ", ") + transducer->full_name();
    if (transducer->full_name() != text) continue;
    return {transducer->p_W(world.now()), transducer->R_WS(), transducer->config().directivity, transducer->group(),
            transducer->config().detection_dB};
  }
  if (const sim::Vehicle* vehicle = world.find_vehicle(text)) {
    end.p_W = vehicle->base().X_WB().translation();
    end.group = vehicle->group();
    return end;
  }
  throw CLI::ValidationError(
      option, "must be a place such as 4,-3,-2.5, a transducer or a vehicle, got '" + text + "'" + known);
}

std::vector<verification::AcousticPacket> packets_of(const AcousticsArguments& arguments,
                                                     const devices::AcousticModem::Params* modem) {
  std::vector<verification::AcousticPacket> packets;
  for (const std::string& text : arguments.packets) {
    const auto packet = verification::parse_packet(text);
    if (!packet)
      throw CLI::ValidationError(
          "--packet", "must be modulation:bit/s:bytes such as fsk:80:32 (fsk, psk, dpsk), got '" + text + "'");
    packets.push_back(*packet);
  }
  if (arguments.micromodem)
    for (verification::AcousticPacket packet : verification::micromodem_packets()) {
      // A bandwidth that is given holds for all packets.
      if (arguments.bandwidth_Hz) packet.bandwidth_Hz.reset();
      packets.push_back(packet);
    }
  if (!packets.empty()) return packets;
  if (modem != nullptr)
    return {*verification::parse_packet(fmt::format("{}:{}:{}", sim::to_string(modem->modulation), modem->bit_rate_bps,
                                                    std::int64_t{modem->frames} * modem->frame_bytes))};
  // Without a modem: examples, from slow and robust to fast.
  for (const char* text : {"fsk:80:32", "psk:500:64", "psk:5300:256", "dpsk:1200:256"})
    packets.push_back(*verification::parse_packet(text));
  return packets;
}

/// Returns the keys of an acoustic modem, or null.
const devices::AcousticModem::Params* modem_keys(const std::string& full_name, const sim::World& world) {
  for (const auto& device : world.devices()) {
    if (!device || device->full_name() != full_name) continue;
    const auto* keys =
        dynamic_cast<const sim::detail::ParamsOf<devices::AcousticModem::Params>*>(device->config().params.get());
    return keys != nullptr ? &keys->params : nullptr;
  }
  return nullptr;
}

/// Sets the signal of the link: that of the sending modem, if any, overridden by the options.
void take_signal(verification::AcousticLink& link, const AcousticsArguments& arguments,
                 const devices::AcousticModem::Params* modem) {
  if (modem != nullptr) {
    link.source_level = sim::Decibels(modem->source_level_dB);
    link.centre_Hz = modem->frequency_Hz;
    link.bandwidth_Hz = modem->bandwidth_Hz;
    link.coding_gain = sim::Decibels(modem->coding_gain_dB);
  }
  if (arguments.level_dB) link.source_level = sim::Decibels(*arguments.level_dB);
  link.centre_Hz = arguments.frequency_Hz.value_or(link.centre_Hz);
  link.bandwidth_Hz = arguments.bandwidth_Hz.value_or(link.bandwidth_Hz);
  if (link.bandwidth_Hz >= 2 * link.centre_Hz)
    throw CLI::ValidationError("--bandwidth", fmt::format("must be less than twice the frequency of {:g} Hz, got {:g}",
                                                          link.centre_Hz, link.bandwidth_Hz));
  if (arguments.coding_gain_dB) link.coding_gain = sim::Decibels(*arguments.coding_gain_dB);
}

verification::AcousticLink link_of(const AcousticsArguments& arguments, const sim::World& world) {
  verification::AcousticLink link;
  take_signal(link, arguments, modem_keys(arguments.from, world));
  link.detection = sim::Decibels(arguments.detection_dB.value_or(6));
  if (arguments.from.empty() != arguments.to.empty())
    throw CLI::ValidationError("--from", "needs --to, and --to needs --from");
  if (!arguments.from.empty()) {
    link.from = find_end("--from", arguments.from, world);
    link.to = find_end("--to", arguments.to, world);
    link.detection = sim::Decibels(arguments.detection_dB.value_or(link.to.detection_dB.value_or(6)));
    return link;
  }
  const double z_m = world.medium().surface_m(0, 0) - arguments.depth_m;
  link.from.p_W = sim::Vector3d(0, 0, z_m);
  link.to.p_W = sim::Vector3d(arguments.range_m, 0, z_m);
  return link;
}

/// Returns the depth of the fixed bottom below the middle of the link, for echoes; std::nullopt if there is none.
std::optional<double> water_depth_m(const verification::AcousticLink& link, const sim::World& world) {
  sim::Vector3d p_W = (link.from.p_W + link.to.p_W) / 2;
  const double surface_m = world.medium().surface_m(p_W.x(), p_W.y());
  p_W.z() = std::min(link.from.p_W.z(), link.to.p_W.z());
  sim::RayFilter filter;
  filter.kind = sim::RayKind::sound;
  const sim::PhysicsWorld& physics = world.physics();
  // Vehicles and floating objects are not bottom: the ray continues through them.
  constexpr int max_hits = 100;
  for (int i = 0; i < max_hits; ++i) {
    const auto hit = physics.scene().cast(p_W, -sim::Vector3d::UnitZ(), 12000, filter);
    if (!hit) return std::nullopt;
    p_W.z() -= hit->range_m;
    const int body = physics.parts()[static_cast<std::size_t>(hit->part)].body;
    if (physics.bodies()[static_cast<std::size_t>(body)]->fixed()) return surface_m - p_W.z();
    p_W.z() -= 1e-3;
  }
  return std::nullopt;
}

/// Returns whether a position is below terrain or a plane, or inside of a fixed object.
bool in_ground(const sim::Vector3d& p_W, const sim::World& world) {
  constexpr double far_m = 12000;
  const auto fixed_part = [&](const sim::Vector3d& displacement_W) -> int {
    sim::RayFilter filter;
    filter.kind = sim::RayKind::sound;
    const auto hit = world.scene().cast(p_W, displacement_W, far_m, filter);
    if (!hit) return -1;
    const int body = world.physics().parts()[static_cast<std::size_t>(hit->part)].body;
    return world.physics().bodies()[static_cast<std::size_t>(body)]->fixed() ? hit->part : -1;
  };
  const int above = fixed_part(sim::Vector3d::UnitZ());
  if (above < 0) return false;
  if (above == fixed_part(-sim::Vector3d::UnitZ())) return true;
  const sim::PartInfo& part = world.physics().parts()[static_cast<std::size_t>(above)];
  if (part.plane) return true;
  const sim::Body* body = world.physics().bodies()[static_cast<std::size_t>(part.body)].get();
  for (const auto& [name, object] : world.objects())
    if (&object.base() == body)
      return object.config->any_part([](const auto& each) { return each.shape == sim::PartShape::terrain; });
  return false;
}

/// Checks that both ends are in water.
void check_end(const char* option, const verification::LinkEnd& end, const sim::World& world) {
  const sim::Vector3d& p_W = end.p_W;
  const std::string place = fmt::format("{:g},{:g},{:g}", p_W.x(), p_W.y(), p_W.z());
  if (!world.medium().in_water(p_W))
    throw CLI::ValidationError(option, fmt::format("is in the air at {}: the surface is at z = {:.2f} m there", place,
                                                   world.medium().surface_m(p_W.x(), p_W.y())));
  if (in_ground(p_W, world)) throw CLI::ValidationError(option, "is in the ground at " + place);
}

void warn(const verification::AcousticLink& link, const sim::World& world) {
  sim::Random random(1, "look");
  random.begin_step(0);
  const int none = -2;  // a group that does not exist
  const auto gain = world.acoustics().propagation().gain(link.from.p_W, link.from.group < 0 ? none : link.from.group,
                                                         link.to.p_W, link.to.group, link.centre_Hz, random);
  if (gain.blocked) std::cerr << "shoal: an obstacle blocks the line of sight, which the table ignores\n";
}

int show_closed_forms(const std::string& file) {
  const std::vector<verification::ClosedFormRow> rows = verification::acoustic_closed_forms(file);
  std::cout << verification::closed_forms_text(rows);
  for (const verification::ClosedFormRow& row : rows)
    if (!row.within()) return exit_failed;
  return exit_ok;
}

int show(AcousticsArguments& arguments) {
  if (!arguments.closed_forms.empty()) return show_closed_forms(arguments.closed_forms);
  if (!arguments.image.empty()) check_writable(arguments.image);
  if (!arguments.rays.empty()) check_writable(arguments.rays);
  // Ranges of the table or plot.
  const std::vector<double> ranges_m =
      arguments.ranges.empty() && arguments.image.empty()
          ? std::vector<double>()
          : parse_ranges(arguments.ranges.empty() ? "100:10000:100" : arguments.ranges);
  // World, link and packets.
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::WorldConfig config =
      (arguments.world.empty() ? sim::load_world_text(plain_world, "plain sea", arguments.load)
                               : sim::load_world(experiment::world_file(arguments.world), arguments.load))
          .config;
  const sim::StandaloneWorld world(config);
  if (!world.medium().has_water()) throw CLI::ValidationError("WORLD", "has no water to carry sound");
  const verification::AcousticLink link = link_of(arguments, world);
  const std::vector<verification::AcousticPacket> packets = packets_of(arguments, modem_keys(arguments.from, world));
  check_end(arguments.from.empty() ? "--depth" : "--from", link.from, world);
  check_end(arguments.to.empty() ? "--depth" : "--to", link.to, world);
  warn(link, world);
  const std::optional<double> depth_m = arguments.water_depth_m ? arguments.water_depth_m : water_depth_m(link, world);
  if (!arguments.rays.empty()) {
    if (!verification::sound_bends(config.acoustics, world.medium()))
      throw CLI::ValidationError(
          "--rays",
          "sound travels along straight lines in this world: give its water a profile, or 'propagation: rays'");
    const double source_m = world.medium().still_surface_m() - link.from.p_W.z();
    const double level_m = (link.to.p_W - link.from.p_W).head<2>().norm();
    verification::draw_rays(verification::ray_field(source_m, std::max(level_m, 1.0), link.centre_Hz, config.acoustics,
                                                    world.medium(), depth_m),
                            fmt::format("Rays from a depth of {:g} m, {:g} Hz", source_m, link.centre_Hz),
                            arguments.rays);
    return exit_ok;
  }
  // Budget of a single link.
  if (ranges_m.empty()) {
    const verification::LinkBudget budget = verification::link_budget(link, config.acoustics, world.medium(), depth_m);
    std::vector<double> delivered;
    for (const verification::AcousticPacket& packet : packets)
      delivered.push_back(verification::delivery_probability(link, packet, config.acoustics, world.medium(), depth_m));
    std::cout << verification::budget_text(link, budget, config.acoustics) << '\n'
              << verification::packets_text(link, budget, packets, delivered);
    return exit_ok;
  }
  // Table or plot over range.
  const std::vector<verification::RangeRow> rows =
      verification::over_range(link, packets, ranges_m, config.acoustics, world.medium(), depth_m);
  if (arguments.image.empty())
    std::cout << verification::csv_text(rows, packets);
  else
    verification::draw_over_range(rows, packets,
                                  fmt::format("{:g} dB re 1 uPa at 1 m, {:g} Hz, {:g} Hz wide", link.source_level.dB(),
                                              link.centre_Hz, link.bandwidth_Hz),
                                  arguments.image);
  return exit_ok;
}

void add_link_options(CLI::App& command, AcousticsArguments& arguments) {
  command.add_option("--from", arguments.from, "sender: vehicle/device, a vehicle, or a place X,Y,Z in meters")
      ->type_name("END");
  command.add_option("--to", arguments.to, "receiver: the same")->type_name("END");
  command.add_option("--range", arguments.range_m, "distance, m, without --from and --to")
      ->type_name("M")
      ->check(number_from(0, 1e7))
      ->capture_default_str();
  command.add_option("--depth", arguments.depth_m, "depth of both ends, m, without --from and --to")
      ->type_name("M")
      ->check(number_from(0, 12000))
      ->capture_default_str();
  command
      .add_option("--water-depth", arguments.water_depth_m,
                  "depth of a flat bottom for echoes, m; default: the depth of the world below the middle of the link")
      ->type_name("M")
      ->check(number_from(0.1, 12000));
}

void add_signal_options(CLI::App& command, AcousticsArguments& arguments) {
  // Level and band.
  command
      .add_option("--level", arguments.level_dB,
                  "source level, dB re 1 uPa at 1 m; default: that of the sending modem, else 185")
      ->type_name("DB")
      ->check(number_from(-100, 300));
  command
      .add_option("--frequency", arguments.frequency_Hz,
                  "center of the band, Hz; default: that of the sending modem, else 25000")
      ->type_name("HZ")
      ->check(number_from(10, 1e6));
  command
      .add_option("--bandwidth", arguments.bandwidth_Hz,
                  "bandwidth of the signal, Hz; default: that of the sending modem, else 4000")
      ->type_name("HZ")
      ->check(number_from(0.1, 1e6));
  // Packets.
  command.add_option("--packet", arguments.packets, "modulation:bit/s:bytes, such as fsk:80:32")
      ->type_name("PACKET")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_flag("--micromodem", arguments.micromodem, "tabulate a frame of each rate of the WHOI Micro-Modem");
  // Receiver.
  command
      .add_option("--detection", arguments.detection_dB,
                  "signal-to-noise ratio that the receiver needs, dB; default: that of the transducer, else 6")
      ->type_name("DB")
      ->check(number_from(-60, 100));
  command
      .add_option("--coding-gain", arguments.coding_gain_dB,
                  "coding gain added to Eb/N0, dB; default: that of the sending modem, else 0")
      ->type_name("DB")
      ->check(number_from(-60, 60));
}

void add_options(CLI::App& command, AcousticsArguments& arguments) {
  command.add_option("WORLD", arguments.world, "world file; default: open water with 5 m/s of wind");
  add_link_options(command, arguments);
  add_signal_options(command, arguments);
  command.add_option("--ranges", arguments.ranges, "a table over range, m, as CSV: from:to:step")->type_name("RANGES");
  command.add_option("--image", arguments.image, "PNG file: signal-to-noise ratio and delivery over range")
      ->type_name("FILE");
  command
      .add_option("--rays", arguments.rays,
                  "PNG file: rays, loss and shadows from the sender to the range of the receiver")
      ->type_name("FILE");
  add_set_option(command, arguments.load.sets);
  add_allow_path_option(command, arguments.load);
  command
      .add_option("--closed-forms", arguments.closed_forms,
                  "compare a CSV file of closed forms with what Shoal computes")
      ->type_name("FILE");
  add_plugin_option(command);
}

}  // namespace

static void add_acoustics_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("acoustics");
  const auto arguments = std::make_shared<AcousticsArguments>();
  add_log_level_option(*command);
  add_options(*command, *arguments);
  command_line::set_help_end(
      *command, {{"shoal acoustics --range 1500 --set acoustics.absorption.model=thorp",
                  "shoal acoustics --micromodem --set acoustics.fading.type=rayleigh --ranges 500:10000:500",
                  "shoal acoustics worlds/proving_sea.yaml --from 0,0,-5 --to 900,0,-25 --packet psk:500:64",
                  "shoal acoustics worlds/coop_underwater.yaml --depth 2 --range 1000 --rays rays.png",
                  "shoal acoustics --closed-forms tests/fidelity/reference/closed_forms.csv"},
                 {{0, "success"},
                  {1, "a closed form was not matched"},
                  {2, "wrong usage, or a mistake in the world"},
                  {4, "file error"}},
                 {"docs/models/acoustics.md has the equations."}});
  command->callback([arguments, &exit_code] { exit_code = show(*arguments); });
}

SHOAL_COMMAND(look, "acoustics", "Show the propagation of sound between two positions under water",
              add_acoustics_command);

}  // namespace tools
