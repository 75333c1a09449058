// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

// Loops over many rays are compiled twice on x86: for every processor, and for those with AVX2.  The results have equal
// bits, because AVX2 alone has no fused multiply-add.  On other processors both are the same.
#if defined(__x86_64__)
#define SHOAL_AVX2 [[gnu::target("avx2")]]
inline bool has_avx2() {
  return __builtin_cpu_supports("avx2");
}
#else
#define SHOAL_AVX2
inline bool has_avx2() {
  return false;
}
#endif

}  // namespace sim
