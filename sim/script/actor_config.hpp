// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/time.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/script/path.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// What an actor does at the end of its path.
enum class PathEnds { loop, bounce, stop };

enum class ActorCommand {
  start,    ///< continue in the direction it had
  stop,     ///< stand
  forward,  ///< towards the end of the path
  back,     ///< towards its beginning
};

inline constexpr ChoiceWords<ActorCommand> actor_command_words{{"start", ActorCommand::start},
                                                               {"stop", ActorCommand::stop},
                                                               {"forward", ActorCommand::forward},
                                                               {"back", ActorCommand::back}};

enum class ActorStart {
  moving,
  waiting,  ///< for the command of an event
};

/// Moves an object along a path.  The object becomes kinematic: it pushes others, and is not pushed.
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
