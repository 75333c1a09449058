// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/time.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/script/path.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Behavior of an actor at the end of its path.
enum class PathEnds { loop, reverse, stop };

enum class ActorCommand {
  start,    ///< continue in the previous direction
  stop,     ///< stop moving
  forward,  ///< towards the end of the path
  back,     ///< towards the start of the path
};

inline constexpr ChoiceWords<ActorCommand> actor_command_words{{"start", ActorCommand::start},
                                                               {"stop", ActorCommand::stop},
                                                               {"forward", ActorCommand::forward},
                                                               {"back", ActorCommand::back}};

enum class ActorStart {
  moving,
  waiting,  ///< waits for the command of an event
};

/// Configuration of an actor, which moves an object along a path.  The object becomes kinematic: it exerts contact
/// forces, and its motion is not affected by them.
struct ActorConfig {
  std::string name;
  std::string object;
  PathKind path = PathKind::waypoints;
  std::vector<Vector3d> points_m;  ///< waypoints, spline
  std::vector<TimedPose> poses;    ///< timed
  std::optional<Vector3d> rpy_rad;
  double speed_mps = 1;
  PathEnds ends = PathEnds::loop;
  double start_s = 0;
  ActorStart starts = ActorStart::moving;
  SourcePlace place;

  void read(ParamReader& in);
  Path make_path() const;

 private:
  void check_points(ParamReader& in);
};

}  // namespace sim
