// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/scene/light.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

/// Pattern on a surface, projected along the axis of the part closest to the surface normal.
struct TextureConfig {
  /// Kind of pattern.
  enum class Pattern { none, checker, stripes, image };

  Pattern pattern = Pattern::none;
  std::vector<std::string> colors;  ///< checker, stripes: two of them, `#rrggbb`
  double size_m = 1;                ///< size of a field, width of a stripe or of the image
  std::string file;                 ///< image: PNG or JPEG, relative to the YAML file
  std::string directory;            ///< directory of the YAML file
  SourcePlace place;
  void read(ParamReader& in);
};

/// Reflection of a laser beam by a surface.
struct LaserSurface {
  double reflectivity = 0.5;  ///< share of the power reflected diffusely (Lambert); white wall 0.8, tire 0.05
  double gloss = 0;           ///< share of it in specular reflection, which returns only near normal incidence
  void read(ParamReader& in);
};

/// Backscatter of sound by a surface.
struct SoundSurface {
  /// Scattering strength by Lambert's rule: S = backscatter_dB + 20 log10(sin(grazing angle)), dB re 1 m^2 per m^2.
  /// Typical values: -27 dB for the deep sea floor (Mackenzie 1961), -15 dB for rock, -35 dB for mud.
  double backscatter_dB = -27;
  void read(ParamReader& in);
};

/// Material of a part: its response to light, lasers and sound.  Contacts refer to it by name (see ContactConfig).
struct MaterialConfig {
  std::string name;
  std::string color;  ///< `#rrggbb`; empty: default color.  The color of a part takes precedence.
  double gloss = 0;   ///< strength of the highlight of the sun, 0 to 1
  TextureConfig texture;
  LaserSurface laser;
  SoundSurface sound;
  std::vector<std::string> transparent_to;  ///< transmitted kinds of ray: light, laser, sound

  void read(ParamReader& in);
  /// Returns a bit mask of the transmitted kinds of ray (RayKind).
  std::uint8_t transmits() const;
};

}  // namespace sim
