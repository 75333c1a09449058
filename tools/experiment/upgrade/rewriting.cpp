// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/rewriting.hpp"

namespace tools {

std::span<const Rewriting> rewritings() {
  static constexpr Rewriting all[] = {
      {"words instead of zeros", rewrite_zero},
      {"the type of a metric", rewrite_metric},
      {"rules as expressions", rewrite_rule},
      {"programs with arguments", rewrite_command},
      {"names", rewrite_names},
      {"actions of events", rewrite_action},
  };
  return all;
}

}  // namespace tools
