// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cassert>
#include <cmath>
#include <compare>

namespace sim {

// Levels and powers have different types: adding decibels multiplies powers, and the compiler rejects mixing the two.
// The only conversions are to_decibels() and to_power().
//
// Underwater levels are relative to a pressure of 1 uPa: a source level is that at 1 m from the source, a noise level
// is per hertz or in a band, as its name states.

/// Level, or gain (negative: loss), in dB.  Minus infinity: zero power.
class Decibels {
 public:
  constexpr Decibels() = default;
  constexpr explicit Decibels(double dB) : dB_(dB) {}

  constexpr double dB() const { return dB_; }

  /// Gains in series: their decibels add.
  constexpr Decibels& operator+=(Decibels other) {
    dB_ += other.dB_;
    return *this;
  }
  constexpr Decibels& operator-=(Decibels other) {
    dB_ -= other.dB_;
    return *this;
  }
  friend constexpr Decibels operator+(Decibels a, Decibels b) { return Decibels(a.dB_ + b.dB_); }
  friend constexpr Decibels operator-(Decibels a, Decibels b) { return Decibels(a.dB_ - b.dB_); }
  constexpr Decibels operator-() const { return Decibels(-dB_); }
  /// Repeated gain, such as dB per bounce times the number of bounces.
  friend constexpr Decibels operator*(double times, Decibels each) { return Decibels(times * each.dB_); }
  friend constexpr auto operator<=>(Decibels a, Decibels b) = default;  // NOLINT(modernize-use-nullptr): not a null
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive.not_only_finite(dB_);  // -infinity: silence
    if (archive.restoring() && !(dB_ <= max_dB)) archive.fail("a level beyond any physical one");
  }

 private:
  static constexpr double max_dB = 1000;

  double dB_ = 0;
};

/// Power relative to a reference (1 uPa, or another power): linear, not negative.
class PowerRatio {
 public:
  constexpr PowerRatio() = default;
  constexpr explicit PowerRatio(double linear) : linear_(linear) { assert(linear >= 0); }

  constexpr double linear() const { return linear_; }

  /// Sum of incoherent sounds: their powers add.
  constexpr PowerRatio& operator+=(PowerRatio other) {
    linear_ += other.linear_;
    return *this;
  }
  friend constexpr PowerRatio operator+(PowerRatio a, PowerRatio b) { return PowerRatio(a.linear_ + b.linear_); }
  friend constexpr PowerRatio operator*(PowerRatio a, PowerRatio b) { return PowerRatio(a.linear_ * b.linear_); }
  friend constexpr PowerRatio operator/(PowerRatio a, PowerRatio b) { return PowerRatio(a.linear_ / b.linear_); }
  friend constexpr PowerRatio operator*(double times, PowerRatio each) { return PowerRatio(times * each.linear_); }
  friend constexpr auto operator<=>(PowerRatio a, PowerRatio b) = default;
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(linear_);
    if (archive.restoring() && !(linear_ >= 0)) archive.fail("a negative power");
  }

 private:
  double linear_ = 0;
};

/// Level of a power: 10 log10; zero power gives minus infinity.
inline Decibels to_decibels(PowerRatio power) {
  return Decibels(10 * std::log10(power.linear()));
}
/// Power of a level.
inline PowerRatio to_power(Decibels level) {
  return PowerRatio(std::pow(10.0, level.dB() / 10));
}

/// Level of a pressure: 20 log10.  `pressure`: relative to the reference pressure, of any sign.
inline Decibels pressure_level(double pressure) {
  return Decibels(20 * std::log10(std::abs(pressure)));
}

/// Reference pressure of underwater levels, Pa.
inline constexpr double reference_pressure_Pa = 1e-6;
/// Source level of one acoustic watt radiated in all directions in sea water, dB re 1 uPa at 1 m: 10 log10(rho c / 4
/// pi) + 120, with rho c = 1.54e6 (Urick, Principles of Underwater Sound, 1983, chapter 4).
inline constexpr Decibels one_watt_level{170.9};

}  // namespace sim
