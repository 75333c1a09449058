// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

namespace sim {

/// Makes the calls that ODE's solver posts in the thread that steps the world, one after the other.  ODE's default does
/// the same, but shares its list of calls between all worlds of the process; here worlds in several threads have
/// nothing in common.
void make_calls_at_once(dWorldID world);

/// Working memory and locks of ODE's solver, lent to one world at a time.  A world that is stepped must have it, and no
/// world that has it may be stepped by another thread.
class SolverMemory {
 public:
  SolverMemory();
  ~SolverMemory();
  SolverMemory(const SolverMemory&) = delete;
  SolverMemory& operator=(const SolverMemory&) = delete;
  void lend_to(dWorldID world) { dWorldUseSharedWorkingMemory(world, owner_); }
  void take_back_from(dWorldID world) { dWorldUseSharedWorkingMemory(world, nullptr); }

 private:
  dWorldID owner_;  // an empty world
};

}  // namespace sim
