// SPDX-License-Identifier: BSD-3-Clause
// QuickStep shuffles the rows of an island with ODE's random numbers, whose seed is global to the process.  libode
// calls these functions through its symbol table, so that the definitions here replace them: the same numbers, with a
// seed per thread, and from the seed on in each shuffle.  The rows of an island are then in the same order whatever
// other islands a step has.
#include <ode/ode.h>

namespace {
thread_local unsigned long seed = 0, state = 0;
}

extern "C" {

unsigned long dRand() {
  state = (1664525UL * state + 1013904223UL) & 0xffffffffUL;
  return state;
}

unsigned long dRandGetSeed() {
  return state;
}

void dRandSetSeed(unsigned long new_seed) {
  seed = state = new_seed & 0xffffffffUL;
}

int dRandInt(int n) {
  if (n == 2) state = seed;  // a shuffle begins with its second row
  // The high bits of the product: the low bits of this generator have short periods.
  return n > 1 ? static_cast<int>((static_cast<unsigned long long>(dRand()) * static_cast<unsigned>(n)) >> 32) : 0;
}

}  // extern "C"
