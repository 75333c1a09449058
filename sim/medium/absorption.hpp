// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

/// Properties of sea water that determine the absorption of sound.
struct SeaWater {
  double temperature_C = 10;
  double salinity_psu = 35;
  double depth_m = 0;
  double pH = 8;
};

/// Absorption of sound in the sea by W. H. Thorp's formula, dB/km: at 4 C and 1 km depth, 0.1 to 50 kHz (Deep-sea sound
/// attenuation in the sub- and low-kilocycle-per-second region, JASA 38, 1965, in the metric form of Urick).
double thorp_dBpkm(double frequency_kHz);

/// Absorption of sound in sea water, dB/km, 0.4 to 1000 kHz: boric acid, magnesium sulphate and pure water (R. E.
/// Francois and G. R. Garrison, Sound absorption based on ocean measurements, JASA 72, 1982, part II).
double francois_garrison_dBpkm(double frequency_kHz, const SeaWater& water);

}  // namespace sim
