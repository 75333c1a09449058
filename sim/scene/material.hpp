// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/scene/color.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

/// A pattern on a surface, laid on along the axes of the part that the surface looks along least.
struct TextureConfig {
  enum class Pattern { none, checker, stripes, image };

  Pattern pattern = Pattern::none;
  std::vector<std::string> colors;  ///< checker, stripes: two of them, `#rrggbb`
  double size_m = 1;                ///< one field or stripe; the width of an image
  std::string file;                 ///< image: PNG or JPEG, relative to the YAML file
  std::string directory;            ///< of the YAML file
  SourcePlace place;
  void read(ParamReader& in);
};

/// How a surface sends back a laser beam.
struct LaserSurface {
  double reflectivity = 0.5;  ///< share of the power that comes back diffusely (Lambert); white wall 0.8, tyre 0.05
  double gloss = 0;           ///< share of it that a polished surface mirrors away, which only shows head-on
  void read(ParamReader& in);
};

/// How a surface sends back sound.
struct SoundSurface {
  /// Lambert's rule: S = backscatter_dB + 20 log10(sin grazing angle), dB re 1 m^2 per m^2.  -27 dB: Mackenzie (1961),
  /// the usual constant for the deep sea floor; rock -15, mud -35.
  double backscatter_dB = -27;
  void read(ParamReader& in);
};

/// What a part is made of, to light, lasers, sound and touch (see ContactConfig).
struct MaterialConfig {
  std::string name;
  std::string color;  ///< `#rrggbb`; empty: grey.  A part's own color wins.
  double gloss = 0;   ///< strength of the sun's highlight, 0 to 1
  TextureConfig texture;
  LaserSurface laser;
  SoundSurface sound;
  std::vector<std::string> lets_through;  ///< light, laser, sound

  void read(ParamReader& in);
  /// Bits of the kinds of ray that pass.
  std::uint8_t transmits() const;
};

}  // namespace sim
