// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>

#include "all_message_types.hpp"  // made by CMake: every type in messages
#include "bridges/base/bus_error.hpp"
#include "bridges/mcap/mcap_reader.hpp"
#include "bridges/mcap/mcap_record.hpp"
#include "shoal/message_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/memory_file.hpp"

// MCAP files: any bytes, records behind the magic, records in a chunk; and files that McapRecord writes of any
// messages.

namespace {

using bridges::mcap::McapReader;

std::uint64_t read_mcap(const std::string& path) {
  McapReader reader(path);
  std::uint64_t messages = 0;
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;) {
    if (item != McapReader::Item::message) continue;
    ++messages;
    reader.channel(reader.message().channel);  // throws without a channel
  }
  return messages;
}

/// A file with the input as its records, or as the content of an uncompressed chunk.
std::vector<std::byte> mcap_file(fuzz::Input records, bool in_chunk) {
  std::vector<std::byte> file;
  bridges::mcap::RecordBuilder out(file);
  out.bytes(std::as_bytes(std::span(bridges::mcap::magic)));
  if (in_chunk) {
    out.begin(bridges::mcap::Opcode::chunk);
    for (int i = 0; i < 2; ++i) out.number(std::uint64_t{0});
    out.number(static_cast<std::uint64_t>(records.size()));
    out.number(std::uint32_t{0});
    out.text("");
    out.number(static_cast<std::uint64_t>(records.size()));
  }
  out.bytes(records);
  if (in_chunk) out.end();
  return file;
}

/// Writes messages of any types on a few channels, and reads the file.
void write_and_read(fuzz::Reader& input) {
#define SHOAL_FINGERPRINT(name) shoal::fingerprint_of<shoal::name>(),
  static const std::vector<std::int64_t> fingerprints{SHOAL_ALL_MESSAGE_TYPES(SHOAL_FINGERPRINT) 1};
  const fuzz::MemoryFile file({});
  bridges::mcap::McapRecord record(bridges::FileDescriptor(open(file.path().c_str(), O_RDWR)));
  while (!input.ended()) {
    const std::string channel =
        input.below(4) == 0 ? "sim.info" : "a." + std::string(1, static_cast<char>(input.byte()));
    const auto fingerprint = static_cast<std::uint64_t>(fingerprints[input.below(fingerprints.size())]);
    std::vector<std::byte> payload(8);
    for (int i = 0; i < 8; ++i)
      payload[static_cast<std::size_t>(i)] = static_cast<std::byte>(fingerprint >> (56 - 8 * i));
    const fuzz::Input rest = input.bytes(input.byte());
    payload.insert(payload.end(), rest.begin(), rest.end());
    fuzz::require(record.write(input.number<std::int64_t>(), channel, payload), "a message is written");
  }
  fuzz::require(record.finish(), "a file is completed");
  McapReader reader(file.path());
  std::uint64_t messages = 0;
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;)
    messages += item == McapReader::Item::message;
  fuzz::require(reader.complete() && reader.problems().empty(), "a file that was written is without problems");
  fuzz::require(messages == record.file().messages(), "every message that was written is read");
}

}  // namespace

SHOAL_FUZZ_TARGET(mcap) {
  fuzz::Reader reader(input);
  const std::size_t kind = reader.below(4);
  if (kind == 3) return write_and_read(reader);
  const fuzz::Input rest = reader.rest();
  const std::vector<std::byte> built = mcap_file(rest, kind == 2);
  const fuzz::MemoryFile file(kind == 0 ? rest : fuzz::Input(built));
  fuzz::allow<bridges::BusError>([&] { read_mcap(file.path()); });
}
