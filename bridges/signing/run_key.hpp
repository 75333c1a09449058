// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bridges {

/// Environment variable with the key of the run, for programs started by it.
inline constexpr const char* run_key_variable = "SHOAL_RUN_KEY";
/// Name of the key file in the folder of a run.
inline constexpr const char* run_key_file = "run.key";

/// Message authentication code, HMAC-SHA-256 (RFC 2104).
using Mac = std::array<std::uint8_t, 32>;

/// Secret key of one run, required to control it.  Never published, recorded or logged.
class RunKey {
 public:
  static constexpr std::size_t size = 32;

  /// Makes a key from the random generator of the system.  Throws BusError when there is none.
  static RunKey random();
  /// Parses 64 hexadecimal digits; white space around them is ignored.  Throws BusError with `where`, never with the
  /// text.
  static RunKey from_text(std::string_view text, const std::string& where);
  /// Returns 64 hexadecimal digits.
  std::string text() const;

  /// Returns the code of a message on a channel, over the channel name, a zero byte, and `bytes`.
  Mac mac(std::string_view channel, std::span<const std::byte> bytes) const;
  bool operator==(const RunKey&) const = default;

 private:
  std::array<std::uint8_t, size> bytes_{};
};

/// Compares two codes in a time that does not depend on their values.
bool equal_in_constant_time(const Mac& a, const Mac& b);

/// Returns the key in SHOAL_RUN_KEY; none when it is unset or empty.  Throws BusError when it is not a key.
std::optional<RunKey> run_key_from_environment();
/// Returns the key in `folder`/run.key.  Throws BusError with path and reason.
RunKey read_run_key(const std::string& folder);

}  // namespace bridges
