// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/access_token.hpp"

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>

#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw WebError("the system provides no random numbers for the token of the page");
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

bool is_token_character(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
}

}  // namespace

AccessToken::AccessToken(std::string given) : text_(given.empty() ? random_token() : std::move(given)) {
  if (text_.size() < 16 || text_.size() > 128 || !std::all_of(text_.begin(), text_.end(), is_token_character))
    throw WebError("token of the page: must be 16 to 128 characters a-z, A-Z, 0-9, '-' or '_', got a text of " +
                   std::to_string(text_.size()) + " bytes");
}

bool AccessToken::matches(std::string_view text) const {
  return text.size() == text_.size() && CRYPTO_memcmp(text.data(), text_.data(), text_.size()) == 0;
}

}  // namespace bridges
