// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "autonomy/cooperative/driver/nav_record.hpp"
#include "shoal/estimate_t.hpp"

namespace navigation {

/// Estimates of one algorithm, computed from a record: with the deliveries of the run, and the payloads that the
/// vehicles would have said with this algorithm.
struct OfflineRun {
  struct Published {
    std::int64_t time_us = 0;  ///< simulated
    shoal::estimate_t message{};
  };
  std::string algorithm;
  std::vector<std::vector<Published>> estimates;  ///< by vehicle
  int frames_said = 0;
  int ranges = 0;                          ///< given to the estimators; on land the relative measurements
  std::vector<std::size_t> payload_bytes;  ///< said by each vehicle; 0 for an algorithm of the whole team
  double cpu_s = 0;                        ///< of the estimators and the driver
  std::size_t events = 0;
};

/// Runs an algorithm for all vehicles, with decisions as the live program makes them, on land by LandRun.  `options`:
/// by vehicle.  Throws std::invalid_argument when the algorithm cannot work.
OfflineRun run_offline(const NavRecord& record, const Algorithm& algorithm, const std::vector<NavOptions>& options);

}  // namespace navigation
