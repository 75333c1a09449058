// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace sim {

/// Presets of a device: a YAML file with a map `NAME: {KEY: VALUE, ...}` of the keys that a user would write.  The
/// build embeds PATH/NAME_presets.yaml, which stands beside the source of the device, as the function NAME_presets()
/// (cmake/EmbedFiles.cmake).
class Presets {
 public:
  /// Parses the contents of a file.  `file`: its path, for errors.  Throws ConfigError for invalid YAML.
  Presets(const std::string& file, std::string_view text);

  /// Returns the names in the order of the file.
  std::vector<std::string> names() const;
  /// Reads the key `preset` into `params.preset`, and replaces the other members by the values of that preset: the
  /// defaults of the keys that are read after it.  `others`: names that are not of the file, listed first; the default
  /// of `preset` is one of them or empty.  Errors in the file are reported like those of the user.
  template <ReadsParams Params>
  void read(ParamReader& in, Params& params, std::vector<std::string> others, const char* meaning) const;

 private:
  ConfigNode root_;
};

template <ReadsParams Params>
void Presets::read(ParamReader& in, Params& params, std::vector<std::string> others, const char* meaning) const {
  for (std::string& name : names()) others.push_back(std::move(name));
  in.read_one_of("preset", params.preset, others, meaning);
  const ConfigNode* keys = in.describing() ? nullptr : root_.find(params.preset);
  if (keys == nullptr) return;
  // Their own `preset` has its default, which the file does not contain, so that only the keys are read.
  Params values;
  ParamReader of_preset(*keys, "preset '" + params.preset + "'", in.diagnostics());
  values.read(of_preset);
  of_preset.finish();
  values.preset = std::move(params.preset);
  params = std::move(values);
}

}  // namespace sim
