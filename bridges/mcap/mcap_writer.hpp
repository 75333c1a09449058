// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bridges/base/file_writer.hpp"
#include "bridges/mcap/mcap_format.hpp"

namespace bridges::mcap {

/// Schema of messages.
struct Schema {
  std::string name, encoding, text;
};

/// Channel of messages.
struct Channel {
  std::uint16_t schema = 0;  ///< number of its schema; 0: none
  std::string topic, encoding;
  TextMap metadata;
};

/// Message of a channel.
struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0, publish_time_ns = 0;
  std::span<const std::byte> data;
};

/// File that an MCAP file contains.
struct Attachment {
  std::uint64_t log_time_ns = 0, create_time_ns = 0;
  std::string name, media_type;
  std::string data;
};

/// Named map of an MCAP file.
struct Metadata {
  std::string name;
  TextMap entries;
};

/// Writer of an MCAP file: messages in chunks compressed by zstd, with indexes, statistics and checksums.  Its bytes
/// depend only on the calls.  Every function that writes returns false after a failed write; errno has the reason.
class McapWriter {
 public:
  /// A chunk ends when its content has this size, or covers this time.
  static constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
  static constexpr std::uint64_t chunk_ns = 5'000'000'000;

  explicit McapWriter(FileDescriptor file, const std::string& profile = "ros2", const std::string& library = "shoal");
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Adds a schema, and returns its number; the one that exists, when an equal one was added before.  0: there are
  /// 65535 of them already.
  std::uint16_t add_schema(const Schema& schema);
  /// Adds a channel, and returns its number; 0: there are 65535 of them already.
  std::uint16_t add_channel(Channel channel);
  /// Adds all schemas and channels of another file, with equal numbers.  Only for a new file.
  void add_all_of(const McapWriter& other);

  /// Writes a message with the next sequence number of its channel.
  bool write(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::byte> data);
  bool write(const Attachment& attachment);
  bool write(const Metadata& metadata);
  /// Ends the chunk, and waits until everything is in the file.
  bool flush();
  /// Completes the file; nothing may be written afterwards.
  bool finish();

  std::uint64_t messages() const { return messages_; }
  /// Returns the messages of each channel, by its number less one.
  const std::vector<std::uint64_t>& counts() const { return counts_; }
  const std::vector<Channel>& channels() const { return channels_; }
  const std::vector<Schema>& schemas() const { return schemas_; }
  /// Returns the size of the file, without the chunk that is open.
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct Span {
    std::uint64_t first_ns = 0, last_ns = 0;
    void add(std::uint64_t time_ns, bool first);
  };
  struct ChunkIndex {
    Span time;
    std::uint64_t offset = 0, length = 0, raw_bytes = 0, compressed_bytes = 0, index_bytes = 0;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> index_offsets;
  };
  struct FileIndex {
    Opcode opcode;  ///< attachment_index or metadata_index
    std::vector<std::byte> content;
  };
  using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

  void add_definitions(std::uint16_t channel);
  bool end_chunk();
  void compress_chunk();
  bool put_chunk();
  void put_message_indexes(RecordBuilder& out, ChunkIndex& index);
  void put_summary(RecordBuilder& out);
  void put_chunk_indexes(RecordBuilder& out) const;
  void put_statistics(RecordBuilder& out) const;
  void put_schema(RecordBuilder& out, std::size_t number) const;
  void put_channel(RecordBuilder& out, std::size_t number) const;
  /// Adds the bytes in out_ to the file.
  bool put_out();

  FileWriter file_;
  std::vector<std::byte> out_;  // to be written
  std::uint64_t bytes_ = 0;
  std::uint32_t crc_ = 0;  // of the data section
  bool failed_ = false, finished_ = false;

  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::vector<bool> schema_written_, channel_written_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t messages_ = 0;
  Span time_;

  std::vector<std::byte> chunk_, compressed_;
  Span chunk_time_;
  std::size_t chunk_messages_ = 0;
  std::vector<MessageIndex> message_index_;  // by channel, of the open chunk
  std::vector<ChunkIndex> chunk_index_;
  std::vector<FileIndex> file_index_;
};

}  // namespace bridges::mcap
