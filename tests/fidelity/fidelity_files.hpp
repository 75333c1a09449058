// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_checks.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "verification/fidelity/fidelity.hpp"

namespace fidelity_files {

class FidelityFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  std::string error_of(const std::string& file, const verification::FidelityOptions& options = {}) {
    try {
      for (const verification::FidelityCase& of : verification::read_fidelity_file(file).cases)
        verification::run_fidelity_case(of, options);
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
    return {};
  }
  std::string cases(const std::string& more,
                    const std::string& vehicle = test_support::source_path("vehicles/bluerov2.yaml")) {
    return write("cases.yaml", "shoal: 1\ngroups:\n  - name: g\n    vehicle: " + vehicle + "\n" + more +
                                   "    cases: [{name: c, reference: c.csv}]\n");
  }
  const std::string header = "t[s],x,y,z,phi,theta,psi,u,v,w,p,q,r,push\n";
  /// At rest at a place.
  static std::string row(double t) { return sim::number_text(t) + ",1,2,3,0,0,0.5,0,0,0,0,0,0,0\n"; }
  test_support::ScratchFolder folder_;
};

}  // namespace fidelity_files
