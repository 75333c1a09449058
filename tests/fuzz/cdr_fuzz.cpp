// SPDX-License-Identifier: BSD-3-Clause
#include "all_message_types.hpp"  // made by CMake: every type in messages
#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Payloads of every message type, transcoded into CDR and back, and by all converters of the type: first byte the type,
// second the channel.

namespace {

const std::vector<const shoal::MessageSchema*>& cdr_schemas() {
#define SHOAL_SCHEMA(name) &shoal::schema_of<shoal::name>(),
  static const std::vector<const shoal::MessageSchema*> schemas{SHOAL_ALL_MESSAGE_TYPES(SHOAL_SCHEMA)};
  return schemas;
}

}  // namespace

SHOAL_FUZZ_TARGET(cdr) {
  fuzz::Reader reader(input);
  const shoal::MessageSchema& schema = *cdr_schemas()[reader.below(cdr_schemas().size())];
  const char* channel = reader.below(2) == 0 ? "sim.clock" : "auv1.device";
  // The fingerprint is public; guessing it would be a waste of time.
  std::vector<std::byte> payload(8);
  for (int i = 0; i < 8; ++i)
    payload[static_cast<std::size_t>(i)] = static_cast<std::byte>(schema.fingerprint >> (56 - 8 * i));
  const fuzz::Input rest = reader.rest();
  payload.insert(payload.end(), rest.begin(), rest.end());
  static std::vector<std::byte> cdr, back;
  if (!bridges::ros2::from_cdr(schema, rest, back))
    fuzz::require(!shoal::validate(schema, back, shoal::Finite::any), "what CDR becomes is valid");
  const auto error = bridges::ros2::to_cdr(schema, payload, cdr);
  fuzz::require(error == shoal::validate(schema, payload, shoal::Finite::any), "valid payloads are transcoded");
  if (error) return;
  // An element grows at most from 1 byte to 8 with padding; a type without members becomes a byte.
  fuzz::require(cdr.size() <= 8 * payload.size() + 65536, "the size of CDR is bounded by that of the payload");
  fuzz::require(!bridges::ros2::from_cdr(schema, cdr, back) && back.size() == payload.size(), "CDR can be read back");
  bridges::ros2::ConverterContext context;
  context.body_frames = {{0, "a/body/base"}, {1, "b"}};
  context.scene_revision = 0;
  for (const bridges::ros2::Converter* converter : bridges::ros2::ConverterTable::instance().of(schema.name))
    fuzz::allow<shoal::MessageError>([&] { converter->convert(payload, channel, context, cdr); });
}
