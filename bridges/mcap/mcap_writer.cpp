// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <functional>

namespace bridges::mcap {
namespace {

constexpr int zstd_level = 1;
constexpr std::size_t max_numbers = 65535;

std::uint32_t crc_of(std::uint32_t crc, std::span<const std::byte> data) {
  while (!data.empty()) {
    const std::size_t part = std::min<std::size_t>(data.size(), std::size_t{1} << 30);
    crc = static_cast<std::uint32_t>(crc32(crc, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(part)));
    data = data.subspan(part);
  }
  return crc;
}

}  // namespace

void McapWriter::Span::add(std::uint64_t time_ns, bool first) {
  first_ns = first ? time_ns : std::min(first_ns, time_ns);
  last_ns = first ? time_ns : std::max(last_ns, time_ns);
}

McapWriter::McapWriter(FileDescriptor file, const std::string& profile, const std::string& library)
    : file_(std::move(file)) {
  RecordBuilder out(out_);
  out.bytes(std::as_bytes(std::span(magic)));
  out.begin(Opcode::header);
  out.text(profile);
  out.text(library);
  out.end();
  put_out();
}

McapWriter::~McapWriter() {
  finish();
}

std::uint16_t McapWriter::add_schema(const Schema& schema) {
  const auto equal = [&](const Schema& other) { return other.name == schema.name && other.text == schema.text; };
  const auto at = std::find_if(schemas_.begin(), schemas_.end(), equal);
  if (at == schemas_.end()) {
    if (schemas_.size() == max_numbers) return 0;
    schemas_.push_back(schema);
    schema_written_.push_back(false);
    return static_cast<std::uint16_t>(schemas_.size());
  }
  return static_cast<std::uint16_t>(at - schemas_.begin() + 1);
}

std::uint16_t McapWriter::add_channel(Channel channel) {
  if (channels_.size() == max_numbers) return 0;
  channels_.push_back(std::move(channel));
  channel_written_.push_back(false);
  counts_.push_back(0);
  message_index_.emplace_back();
  return static_cast<std::uint16_t>(channels_.size());
}

void McapWriter::add_all_of(const McapWriter& other) {
  assert(schemas_.empty() && channels_.empty());
  for (const Schema& schema : other.schemas_) add_schema(schema);
  for (const Channel& channel : other.channels_) add_channel(channel);
}

void McapWriter::put_schema(RecordBuilder& out, std::size_t number) const {
  const Schema& schema = schemas_[number - 1];
  out.begin(Opcode::schema);
  out.number(static_cast<std::uint16_t>(number));
  out.text(schema.name);
  out.text(schema.encoding);
  out.text(schema.text);
  out.end();
}

void McapWriter::put_channel(RecordBuilder& out, std::size_t number) const {
  const Channel& channel = channels_[number - 1];
  out.begin(Opcode::channel);
  out.number(static_cast<std::uint16_t>(number));
  out.number(channel.schema);
  out.text(channel.topic);
  out.text(channel.encoding);
  out.map(channel.metadata);
  out.end();
}

void McapWriter::add_definitions(std::uint16_t channel) {
  if (channel_written_[channel - 1u]) return;
  channel_written_[channel - 1u] = true;
  RecordBuilder out(chunk_);
  const std::uint16_t schema = channels_[channel - 1u].schema;
  if (schema != 0 && !schema_written_[schema - 1u]) {
    schema_written_[schema - 1u] = true;
    put_schema(out, schema);
  }
  put_channel(out, channel);
}

bool McapWriter::write(std::uint16_t channel, std::uint64_t log_time_ns, std::span<const std::byte> data) {
  assert(channel > 0 && channel <= channels_.size() && !finished_);
  // End a chunk that would become too large or too long.
  const std::size_t size = record_head_bytes + message_head_bytes + data.size();
  const bool full = chunk_.size() + size > chunk_bytes || log_time_ns >= chunk_time_.first_ns + chunk_ns;
  if (chunk_messages_ > 0 && full && !end_chunk()) return false;
  // Append the message and its index.
  add_definitions(channel);
  RecordBuilder out(chunk_);
  message_index_[channel - 1u].emplace_back(log_time_ns, chunk_.size());
  out.begin(Opcode::message);
  out.number(channel);
  out.number(static_cast<std::uint32_t>(counts_[channel - 1u]));
  out.number(log_time_ns);
  out.number(log_time_ns);
  out.bytes(data);
  out.end();
  // Count it.
  time_.add(log_time_ns, messages_ == 0);
  chunk_time_.add(log_time_ns, chunk_messages_ == 0);
  ++counts_[channel - 1u];
  ++messages_;
  ++chunk_messages_;
  return !failed_;
}

bool McapWriter::end_chunk() {
  if (chunk_messages_ == 0) return !failed_;
  compress_chunk();
  const bool done = put_chunk();
  chunk_.clear();
  chunk_messages_ = 0;
  for (MessageIndex& index : message_index_) index.clear();
  return done;
}

void McapWriter::compress_chunk() {
  compressed_.resize(ZSTD_compressBound(chunk_.size()));
  const std::size_t size =
      ZSTD_compress(compressed_.data(), compressed_.size(), chunk_.data(), chunk_.size(), zstd_level);
  failed_ = failed_ || ZSTD_isError(size) != 0;
  if (failed_) errno = ENOMEM;  // the only error with a sufficient buffer
  compressed_.resize(failed_ ? 0 : size);
}

bool McapWriter::put_chunk() {
  if (failed_) return false;
  ChunkIndex index;
  index.time = chunk_time_;
  index.offset = bytes_;
  index.raw_bytes = chunk_.size();
  index.compressed_bytes = compressed_.size();
  RecordBuilder out(out_);
  out.begin(Opcode::chunk);
  out.number(index.time.first_ns);
  out.number(index.time.last_ns);
  out.number(index.raw_bytes);
  // The CRC is that of the uncompressed records (MCAP specification, Chunk), so that it also covers the
  // decompression.
  out.number(crc_of(0, chunk_));
  out.text("zstd");
  out.number(index.compressed_bytes);
  out.bytes(compressed_);
  out.end();
  index.length = out_.size();
  put_message_indexes(out, index);
  chunk_index_.push_back(std::move(index));
  return put_out();
}

void McapWriter::put_message_indexes(RecordBuilder& out, ChunkIndex& index) {
  for (std::size_t channel = 1; channel <= message_index_.size(); ++channel) {
    const MessageIndex& messages = message_index_[channel - 1];
    if (messages.empty()) continue;
    index.index_offsets.emplace_back(static_cast<std::uint16_t>(channel), bytes_ + out_.size());
    out.begin(Opcode::message_index);
    out.number(static_cast<std::uint16_t>(channel));
    out.number(static_cast<std::uint32_t>(messages.size() * 2 * sizeof(std::uint64_t)));
    for (const auto& [time_ns, offset] : messages) {
      out.number(time_ns);
      out.number(offset);
    }
    out.end();
  }
  // The indexes follow their chunk, whose length was all that had been put out.
  index.index_bytes = out_.size() - index.length;
}

bool McapWriter::write(const Attachment& attachment) {
  RecordBuilder out(out_);
  out.begin(Opcode::attachment);
  out.number(attachment.log_time_ns);
  out.number(attachment.create_time_ns);
  out.text(attachment.name);
  out.text(attachment.media_type);
  out.number(static_cast<std::uint64_t>(attachment.data.size()));
  out.bytes(std::as_bytes(std::span(attachment.data)));
  out.number(crc_of(0, std::span(out_).subspan(record_head_bytes)));
  out.end();
  // The index entry in the summary needs the offset at which this attachment begins, which is known only before it is
  // written.
  FileIndex& index = file_index_.emplace_back(FileIndex{Opcode::attachment_index, {}});
  RecordBuilder content(index.content);
  content.number(bytes_);
  content.number(static_cast<std::uint64_t>(out_.size()));
  content.number(attachment.log_time_ns);
  content.number(attachment.create_time_ns);
  content.number(static_cast<std::uint64_t>(attachment.data.size()));
  content.text(attachment.name);
  content.text(attachment.media_type);
  return put_out();
}

bool McapWriter::write(const Metadata& metadata) {
  RecordBuilder out(out_);
  out.begin(Opcode::metadata);
  out.text(metadata.name);
  out.map(metadata.entries);
  out.end();
  FileIndex& index = file_index_.emplace_back(FileIndex{Opcode::metadata_index, {}});
  RecordBuilder content(index.content);
  content.number(bytes_);
  content.number(static_cast<std::uint64_t>(out_.size()));
  content.text(metadata.name);
  return put_out();
}

bool McapWriter::put_out() {
  crc_ = crc_of(crc_, out_);
  bytes_ += out_.size();
  FileWriter::Block block;
  block.bytes = std::move(out_);
  block.used = block.bytes.size();
  failed_ = (!failed_ && block.used > 0 && !file_.hand_over(block)) || failed_;
  out_ = std::move(block.bytes);  // memory of a block that was written
  out_.clear();
  return !failed_;
}

bool McapWriter::flush() {
  return end_chunk() && file_.finish();
}

bool McapWriter::finish() {
  if (finished_) return !failed_;
  finished_ = true;
  if (!end_chunk()) return false;
  RecordBuilder out(out_);
  out.begin(Opcode::data_end);
  out.number(crc_);
  out.end();
  put_summary(out);
  failed_ = !put_out() || !file_.finish();
  return !failed_;
}

void McapWriter::put_chunk_indexes(RecordBuilder& out) const {
  for (const ChunkIndex& index : chunk_index_) {
    out.begin(Opcode::chunk_index);
    out.number(index.time.first_ns);
    out.number(index.time.last_ns);
    out.number(index.offset);
    out.number(index.length);
    // Each entry has a number of 2 and an offset of 8 bytes.
    out.number(static_cast<std::uint32_t>(index.index_offsets.size() * 10));
    for (const auto& [channel, offset] : index.index_offsets) {
      out.number(channel);
      out.number(offset);
    }
    out.number(index.index_bytes);
    out.text("zstd");
    out.number(index.compressed_bytes);
    out.number(index.raw_bytes);
    out.end();
  }
}

void McapWriter::put_statistics(RecordBuilder& out) const {
  const auto count_of = [this](Opcode opcode) {
    return static_cast<std::uint32_t>(std::count_if(file_index_.begin(), file_index_.end(),
                                                    [&](const FileIndex& each) { return each.opcode == opcode; }));
  };
  const auto written = [](const std::vector<bool>& flags) { return std::count(flags.begin(), flags.end(), true); };
  out.begin(Opcode::statistics);
  out.number(messages_);
  out.number(static_cast<std::uint16_t>(written(schema_written_)));
  out.number(static_cast<std::uint32_t>(written(channel_written_)));
  out.number(count_of(Opcode::attachment_index));
  out.number(count_of(Opcode::metadata_index));
  out.number(static_cast<std::uint32_t>(chunk_index_.size()));
  out.number(time_.first_ns);
  out.number(time_.last_ns);
  // Each channel is listed with a number of 2 and a count of 8 bytes.
  out.number(static_cast<std::uint32_t>(written(channel_written_) * 10));
  for (std::size_t channel = 1; channel <= channels_.size(); ++channel) {
    if (!channel_written_[channel - 1]) continue;
    out.number(static_cast<std::uint16_t>(channel));
    out.number(counts_[channel - 1]);
  }
  out.end();
}

void McapWriter::put_summary(RecordBuilder& out) {
  struct Group {
    Opcode opcode;
    std::uint64_t begin, length;
  };
  std::vector<Group> groups;
  const std::size_t summary_at = out_.size();
  const auto group = [&](Opcode opcode, const std::function<void()>& put) {
    const std::size_t begin = out_.size();
    put();
    if (out_.size() > begin) groups.push_back({opcode, bytes_ + begin, out_.size() - begin});
  };
  // Records of one kind are adjacent, so that readers find them by the offsets behind.
  group(Opcode::schema, [&] {
    for (std::size_t number = 1; number <= schemas_.size(); ++number)
      if (schema_written_[number - 1]) put_schema(out, number);
  });
  group(Opcode::channel, [&] {
    for (std::size_t number = 1; number <= channels_.size(); ++number)
      if (channel_written_[number - 1]) put_channel(out, number);
  });
  group(Opcode::statistics, [&] { put_statistics(out); });
  group(Opcode::chunk_index, [&] { put_chunk_indexes(out); });
  for (const Opcode opcode : {Opcode::attachment_index, Opcode::metadata_index})
    group(opcode, [&] {
      for (const FileIndex& index : file_index_) {
        if (index.opcode != opcode) continue;
        out.begin(opcode);
        out.bytes(index.content);
        out.end();
      }
    });
  // Offsets of the groups, and the footer with the checksum of all from the summary to itself.
  const std::uint64_t offsets_at = bytes_ + out_.size();
  for (const Group& each : groups) {
    out.begin(Opcode::summary_offset);
    out.number(static_cast<std::uint8_t>(each.opcode));
    out.number(each.begin);
    out.number(each.length);
    out.end();
  }
  out.begin(Opcode::footer);
  out.number(bytes_ + summary_at);
  out.number(offsets_at);
  out.number(std::uint32_t{0});
  out.end();
  const std::size_t crc_at = out_.size() - sizeof(std::uint32_t);
  const std::uint32_t crc = crc_of(0, std::span(out_).subspan(summary_at, crc_at - summary_at));
  std::memcpy(out_.data() + crc_at, &crc, sizeof crc);
  out.bytes(std::as_bytes(std::span(magic)));
}

}  // namespace bridges::mcap
