// SPDX-License-Identifier: BSD-3-Clause
#include "all_message_types.hpp"  // made by CMake: every type in messages
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Payloads of every message type: first byte the type, second whether numbers must be finite.

namespace {

using shoal::Finite;

template <typename Message>
void decode_twice(const std::vector<std::byte>& payload, Finite finite) {
  fuzz::allow<shoal::MessageError>([&] {
    const Message message = shoal::decode<Message>(payload, finite);
    const std::vector<std::byte> again = shoal::encode(message);
    shoal::decode<Message>(again, finite);
    fuzz::require(again.size() <= payload.size(), "a message that was decoded is encoded in no more bytes");
  });
}

struct Type {
  std::int64_t fingerprint;
  const shoal::MessageSchema* schema;
  void (*decode)(const std::vector<std::byte>& payload, Finite finite);
};

template <typename Message>
Type type_of() {
  return {shoal::fingerprint_of<Message>(), &shoal::schema_of<Message>(), decode_twice<Message>};
}

}  // namespace

SHOAL_FUZZ_TARGET(message) {
#define SHOAL_TYPE(name) type_of<shoal::name>(),
  static const std::vector<Type> types{SHOAL_ALL_MESSAGE_TYPES(SHOAL_TYPE)};
  fuzz::Reader reader(input);
  const Type& type = types[reader.below(types.size())];
  const Finite finite = reader.below(2) == 0 ? Finite::any : Finite::required;
  // The fingerprint is public; guessing it would be a waste of time.
  std::vector<std::byte> payload(8);
  for (int i = 0; i < 8; ++i)
    payload[static_cast<std::size_t>(i)] = static_cast<std::byte>(type.fingerprint >> (56 - 8 * i));
  const fuzz::Input rest = reader.rest();
  payload.insert(payload.end(), rest.begin(), rest.end());
  shoal::visit_fields(*type.schema, payload, [](std::string_view, const shoal::FieldValue&) {});
  type.decode(payload, finite);
}
