// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/medium_config.hpp"

#include <algorithm>
#include <filesystem>

#include "sim/config/choice_keys.hpp"
#include "sim/config/message_text.hpp"
#include "sim/medium/ctd_file.hpp"
#include "sim/medium/sea_states.hpp"

namespace sim {

namespace {

void read_pair(ParamReader& in, const char* key, std::vector<double>& value, const char* meaning) {
  const std::vector<double> before = value;
  in.read(key, value, any_number(), meaning);
  if (value.size() == 2) return;
  in.error(key, "'" + std::string(key) + "' must be 2 numbers, got " + std::to_string(value.size()));
  value = before;
}

template <typename Layer>
void check_depths(ParamReader& in, const std::vector<Layer>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i].depth_m > rows[i - 1].depth_m)) {
      in.error("profile", "'depth_m' must increase from row to row of 'profile', got " + number_text(rows[i].depth_m) +
                              " after " + number_text(rows[i - 1].depth_m));
      return;
    }
}

/// Checks that a column of the profile is in all rows or in none.
void check_column(ParamReader& in, const std::vector<WaterLayerConfig>& rows,
                  std::optional<double> WaterLayerConfig::*column, const char* key) {
  const auto given =
      std::count_if(rows.begin(), rows.end(), [&](const auto& row) { return (row.*column).has_value(); });
  if (given != 0 && given != std::ssize(rows))
    in.error("profile", "'" + std::string(key) + "' must be in all rows of 'profile' or in none");
}

void keep_place(ParamReader& in, SourcePlace& place) {
  if (!in.describing()) place = in.node()->place;
}

}  // namespace

namespace {

/// Reads `profile_file:` in place of the rows of `profile:`.
void read_profile_file(ParamReader& in, WaterConfig& water) {
  std::string file;
  const bool may_read = in.read_path("profile_file", file, PathUse::read,
                                     "instead of 'profile': CSV of a CTD with depth_m or pressure_dbar, temperature_C, "
                                     "salinity_psu; relative to this file");
  if (in.describing() || file.empty() || !may_read) return;
  if (in.has("profile")) in.error("profile_file", "'profile_file' and 'profile' exclude each other");
  const SourcePlace& place = in.node()->place;
  const std::filesystem::path folder = std::filesystem::path(place.file != nullptr ? *place.file : "").parent_path();
  try {
    CtdCast cast = read_ctd_file((folder / file).string());
    water.profile = std::move(cast.rows);
    for (const std::string& warning : cast.warnings)
      water.warnings.push_back("'profile_file' '" + file + "' " + warning);
  } catch (const CtdError& error) {
    in.error("profile_file", "'profile_file' '" + file + "' " + error.what());
  }
}

}  // namespace

void WaterLayerConfig::read(ParamReader& in) {
  in.require("depth_m");
  in.read("depth_m", depth_m, between(0, 12000), "depth below the surface; must increase from row to row");
  in.read("temperature_C", temperature_C, between(-5, 100), "temperature of the water there");
  in.read("salinity_psu", salinity_psu, between(0, 400), "salinity of the water there");
  in.read("density_kgpm3", density_kgpm3, between(1, 20000), "density of the water there; in all rows or in none");
  in.read("sound_speed_mps", sound_speed_mps, between(100, 10000), "there; in all rows or in none");
}

void WaterConfig::read(ParamReader& in) {
  keep_place(in, place);
  // Surface, density, temperature and salinity.
  in.read("surface_m", surface_m, between(-1e6, 1e6), "height of the still surface in the world");
  in.read_choice("density", density, {{"constant", Density::constant}, {"eos80", Density::eos80}},
                 "constant: density_kgpm3; eos80: from temperature, salinity and pressure");
  in.read("density_kgpm3", density_kgpm3, between(1, 20000), "density of the water; sea 1025, fresh 1000");
  in.read("temperature_C", temperature_C, between(-5, 100), "temperature of the water");
  in.read("salinity_psu", salinity_psu, between(0, 400), "salinity of the water");
  in.read_list("profile", profile, "row", "temperature and salinity by depth, linear in between");
  read_profile_file(in, *this);
  // Speed of sound.
  in.read_choice("sound_speed", sound,
                 {{"mackenzie", SoundSpeed::mackenzie}, {"medwin", SoundSpeed::medwin}, {"unesco", SoundSpeed::unesco}},
                 "equation, where no number is given");
  in.read("sound_speed_mps", sound_speed_mps, between(100, 10000), "the same everywhere");
  // Check that the keys are consistent.
  if (in.describing()) return;
  check_depths(in, profile);
  check_column(in, profile, &WaterLayerConfig::density_kgpm3, "density_kgpm3");
  check_column(in, profile, &WaterLayerConfig::sound_speed_mps, "sound_speed_mps");
  const bool density_rows = !profile.empty() && profile[0].density_kgpm3;
  if (density == Density::eos80 && (in.has("density_kgpm3") || density_rows))
    in.error("density", "'density' eos80 computes the density; leave out 'density_kgpm3'");
  if (!profile.empty())
    for (const char* key : {"temperature_C", "salinity_psu"})
      if (in.has(key)) in.error(key, "'" + std::string(key) + "' does not apply to water with a 'profile'");
  if (density_rows && in.has("density_kgpm3")) in.error("density_kgpm3", "'profile' already gives 'density_kgpm3'");
  if (sound_speed_mps && !profile.empty() && profile[0].sound_speed_mps)
    in.error("sound_speed_mps", "'profile' already gives 'sound_speed_mps'");
}

void CurrentLayerConfig::read(ParamReader& in) {
  in.require("depth_m");
  in.read("depth_m", depth_m, between(0, 12000), "depth below the surface; must increase from row to row");
  in.read("velocity_mps", velocity_mps, between(-100, 100), "east, north, up");
}

namespace {

constexpr ChoiceWords<CurrentConfig::Type> current_type_words{{"constant", CurrentConfig::Type::constant},
                                                              {"profile", CurrentConfig::Type::profile},
                                                              {"power_law", CurrentConfig::Type::power_law},
                                                              {"wind_driven", CurrentConfig::Type::wind_driven},
                                                              {"gauss_markov", CurrentConfig::Type::gauss_markov},
                                                              {"vortex", CurrentConfig::Type::vortex},
                                                              {"grid", CurrentConfig::Type::grid}};

ChoiceKeys keys_of_current(CurrentConfig::Type type) {
  switch (type) {
    case CurrentConfig::Type::constant:
      return {"velocity_mps"};
    case CurrentConfig::Type::profile:
      return {"profile"};
    case CurrentConfig::Type::power_law:
      return {"speed_mps", "direction_deg", "water_depth_m", "exponent"};
    case CurrentConfig::Type::wind_driven:
      return {"speed_mps", "direction_deg", "reference_depth_m"};
    case CurrentConfig::Type::gauss_markov:
      return {"speed_mps", "direction_deg", "std_mps", "direction_std_deg", "vertical_std_mps", "correlation_time_s"};
    case CurrentConfig::Type::vortex:
      return {"center_m", "peak_speed_mps", "core_radius_m", "core"};
    case CurrentConfig::Type::grid:
      break;
  }
  return {"file", "east_file", "north_file", "map_origin_m", "outside"};
}

}  // namespace

void CurrentConfig::read(ParamReader& in) {
  keep_place(in, place);
  if (place.file) directory = std::filesystem::path(*place.file).parent_path().string();
  in.read_choice("type", type, current_type_words, "how this part of the current flows");
  in.read("velocity_mps", velocity_mps, between(-100, 100), "constant: east, north, up");
  // Velocity profiles over the depth.
  in.read_list("profile", profile, "row", "profile: velocities by depth, linear in between");
  in.read("speed_mps", speed_mps, between(0, 100), "power_law, wind_driven: at the surface; gauss_markov: mean");
  in.read_deg("direction_deg", direction_rad, between(-360, 360),
              "direction towards which it flows, counter-clockwise from east");
  in.read("water_depth_m", water_depth_m, above_to(0, 12000), "power_law: depth of the bottom");
  in.read("exponent", exponent, between(0, 10), "power_law");
  in.read("reference_depth_m", reference_depth_m, above_to(0, 12000), "wind_driven: no current below");
  // Gauss-Markov process.
  in.read("std_mps", std_mps, between(0, 10), "gauss_markov: of the speed, over a long time");
  in.read_deg("direction_std_deg", direction_std_rad, between(0, 180), "gauss_markov: of the direction");
  in.read("vertical_std_mps", vertical_std_mps, between(0, 10), "gauss_markov: of the vertical velocity");
  in.read("correlation_time_s", correlation_time_s, between(0.05, 1e7), "gauss_markov: 1 / mu");
  // Vortex.
  read_pair(in, "center_m", center_m, "vortex: east, north");
  in.read("peak_speed_mps", peak_speed_mps, between(-100, 100), "vortex: positive turns counter-clockwise");
  in.read("core_radius_m", core_radius_m, above_to(0, 1e7), "vortex: where it is fastest");
  in.read_choice("core", core, {{"lamb_oseen", Core::lamb_oseen}, {"rankine", Core::rankine}},
                 "vortex: profile of the speed over the radius");
  // Grid.
  in.read_path("file", file, PathUse::read,
               "grid: CSV with columns x_m, y_m, east_mps, north_mps; relative to this file");
  in.read_path("east_file", east_file, PathUse::read, "grid: ESRI ASCII grid of the velocity to the east, m/s");
  in.read_path("north_file", north_file, PathUse::read, "grid: ESRI ASCII grid of the velocity to the north, m/s");
  read_pair(in, "map_origin_m", map_origin_m, "grid: position of the world's origin in the files");
  in.read_choice("outside", outside, {{"zero", Outside::zero}, {"edge", Outside::edge}},
                 "grid: the current beyond its border");
  if (in.describing()) return;
  refuse_keys_of_others(in, "type", current_type_words, type, keys_of_current);
  check_depths(in, profile);
  if (type == Type::profile && profile.empty()) in.error("current of type profile needs the key 'profile'");
  const bool pair = !east_file.empty() && !north_file.empty(), half = east_file.empty() != north_file.empty();
  if (type == Type::grid && (half || file.empty() != pair))
    in.error("current of type grid needs either 'file' or both 'east_file' and 'north_file'");
}

void TideConfig::read(ParamReader& in) {
  in.read("amplitude_m", amplitude_m, between(0, 20), "high water over the still surface");
  in.read("period_s", period_s, above_to(0, 1e9), "44714 is the M2 tide");
  in.read_deg("phase_deg", phase_rad, between(-360, 360), "at time 0; 0: high water");
  in.read("current_mps", current_mps, between(0, 20), "highest speed of the tidal current");
  in.read_deg("current_direction_deg", current_direction_rad, between(-360, 360),
              "direction of the flood, counter-clockwise from east");
  in.read_deg("current_lead_deg", current_lead_rad, between(-360, 360),
              "phase lead of the fastest flood over high water; 90: slack at high water");
}

void GustConfig::read(ParamReader& in) {
  in.read("std_mps", std_mps, between(0, 50), "along the wind");
  in.read("across_std_mps", across_std_mps, between(0, 50), "across, level");
  in.read("vertical_std_mps", vertical_std_mps, between(0, 50), "up and down");
  in.read("correlation_time_s", correlation_time_s, between(0.05, 1e6),
          "correlation time of the gusts; 10 when 'length_m' is absent");
  in.read("length_m", length_m, above_to(0, 1e6),
          "length of the gusts along the wind: the time is this by the mean speed");
  if (correlation_time_s && length_m) in.error("length_m", "'length_m' and 'correlation_time_s' exclude each other");
}

void WindConfig::read(ParamReader& in) {
  keep_place(in, place);
  // Mean wind.
  in.read("velocity_mps", velocity_mps, between(-120, 120), "east, north, up, at the reference height");
  in.read("speed_mps", speed_mps, between(0, 120), "instead of 'velocity_mps'");
  in.read_deg("direction_deg", direction_rad, between(-360, 360),
              "direction towards which it blows, counter-clockwise from east");
  in.read("from_compass_deg", from_compass_deg, between(-360, 360),
          "direction from which it blows, clockwise from north, as in forecasts");
  // Profile over the height, and gusts.
  in.read_choice("profile", profile, {{"uniform", Profile::uniform}, {"power", Profile::power}, {"log", Profile::log}},
                 "profile of the mean over the height");
  in.read("reference_height_m", reference_height_m, above_to(0.001, 1000),
          "height of the given wind over the still water");
  in.read("exponent", exponent, between(0, 1), "power");
  in.read("roughness_m", roughness_m, between(1e-7, 10), "log: roughness length; below the reference height");
  in.read("gusts", gusts, "unset: steady");
  if (in.describing()) return;
  if (in.has("velocity_mps") && in.has("speed_mps"))
    in.error("speed_mps", "'speed_mps' and 'velocity_mps' exclude each other");
  if (in.has("direction_deg") && in.has("from_compass_deg"))
    in.error("from_compass_deg", "'from_compass_deg' and 'direction_deg' exclude each other");
  if (roughness_m >= reference_height_m) in.error("roughness_m", "'roughness_m' must be below 'reference_height_m'");
  if (gusts && gusts->length_m && mean_mps().norm() < 0.1)
    in.error("gusts", "gusts with 'length_m' need a mean wind of 0.1 m/s or more");
}

Vector3d WindConfig::mean_mps() const {
  if (speed_mps == 0) return velocity_mps;
  const double to_rad = from_compass_deg ? degrees_to_radians(270 - *from_compass_deg) : direction_rad;
  return speed_mps * Vector3d(std::cos(to_rad), std::sin(to_rad), 0);
}

namespace {

constexpr ChoiceWords<WavesConfig::Type> waves_type_words{{"regular", WavesConfig::Type::regular},
                                                          {"jonswap", WavesConfig::Type::jonswap},
                                                          {"pierson_moskowitz", WavesConfig::Type::pierson_moskowitz}};

ChoiceKeys keys_of_waves(WavesConfig::Type type) {
  switch (type) {
    case WavesConfig::Type::regular:
      return {"height_m", "period_s", "phase_deg"};
    case WavesConfig::Type::jonswap:
      return {"hs_m", "tp_s", "sea_state", "components", "cutoff", "spreading", "gamma"};
    case WavesConfig::Type::pierson_moskowitz:
      break;
  }
  return {"hs_m", "tp_s", "sea_state", "components", "cutoff", "spreading"};
}

void check_keys_of_waves(ParamReader& in, WavesConfig::Type type) {
  refuse_keys_of_others(in, "type", waves_type_words, type, keys_of_waves);
  if (in.has("sea_state") && (in.has("hs_m") || in.has("tp_s")))
    in.error("sea_state", "'sea_state' gives height and period; leave out 'hs_m' and 'tp_s'");
}

/// Sets height and period of a sea state: the period is the most probable one in the open North Atlantic (source as for
/// the heights; sea states 0 and 1 have no period there and use that of 2).
void take_sea_state(WavesConfig& waves) {
  constexpr double tp_s[] = {7.5, 7.5, 7.5, 7.5, 8.8, 9.7, 12.4, 15, 16.4};
  waves.hs_m = hs_of_sea_state_m[static_cast<std::size_t>(waves.sea_state)];
  waves.tp_s = tp_s[waves.sea_state];
}

}  // namespace

void WavesConfig::read(ParamReader& in) {
  keep_place(in, place);
  in.read_choice("type", type, waves_type_words, "one wave, or a sea by its spectrum");
  // Regular wave.
  in.read("height_m", height_m, between(0, 40), "regular: crest over trough");
  in.read("period_s", period_s, between(0.2, 60), "regular");
  in.read_deg("phase_deg", phase_rad, between(-360, 360), "regular: at the origin at time 0; 0: a crest");
  // Irregular sea.
  in.read("hs_m", hs_m, between(0, 40), "significant wave height");
  in.read("tp_s", tp_s, between(0.2, 60), "peak period");
  in.read("gamma", gamma, between(1, 10), "jonswap: peak enhancement factor gamma; 1: as pierson_moskowitz");
  in.read("sea_state", sea_state, between(0, 8),
          "instead of 'hs_m' and 'tp_s': those of the open North Atlantic; 0: calm");
  in.read("components", components, between(1, max_components), "number of wave components");
  in.read("cutoff", cutoff, between(1.5, 50), "highest frequency relative to the peak frequency");
  in.read("spreading", spreading, between(0.5, 1000),
          "exponent s of the spreading cos^2s of half the angle; unset: long-crested");
  in.read_deg("direction_deg", direction_rad, between(-360, 360),
              "direction towards which they travel, counter-clockwise from east");
  in.read("water_depth_m", water_depth_m, above_to(0.01, 12000), "water depth for the waves; unset: deep water");
  if (in.describing()) return;
  check_keys_of_waves(in, type);
  if (in.has("sea_state")) take_sea_state(*this);
}

namespace {

/// Reads a list, which may be given as a single map when it has one entry.
template <typename Entry>
void read_one_or_more(ParamReader& in, const char* key, std::vector<Entry>& entries, const char* kind,
                      const char* meaning) {
  const ConfigNode* node = in.has(key) ? in.child(key) : nullptr;
  if (node == nullptr || node->kind != ConfigNode::Kind::map) return in.read_list(key, entries, kind, meaning);
  ConfigNode list;
  list.kind = ConfigNode::Kind::list;
  list.items = {*node};
  list.place = node->place;
  const ConfigNode wrapped = map_node(key, list);
  ParamReader of_one(wrapped, in.who(), in.diagnostics());
  of_one.read_list(key, entries, kind, meaning);
}

}  // namespace

void MediumConfig::read(ParamReader& in) {
  in.read("water", water, "the sea, a lake or a tank; unset: the world is dry");
  read_one_or_more(in, "current", current, "current", "how the water flows; the entries add up");
  read_one_or_more(in, "tides", tides, "tide", "tidal constituents of surface and current; the entries add up");
  in.read("waves", waves, "unset: the surface is flat");
  in.read("wind", wind, "unset: still air");
  if (in.describing()) return;
  for (const char* key : {"current", "tides", "waves"})
    if (in.has(key) && !water) in.error(key, "'" + std::string(key) + "' needs 'water'");
}

}  // namespace sim
