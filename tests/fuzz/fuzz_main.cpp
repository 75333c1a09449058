// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/fuzz_target.hpp"

// libFuzzer calls these.  SHOAL_FUZZ_TARGET names the target.

namespace {

fuzz::Target target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  spdlog::set_level(spdlog::level::off);
  const char* name = std::getenv("SHOAL_FUZZ_TARGET");
  const auto found = fuzz::targets().find(name != nullptr ? name : "");
  if (found == fuzz::targets().end()) {
    std::fprintf(stderr, "SHOAL_FUZZ_TARGET must be the name of a target:\n");
    for (const auto& [known, function] : fuzz::targets()) std::fprintf(stderr, "%s\n", known.c_str());
    std::exit(2);
  }
  target = found->second;
  return 0;
}

// ODE keeps its own few bytes when a fault of the physics is thrown through it; the run ends then.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libode.so\n";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
