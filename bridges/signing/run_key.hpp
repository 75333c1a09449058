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

/// Environment variable in which programs get the key of the run that started them.
inline constexpr const char* run_key_variable = "SHOAL_RUN_KEY";
/// Name of the file in the folder of a run.
inline constexpr const char* run_key_file = "run.key";

/// HMAC-SHA-256.
using Mac = std::array<std::uint8_t, 32>;

/// The secret of one run: who has it may control the run.  Never published, recorded or logged.
class RunKey {
 public:
  static constexpr std::size_t size = 32;

  /// From the random generator of the system.  Throws BusError when there is none.
  static RunKey random();
  /// From 64 hexadecimal digits; white space around them is ignored.  Throws BusError that names `where`, and never
  /// the text.
  static RunKey from_text(std::string_view text, const std::string& where);
  /// 64 hexadecimal digits.
  std::string text() const;

  /// Authenticates a message on a channel: over the channel's name, a zero byte, and `bytes`.
  Mac mac(std::string_view channel, std::span<const std::byte> bytes) const;
  bool operator==(const RunKey&) const = default;

 private:
  std::array<std::uint8_t, size> bytes_{};
};

/// True when both are equal; takes as long when they differ.
bool equal_in_constant_time(const Mac& a, const Mac& b);

/// The key in SHOAL_RUN_KEY; nothing when it is unset or empty.  Throws BusError when it is not a key.
std::optional<RunKey> run_key_from_environment();
/// The key in `folder`/run.key.  Throws BusError with path and reason.
RunKey read_run_key(const std::string& folder);

}  // namespace bridges
