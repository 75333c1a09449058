// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/wave_spectrum.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/medium/medium_worlds.hpp"
#include "tests/sim/medium/wave_records.hpp"

namespace {

using namespace wave_records;

using test::closed_form;
using test::closed_forms_of;
using test::ClosedForm;

TEST(Spectrum, HasThePeakOfItsFormula) {
  for (const auto& form : closed_forms_of("pierson_moskowitz", "peak_spectral_density"))
    EXPECT_NEAR(sim::pierson_moskowitz_m2s(2 * pi / form.at("Tp"), form.at("Hs"), form.at("Tp")), form.expected, 1e-9);
  for (const auto& form : closed_forms_of("jonswap", "peak_spectral_density"))
    EXPECT_NEAR(sim::jonswap_m2s(2 * pi / form.at("Tp"), form.at("Hs"), form.at("Tp"), form.at("gamma")), form.expected,
                1e-9);
  EXPECT_DOUBLE_EQ(sim::jonswap_m2s(1.7, 1, 5, 1), sim::pierson_moskowitz_m2s(1.7, 1, 5));
  EXPECT_EQ(sim::jonswap_m2s(0, 1, 5, 3.3), 0);
}

struct Moments {
  double m0 = 0, m1 = 0, m2 = 0;
};

Moments moments_of(const std::string& waves, std::uint64_t seed) {
  sim::Random random(seed, "test");
  random.begin_step(0);
  Moments sums;
  for (const auto& wave :
       sim::make_waves(*test_support::read_medium("{water: {}, waves: {" + waves + "}}").waves, g, random)) {
    const double variance = wave.amplitude_m * wave.amplitude_m / 2;
    sums.m0 += variance;
    sums.m1 += variance * wave.omega_radps;
    sums.m2 += variance * wave.omega_radps * wave.omega_radps;
  }
  return sums;
}

TEST(IrregularWaves, HaveTheMomentsOfTheirSpectrum) {
  // Tz and T1 of the rows with their cut-off at 40 wp: 5 % there, 1 % here, as bins are narrow; m0 is exact.
  for (const ClosedForm& row : rows_of_spectra())
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const Moments sums = moments_of(spectrum_of(row) + ", cutoff: 40", seed);
      const auto expect = [&](double value, double tolerance) {
        EXPECT_NEAR(value, row.expected, tolerance) << row.quantity << " of " << spectrum_of(row);
      };
      if (row.quantity == "variance") expect(sums.m0, 1e-12);
      if (row.quantity == "Tz") expect(2 * pi * std::sqrt(sums.m0 / sums.m2), 0.01 * row.expected);
      if (row.quantity == "T1") expect(2 * pi * sums.m0 / sums.m1, 0.01 * row.expected);
    }
  // What the default cut-off at 10 wp leaves out: (5/32) Hs^2 wp^2 / 100 of m2, 0.6 % of Tz.
  const ClosedForm tz = closed_form("jonswap", "Hs=2", "Tz");
  const Moments cut = moments_of(spectrum_of(tz), 1);
  EXPECT_NEAR(2 * pi * std::sqrt(cut.m0 / cut.m2), tz.expected, 0.016 * tz.expected);
}

}  // namespace
