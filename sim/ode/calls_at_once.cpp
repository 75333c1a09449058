// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/calls_at_once.hpp"

#include <deque>
#include <vector>

namespace sim {

namespace {

/// A posted call.  It is made when all calls that it depends on have returned.
struct Call {
  ddependencycount_t waits_for;
  Call* dependent;  // waits for this one
  int* fault_out;
  bool* done;  // of the wait
  dThreadedCallFunction* function;
  void* context;
  dcallindex_t index;
  bool failed;
};

/// Calls of one thread.  A step of ODE leaves none behind, unless it throws.
struct Calls {
  std::deque<Call> all;  // addresses are stable
  std::vector<Call*> unused, ready;
};

thread_local Calls calls;

Call* of(dCallReleaseeID releasee) {
  return reinterpret_cast<Call*>(releasee);
}

bool* of(dCallWaitID wait) {
  return reinterpret_cast<bool*>(wait);
}

void post(dThreadingImplementationID, int* fault_out, dCallReleaseeID* posted_out, ddependencycount_t waits_for,
          dCallReleaseeID dependent, dCallWaitID wait, dThreadedCallFunction* function, void* context,
          dcallindex_t index, const char*) {
  if (calls.unused.empty()) calls.unused.push_back(&calls.all.emplace_back());
  Call* const call = calls.unused.back();
  calls.unused.pop_back();
  *call = {waits_for, of(dependent), fault_out, of(wait), function, context, index, false};
  if (waits_for == 0) calls.ready.push_back(call);
  if (posted_out != nullptr) *posted_out = reinterpret_cast<dCallReleaseeID>(call);
}

void change_dependencies(dThreadingImplementationID, dCallReleaseeID releasee, ddependencychange_t change) {
  Call* const call = of(releasee);
  call->waits_for += static_cast<ddependencycount_t>(change);
  if (call->waits_for == 0) calls.ready.push_back(call);
}

/// Ends a call that has returned, and all calls on which nothing is left to wait for.
void finish(Call* call) {
  while (call != nullptr) {
    if (call->fault_out != nullptr) *call->fault_out = call->failed;
    if (call->done != nullptr) *call->done = true;
    Call* const dependent = call->dependent;
    const bool failed = call->failed;
    calls.unused.push_back(call);
    if (dependent == nullptr) return;
    dependent->failed |= failed;
    if (--dependent->waits_for > 0) return;
    // A call that was made already and waits only for calls posted by it has returned now.
    if (dependent->function != nullptr) {
      calls.ready.push_back(dependent);
      return;
    }
    call = dependent;
  }
}

void wait_for(dThreadingImplementationID, int* status_out, dCallWaitID wait, const dThreadedWaitTime*, const char*) {
  try {
    while (!*of(wait) && !calls.ready.empty()) {
      Call* const call = calls.ready.back();
      calls.ready.pop_back();
      call->waits_for = 1;  // for itself
      dThreadedCallFunction* const function = call->function;
      call->function = nullptr;
      if (function(call->context, call->index, reinterpret_cast<dCallReleaseeID>(call)) == 0) call->failed = true;
      if (--call->waits_for == 0) finish(call);
    }
  } catch (...) {  // an error of ODE; its world is not used again
    calls = {};
    throw;
  }
  if (status_out != nullptr) *status_out = 1;
}

dCallWaitID allocate_wait(dThreadingImplementationID) {
  return reinterpret_cast<dCallWaitID>(new bool(false));
}
void reset_wait(dThreadingImplementationID, dCallWaitID wait) {
  *of(wait) = false;
}
void free_wait(dThreadingImplementationID, dCallWaitID wait) {
  delete of(wait);
}

// Nothing is locked, since one thread makes all calls.
dMutexGroupID allocate_locks(dThreadingImplementationID, dmutexindex_t, const char* const*) {
  static char any;
  return reinterpret_cast<dMutexGroupID>(&any);
}
void free_locks(dThreadingImplementationID, dMutexGroupID) {}
void lock(dThreadingImplementationID, dMutexGroupID, dmutexindex_t) {}

unsigned threads(dThreadingImplementationID) {
  return 1;
}
int prepare(dThreadingImplementationID, ddependencycount_t) {
  return 1;
}

constexpr dThreadingFunctionsInfo functions = {
    .struct_size = sizeof(dThreadingFunctionsInfo),
    .alloc_mutex_group = allocate_locks,
    .free_mutex_group = free_locks,
    .lock_group_mutex = lock,
    .unlock_group_mutex = lock,
    .alloc_call_wait = allocate_wait,
    .reset_call_wait = reset_wait,
    .free_call_wait = free_wait,
    .post_call = post,
    .alter_call_dependencies_count = change_dependencies,
    .wait_call = wait_for,
    .retrieve_thread_count = threads,
    .preallocate_resources_for_calls = prepare,
};

}  // namespace

void make_calls_at_once(dWorldID world) {
  // ODE wants an implementation with the functions, and only hands it back to them.
  static char any;
  dWorldSetStepThreadingImplementation(world, &functions, reinterpret_cast<dThreadingImplementationID>(&any));
}

SolverMemory::SolverMemory() : owner_(dWorldCreate()) {
  make_calls_at_once(owner_);
  dWorldStep(owner_, 1);  // makes its locks, so that they belong to no world that is lent them
}

SolverMemory::~SolverMemory() {
  dWorldDestroy(owner_);
}

}  // namespace sim
