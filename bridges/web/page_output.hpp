// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace bridges {

/// Receiver of what a page shows (docs/develop/view_protocol.md): the server of the live page, or a file.
class PageOutput {
 public:
  virtual ~PageOutput() = default;

  /// Returns the number of pages that receive states; callers skip all work when it is 0.
  virtual int clients() const = 0;
  /// Takes a binary state frame.
  virtual void send_state(std::span<const std::byte> state) = 0;
  /// Takes a JSON text of something that happens.
  virtual void send_text(std::string json) = 0;
  /// Takes a JSON text that holds from now on, in place of the previous one of this `op`.
  virtual void retain(std::string_view op, std::string json) = 0;
  /// Takes the bytes of an asset.
  virtual void set_asset(std::uint64_t hash, std::span<const std::byte> bytes) = 0;

 protected:
  PageOutput() = default;
  PageOutput(const PageOutput&) = default;
  PageOutput& operator=(const PageOutput&) = default;
};

}  // namespace bridges
