// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace param_reader_fixture {

using Lines = std::vector<std::string>;

enum class Color { red, green };

struct Inner {
  int count = 1;
  std::string joint;
  void read(sim::ParamReader& in) {
    in.read("count", count, sim::at_least(1), "how many");
    in.read_reference("joint", joint, "joint", "what it turns");
  }
};

struct Tree {
  std::string name;
  std::vector<Tree> branches;
  void read(sim::ParamReader& in) {
    in.read("name", name, "its name");
    in.read_list("branches", branches, "branch", "more of the same");
  }
};

}  // namespace param_reader_fixture
