// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/estimate_file.hpp"
#include "sim/config/diagnostics.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// Estimates of another program: TUM or CSV.

SHOAL_FUZZ_TARGET(estimate_file) {
  fuzz::allow<sim::ConfigError>([&] {
    const experiment::EstimateFile file = experiment::parse_estimates(fuzz::text_of(input), "estimates");
    fuzz::require(!file.rows.empty(), "a file has an estimate");
    double before_s = -1e300;
    for (const auto& row : file.rows) {
      fuzz::require(row.time_s > before_s, "times increase");
      fuzz::require(row.position_m.allFinite(), "positions are numbers");
      before_s = row.time_s;
    }
  });
}
