// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "shoal/array_lengths.hpp"
#include "shoal/message_schema.hpp"

namespace shoal {

template <class M>
std::int64_t fingerprint_of() {
  return M::getHash();
}

/// Returns the schema of a type of Shoal or of a plugin.
template <class M>
const MessageSchema& schema_of() {
  static const MessageSchema& schema = [&]() -> const MessageSchema& {
    // The generated class only has its name without the package; utime_t and others may share a fingerprint.
    const MessageSchema* found = embedded_types().find(M::getTypeName(), static_cast<std::uint64_t>(M::getHash()));
    if (found == nullptr) throw MessageError(std::string(M::getTypeName()) + " is none of Shoal's message types");
    return *found;
  }();
  return schema;
}

/// Encodes into `out`, whose memory is reused.  Throws MessageError when the size of an array differs from its length
/// member, because the generated code would read past its end.
template <class M>
void encode_into(const M& message, std::vector<std::byte>& out) {
  check_array_lengths(message);
  out.resize(static_cast<std::size_t>(message.getEncodedSize()));
  const int written = message.encode(out.data(), 0, static_cast<int>(out.size()));
  if (written < 0) throw MessageError(std::string("cannot encode ") + M::getTypeName());
  out.resize(static_cast<std::size_t>(written));  // a string with an embedded NUL ends there
}

template <class M>
std::vector<std::byte> encode(const M& message) {
  std::vector<std::byte> out;
  encode_into(message, out);
  return out;
}

/// Checks the payload and decodes it.  Throws MessageError with the reason.
template <class M>
M decode(std::span<const std::byte> payload, Finite finite) {
  if (const auto error = validate(schema_of<M>(), payload, finite)) throw MessageError(*error);
  if (payload.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw MessageError("payload is larger than 2 GB");
  M message{};
  if (message.decode(payload.data(), 0, static_cast<int>(payload.size())) < 0)
    throw MessageError(std::string("cannot decode ") + M::getTypeName());
  return message;
}

}  // namespace shoal
