// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace bridges {

/// Secret in the address of the page.  Whoever has it may steer; without it a page only shows.
class AccessToken {
 public:
  /// Takes a given token of 16 to 128 characters a-z, A-Z, 0-9, `-` and `_`; an empty one: 128 random bits of the
  /// system, as 32 hexadecimal digits.  Throws WebError.
  explicit AccessToken(std::string given);
  const std::string& text() const { return text_; }
  /// Returns true for an equal text.  Its time does not depend on where texts differ.
  bool matches(std::string_view text) const;

 private:
  std::string text_;
};

}  // namespace bridges
