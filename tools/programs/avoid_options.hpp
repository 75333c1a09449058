// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "autonomy/behaviors/avoid_behavior.hpp"
#include "tools/command_line/declared_options.hpp"

namespace autonomy {

/// Options of avoidance.  Their defaults are the values before declare().
struct AvoidOptions {
  std::string law = "none";
  AvoidanceParams params;
  ObstacleTracks::Params tracks;

  void declare(command_line::DeclaredOptions& options);
  /// Returns std::nullopt when the vehicle does not avoid obstacles.
  std::optional<Avoidance> make() const;
  /// Returns the behavior, which avoids obstacles if that was chosen.
  std::unique_ptr<HelmBehavior> around(std::unique_ptr<HelmBehavior> behavior) const;
};

}  // namespace autonomy
