// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

// Directions are those of motion (where to), counter-clockwise from east.

/// Row of `profile:` of the water.
struct WaterLayerConfig {
  double depth_m = 0;  ///< below the surface
  double temperature_C = 10;
  double salinity_psu = 35;
  std::optional<double> density_kgpm3;
  std::optional<double> sound_speed_mps;
  void read(ParamReader& in);
};

/// `water:` of a medium.
struct WaterConfig {
  enum class Density { constant, eos80 };
  enum class SoundSpeed { mackenzie, medwin, unesco };

  double surface_m = 0;                      ///< height of the still surface in the world
  double density_kgpm3 = 1025;               ///< sea water
  Density density = Density::constant;       ///< unless the profile has densities
  double temperature_C = 10;                 ///< without profile
  double salinity_psu = 35;                  ///< without profile
  std::vector<WaterLayerConfig> profile;     ///< by depth; linear between rows, constant beyond the ends
  SoundSpeed sound = SoundSpeed::mackenzie;  ///< unless profile or constant are given
  std::optional<double> sound_speed_mps;     ///< constant
  std::vector<std::string> warnings;         ///< about 'profile_file'
  SourcePlace place;
  void read(ParamReader& in);
};

/// Row of `profile:` of a current.
struct CurrentLayerConfig {
  double depth_m = 0;
  Vector3d velocity_mps = Vector3d::Zero();
  void read(ParamReader& in);
};

/// Entry of `current:` of a medium.
struct CurrentConfig {
  enum class Type { constant, profile, power_law, wind_driven, gauss_markov, vortex, grid };
  enum class Core { lamb_oseen, rankine };
  enum class Outside {
    zero,  ///< no current beyond the border
    edge,  ///< velocity at the border
  };

  Type type = Type::constant;
  Vector3d velocity_mps = Vector3d::Zero();  ///< constant: east, north, up
  std::vector<CurrentLayerConfig> profile;   ///< profile
  double speed_mps = 0;                      ///< power_law, wind_driven: at the surface; gauss_markov: mean
  double direction_rad = 0;                  ///< of these three types
  double water_depth_m = 50;                 ///< power_law
  double exponent = 1.0 / 7;                 ///< power_law
  double reference_depth_m = 50;             ///< wind_driven: no current below
  double std_mps = 0.05;                     ///< gauss_markov: of the speed, stationary
  double direction_std_rad = 0;              ///< gauss_markov
  double vertical_std_mps = 0;               ///< gauss_markov
  double correlation_time_s = 50;            ///< gauss_markov
  std::vector<double> center_m{0, 0};        ///< vortex
  double peak_speed_mps = 0.5;               ///< vortex: counter-clockwise when positive
  double core_radius_m = 10;                 ///< vortex: radius of the peak speed
  Core core = Core::lamb_oseen;              ///< vortex
  std::string file;                          ///< grid: CSV
  std::string east_file, north_file;         ///< grid: ESRI ASCII grids
  std::vector<double> map_origin_m{0, 0};    ///< grid: position of the world's origin in the file
  Outside outside = Outside::zero;           ///< grid

  SourcePlace place;
  std::string directory;  ///< of the YAML file
  void read(ParamReader& in);
};

/// Entry of `tides:` of a medium.
struct TideConfig {
  double amplitude_m = 0;
  double period_s = 44714;  ///< the M2 tide: 12 h 25.2 min
  double phase_rad = 0;     ///< at time 0; high water at 0
  double current_mps = 0;   ///< peak speed
  double current_direction_rad = 0;
  double current_lead_rad = 0;  ///< phase lead of the peak current over high water
  void read(ParamReader& in);
};

/// `gusts:` of a wind.
struct GustConfig {
  double std_mps = 1;  ///< along the wind
  double across_std_mps = 0;
  double vertical_std_mps = 0;
  std::optional<double> correlation_time_s;
  std::optional<double> length_m;  ///< correlation length: time = length / mean speed
  void read(ParamReader& in);
};

/// `wind:` of a medium.
struct WindConfig {
  enum class Profile { uniform, power, log };

  Vector3d velocity_mps = Vector3d::Zero();  ///< east, north, up, at the reference height
  double speed_mps = 0;                      ///< instead of velocity_mps, with one of the directions
  double direction_rad = 0;
  std::optional<double> from_compass_deg;
  Profile profile = Profile::uniform;
  double reference_height_m = 10;
  double exponent = 0.11;       ///< power
  double roughness_m = 0.0002;  ///< log
  std::optional<GustConfig> gusts;
  SourcePlace place;
  void read(ParamReader& in);
  /// Mean wind at the reference height, without gusts.
  Vector3d mean_mps() const;
};

/// `waves:` of a medium.
struct WavesConfig {
  enum class Type { regular, jonswap, pierson_moskowitz };
  static constexpr int max_components = 1000;

  Type type = Type::jonswap;
  double height_m = 1;              ///< regular: crest over trough
  double period_s = 5;              ///< regular
  double phase_rad = 0;             ///< regular: at the world's origin at time 0; a crest is at 0
  double hs_m = 1;                  ///< irregular: significant wave height, 4 standard deviations of the elevation
  double tp_s = 6;                  ///< irregular: peak period
  double gamma = 3.3;               ///< jonswap: peak enhancement
  std::int64_t sea_state = 0;       ///< irregular: 0 to 8; sets hs_m and tp_s when given
  int components = 200;             ///< irregular
  double cutoff = 10;               ///< irregular: highest frequency over the peak frequency
  std::optional<double> spreading;  ///< irregular: s of cos^2s(half angle); unset: long-crested
  double direction_rad = 0;
  std::optional<double> water_depth_m;  ///< unset: deep
  SourcePlace place;
  void read(ParamReader& in);
};

/// `medium:` of a world.
struct MediumConfig {
  std::optional<WaterConfig> water;    ///< unset: no water
  std::vector<CurrentConfig> current;  ///< sum of the entries
  std::vector<TideConfig> tides;       ///< sum of the entries
  std::optional<WavesConfig> waves;
  std::optional<WindConfig> wind;
  void read(ParamReader& in);
};

}  // namespace sim
