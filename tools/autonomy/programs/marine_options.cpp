// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/programs/marine_options.hpp"

#include "tools/autonomy/behaviours/behaviour_text.hpp"
#include "tools/autonomy/programs/program.hpp"
#include "tools/command_line/checks.hpp"

namespace autonomy {

void MarineOptions::add_options(CLI::App& app) {
  app.add_option("--route", route, "\"x,y;x,y;...\": waypoints, east and north in m")->type_name("ROUTE");
  app.add_option("--behaviour", behaviour,
                 "route, circle:X,Y,RADIUS, zigzag:X1,Y1,X2,Y2,AMPLITUDE,LEGS or follow:VEHICLE,AHEAD,LEFT, in m")
      ->type_name("BEHAVIOUR")
      ->capture_default_str();
  app.add_flag("--loop", loop, "begin the route again after its last waypoint; without it the vehicle stops there");
  add_number(app, "--speed", speed_mps, "M/S", 0.05, 10, "through the water; the greatest of follow:");
  sending.add_options(app, "its state");
}

std::unique_ptr<HelmBehaviour> MarineOptions::make(const std::string& name) const {
  if (behaviour.starts_with("follow:" + name + ",")) throw std::invalid_argument("'" + name + "' cannot follow itself");
  const std::vector<Vector2d> waypoints =
      route.empty() ? std::vector<Vector2d>() : read_option("--route", [&] { return parse_waypoints(route); });
  return read_option("--behaviour", [&] { return make_behaviour(behaviour, waypoints, speed_mps, loop); });
}

void AccessOptions::add_options(CLI::App& app, const std::string& what) {
  app.add_option("--slot", slot, "sends " + what + " in slot I of N, from 0, by the clock of its vehicle")
      ->type_name("I/N");
  add_number(app, "--slot-s", slot_s, "S", 0.1, 3600, "length of a slot");
  app.add_option("--guard-s", guard_s,
                 "the end of a slot in which nothing is begun; without it all but its first second, or the second half "
                 "of a short one")
      ->type_name("S")
      ->check(command_line::number_from(0, 3600));
  add_number(app, "--random-s", random_s, "S", 0, 3600,
             "sends at random, so often on average; 0: in its slot or never");
  app.add_option("--seed", seed, "of --random-s")->type_name("N")->capture_default_str()->check(command_line::seed());
}

ChannelAccess::Params AccessOptions::access() const {
  ChannelAccess::Params access;
  access.random_mean_s = random_s;
  access.seed = seed;
  if (slot.empty()) return access;
  if (random_s > 0) throw std::invalid_argument("--slot and --random-s are two ways of sending; give one");
  access.slot = read_option("--slot", [&] { return parse_slot(slot); });
  access.slot->slot_s = slot_s;
  access.slot->guard_s = guard_s.value_or(default_guard_s(slot_s));
  const Tdma checked(*access.slot);
  return access;
}

}  // namespace autonomy
