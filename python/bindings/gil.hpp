// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Python.h>

namespace python {

/// Releases the GIL while it lives.  When the interpreter ends meanwhile, a thread of a daemon stays in the destructor:
/// it may neither return to Python nor be ended by Python, whose pthread_exit() C++ code does not survive.
class WithoutGil {
 public:
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// Holds the GIL, which the thread has released by WithoutGil, during its lifetime.
class WithGil {
 public:
  WithGil();
  ~WithGil();
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Returns whether the interpreter is about to end, so that work without the GIL has to end too.
bool interpreter_ends();
/// Called by Python before it ends: makes interpreter_ends() true, calls `stop`, and waits up to two seconds until no
/// thread works without the GIL.  Does nothing in a forked process, which has none of the threads.
void end_interpreter(void (*stop)());

}  // namespace python
