// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/camera/texture.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Optical properties of water at 650, 550 and 450 nm: red, green and blue, 1/m.
struct WaterOptics {
  LinearColor absorption = LinearColor::Zero();
  LinearColor scattering = LinearColor::Zero();
  LinearColor attenuation = LinearColor::Zero();  ///< of a beam: the sum of both
  LinearColor downward = LinearColor::Zero();     ///< of daylight with depth
  LinearColor molecular = LinearColor::Zero();    ///< part of the scattering: that of the water itself
};

/// Returns the properties of water in which a black target disappears at `visibility_m`, seen horizontally: 4.8 over
/// the beam attenuation at 550 nm (Zaneveld and Pegau 2003).  Absorption of pure water after Pope and Fry (1997),
/// scattering after Morel (1974); particles scatter all colors equally and come with dissolved matter that absorbs blue
/// (Bricaud et al. 1981).  Daylight with depth after Kirk (1984).  More than the 60 m of the clearest natural water
/// thin all properties equally.
WaterOptics water_optics(double visibility_m);

/// Classes of water by Jerlov (1976): of the ocean I to III, of coasts 1C to 9C, each from clear to turbid.
enum class JerlovType { I, IA, IB, II, III, C1, C3, C5, C7, C9 };

/// Returns the properties of a class of water.  Daylight with depth: Jerlov (1976), table XXVII.  Scattering at 550 nm:
/// Solonenko and Mobley (2015); that of particles falls with the wavelength to the power of 1.7 (Kopelevich 1983).
/// Absorption: that with which both agree by the equation of Kirk (1984), K^2 = a^2 + 0.256 a b.
WaterOptics water_optics(JerlovType type);

/// Returns the properties of open sea (case 1) whose other matter goes with its chlorophyll.  Absorption: Morel (1991)
/// with the spectrum of Prieur and Sathyendranath (1981); scattering: Gordon and Morel (1983); daylight with depth:
/// Kirk (1984).  `chlorophyll_mgpm3`: from 0.
WaterOptics chlorophyll_optics(double chlorophyll_mgpm3);

/// `water:` of a camera: water as the camera sees it.
struct WaterLookConfig {
  // One of the three.
  std::optional<JerlovType> jerlov;
  std::optional<double> chlorophyll_mgpm3;
  std::optional<double> visibility_m;
  bool details = true;            ///< false: neither caustics nor particles
  bool caustics = true;           ///< pattern of sunlight that waves focus
  double particles_per_m3 = 500;  ///< marine snow
  void read(ParamReader& in);
  WaterOptics optics() const;
  bool has_caustics() const { return details && caustics; }
  /// Returns the particles in a cubic meter that are drawn.
  double particles() const { return details ? particles_per_m3 : 0; }
};

}  // namespace sim
