// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace fuzz {

using Input = std::span<const std::byte>;

/// Gives any bytes to one parser.  What the parser promises to throw is caught in the target; everything else that
/// leaves it is a fault: another exception, a signal, a report of a sanitizer, too much time or memory.
using Target = void (*)(Input input);

/// Those that are linked into this program, by name: one for libFuzzer, all for the tests.
std::map<std::string, Target, std::less<>>& targets();

struct Registration {
  Registration(const char* name, Target target) { targets().emplace(name, target); }
};

inline std::string_view text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// Runs `work`, which may throw one of these and nothing else.
template <typename... Errors, typename Work>
void allow(const Work& work) {
  struct Catch {
    static bool is_one(const std::exception& error) {
      return (... || (dynamic_cast<const Errors*>(&error) != nullptr));
    }
  };
  try {
    work();
  } catch (const std::exception& error) {
    if (!Catch::is_one(error)) throw;
  }
}

/// Ends the program with a message: the parser broke a promise.
void require(bool holds, const char* promise);

}  // namespace fuzz

/// Defines and registers the target of this name; `input` is what the body works on.
#define SHOAL_FUZZ_TARGET(name)                                            \
  static void fuzz_##name(fuzz::Input input);                              \
  static const fuzz::Registration registration_##name(#name, fuzz_##name); \
  static void fuzz_##name(fuzz::Input input)
