// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cassert>
#include <cmath>
#include <compare>

namespace sim {

// A level and a power are different types: adding decibels multiplies powers, and the compiler rejects mixing the
// two. The only conversions are to_decibels() and to_power().
//
// Levels under water are over the pressure of 1 uPa: a source level is that at 1 m from the source, a noise level is
// per hertz or in a band, as its name says.

/// A level, or a gain (negative: a loss), in dB.  Minus infinity: no power at all.
class Decibels {
 public:
  constexpr Decibels() = default;
  constexpr explicit Decibels(double dB) : dB_(dB) {}

  constexpr double dB() const { return dB_; }

  /// The gains one after the other.
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
  /// So many times the same gain, such as dB per bounce by bounces.
  friend constexpr Decibels operator*(double times, Decibels each) { return Decibels(times * each.dB_); }
  friend constexpr auto operator<=>(Decibels a, Decibels b) = default;
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive.not_only_finite(dB_);  // -infinity: silence
    if (archive.restoring() && !(dB_ <= max_dB)) archive.fail("a level beyond any physical one");
  }

 private:
  static constexpr double max_dB = 1000;

  double dB_ = 0;
};

/// A power over that of the reference (1 uPa, or another power): linear, not negative.
class PowerRatio {
 public:
  constexpr PowerRatio() = default;
  constexpr explicit PowerRatio(double linear) : linear_(linear) { assert(linear >= 0); }

  constexpr double linear() const { return linear_; }

  /// Of sounds that do not interfere: their powers add up.
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

/// 10 log10; nothing at all is minus infinity.
inline Decibels to_decibels(PowerRatio power) {
  return Decibels(10 * std::log10(power.linear()));
}
inline PowerRatio to_power(Decibels level) {
  return PowerRatio(std::pow(10.0, level.dB() / 10));
}

/// Of a pressure: 20 log10.  `pressure` over the reference pressure, of any sign.
inline Decibels pressure_level(double pressure) {
  return Decibels(20 * std::log10(std::abs(pressure)));
}

/// The pressure that levels under water are over, Pa.
inline constexpr double reference_pressure_Pa = 1e-6;
/// What a plane wave of one acoustic watt, spread over all directions, has at 1 m in sea water, dB re 1 uPa:
/// 10 log10(rho c / 4 pi) + 120, with rho c = 1.54e6 (Urick, Principles of Underwater Sound, 1983, chapter 4).
inline constexpr Decibels one_watt_level{170.9};

}  // namespace sim
