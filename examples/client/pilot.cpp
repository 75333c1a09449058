// SPDX-License-Identifier: BSD-3-Clause
// Drives rover1 of worlds/minimal.yaml towards the wall, in lockstep, and stops before it.
#include <iostream>

#include "shoal/client.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/twist_command_t.hpp"

int main() {
  double ahead_m = 0;
  try {
    shoal::Client client("pilot");  // on LCM_DEFAULT_URL, else LCM's default
    client.subscribe<shoal::planar_lidar_t>("rover1.lidar", [&](const shoal::planar_lidar_t& scan) {
      if (scan.nranges > 0) ahead_m = scan.ranges[scan.ranges.size() / 2];
    });
    client.join(0.1);                              // a tick every 0.1 s of simulated time
    while (const auto now = client.next_tick()) {  // all reports up to now have been handled
      shoal::twist_command_t command{};
      command.utime = *now;
      command.forward_mps = ahead_m > 1.0 ? 0.5 : 0.0;
      client.publish("rover1.drive.cmd", command);
    }
    std::cout << "the run is over, " << ahead_m << " m before the wall\n";
  } catch (const shoal::ClientError& error) {
    std::cerr << "pilot: " << error.what() << '\n';
    return 4;
  }
}
