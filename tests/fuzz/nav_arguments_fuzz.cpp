// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_arguments.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// The arguments of shoal-nav in the world of a record.

SHOAL_FUZZ_TARGET(nav_arguments) {
  fuzz::allow<sim::ConfigError>([&] {
    for (const auto& [vehicle, arguments] : navigation::nav_arguments_of(std::string(fuzz::text_of(input))))
      fuzz::require(arguments.applied_to({}).period_us > 0, "time passes between two decisions");
  });
}
