// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/mcap/mcap_writer.hpp"

namespace bridges::mcap {

/// Reader of an MCAP file in the order of its records, without its summary; also of a file that is cut off or damaged:
/// lengths are bounded by the file and by max_record_bytes, and messages before the damage are read.
class McapReader {
 public:
  /// Result of next().
  enum class Item { message, attachment, metadata, end };

  /// Throws BusError when the file cannot be opened, is not a regular file, or is not an MCAP file.
  explicit McapReader(const std::string& path);

  /// Reads the next message, attachment or metadata.
  Item next();
  /// Returns what was read; valid until the next call of next().
  const Message& message() const { return message_; }
  const Attachment& attachment() const { return attachment_; }
  const Metadata& metadata() const { return metadata_; }
  /// Returns the channel of a message that was read.
  const Channel& channel(std::uint16_t number) const { return channels_.at(number); }
  /// Returns the schemas and channels read so far, by number.
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  const std::string& profile() const { return profile_; }
  /// Returns whether the file was read to its end, and is complete.
  bool complete() const { return complete_; }
  /// Returns the problems found so far, such as `byte 4711: the file is cut off`.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void report(const std::string& what);
  bool read_at(std::uint64_t offset, std::size_t size, std::vector<std::byte>& to) const;
  /// Reads the next record of the file; returns false at the end of the data.
  bool read_record(Item& item);
  void open_chunk(std::span<const std::byte> content, bool cut);
  bool inflate(std::span<const std::byte> data, std::uint64_t size);
  /// Reads the next record of the chunk; returns false at its end.
  bool read_in_chunk(Item& item);
  /// Uses the content of a record, in a chunk or outside; returns true when `item` was read.
  bool use(Opcode opcode, std::span<const std::byte> content, Item& item);
  /// Counts the bytes of a schema or channel that replaces another one of `before`; ends the reading, and returns
  /// false, when all of them have more than max_kept_bytes.
  bool keep(std::size_t bytes, std::size_t before);
  void use_schema(RecordParser& in);
  void use_channel(RecordParser& in);
  bool use_message(RecordParser& in);
  bool use_attachment(std::span<const std::byte> content);
  void end_data(RecordParser& in);

  FileDescriptor file_;
  std::uint64_t file_bytes_ = 0, at_ = 0;
  std::uint64_t record_at_ = 0;  // of the present record of the file, for problems
  std::uint32_t crc_ = 0;        // of the file before the present record
  bool ended_ = false, complete_ = false;
  std::string profile_;
  std::vector<std::byte> record_, chunk_;
  std::size_t chunk_at_ = 0, kept_bytes_ = 0;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  Message message_;
  Attachment attachment_;
  Metadata metadata_;
  std::vector<std::string> problems_;
};

}  // namespace bridges::mcap
