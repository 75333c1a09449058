// SPDX-License-Identifier: BSD-3-Clause
// QuickStep shuffles its rows with ODE's random numbers, whose seed is global to the process.  libode calls these
// functions through its symbol table, so that the definitions here replace them: the same numbers, with a seed per
// thread.
#include <ode/ode.h>

namespace {
thread_local unsigned long seed = 0;
}

extern "C" {

unsigned long dRand() {
  seed = (1664525UL * seed + 1013904223UL) & 0xffffffffUL;
  return seed;
}

unsigned long dRandGetSeed() {
  return seed;
}

void dRandSetSeed(unsigned long new_seed) {
  seed = new_seed & 0xffffffffUL;
}

int dRandInt(int n) {
  // The high bits of the product: the low bits of this generator have short periods.
  return n > 1 ? static_cast<int>((static_cast<unsigned long long>(dRand()) * static_cast<unsigned>(n)) >> 32) : 0;
}

}  // extern "C"
