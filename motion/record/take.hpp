// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace motion {

/// Subject and place of a recording.
struct TakeSettings {
  std::string world, vehicle;  ///< name of the world, and of the vehicle in it
  std::string model;           ///< vehicle model
  std::int64_t seed = 0;
  std::vector<std::string> set;  ///< changes of the world, as with --set
  double frame_s = 0.008;
  std::vector<std::string> joints;     ///< that are recorded
  std::vector<std::string> sliders;    ///< those of them whose values are in m
  bool over = false;                   ///< over the motion that the file has
  std::optional<double> from_s, to_s;  ///< part that is recorded
  void read(sim::ParamReader& in);
  std::string text() const;  ///< as one line of YAML
};

/// Action of the world during a recording.
struct TakeChange {
  double at_s = 0;  ///< time of the motion
  sim::ConfigNode action;
};

/// A recording: set points of joints by frame, rad or m, and changes of the world.
struct Take {
  TakeSettings settings;
  std::vector<std::vector<double>> frames;  ///< by joint, then by frame
  std::vector<TakeChange> changes;
  std::size_t frame_count() const { return frames.empty() ? 0 : frames.front().size(); }
};

/// Returns how many frames of this many joints a recording may have: as many as can be written.
std::size_t max_take_frames(std::size_t joints);

/// Changes of the world that a recording may have.
constexpr std::size_t max_take_changes = 100'000;

/// First line of a journal.
constexpr std::string_view take_head = "shoal recording 1\n";

/// Where a journal cannot be read further.
struct TakeDamage {
  std::string error;      ///< with the file and the line
  std::size_t lines = 0;  ///< that are dropped: the bad one and those after it
};

/// Reads a journal of a recording: `shoal recording 1`, its settings, then lines
/// - `f I=VALUE ...`: a frame, in which the joints I have other values than in the one before,
/// - `c AT_S ACTION`: a change of the world,
/// - `b N`: back to frame N: what came after it does not count.
/// A last line without its end was cut when the program ended, and is ignored.  Throws sim::ConfigError with the line.
/// `damage`: set where a line after the first frame is bad, and what stands before it is returned.
Take parse_take(std::string_view text, const std::string& file_name, std::optional<TakeDamage>* damage = nullptr);
/// Like parse_take(), from a file.  Throws sim::ConfigError.
Take read_take(const std::string& path, std::optional<TakeDamage>* damage = nullptr);

}  // namespace motion
