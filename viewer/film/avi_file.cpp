// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/avi_file.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "sim/image/image_file.hpp"

namespace viewer {

namespace {

constexpr int jpeg_quality = 90;
/// Many players read no AVI of this version beyond it.
constexpr std::uint64_t max_bytes = 2'000'000'000;

/// Little-endian numbers.
std::string number(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
  return text;
}
std::string u32(std::uint64_t value) {
  return number(value, 4);
}
std::string u16(std::uint64_t value) {
  return number(value, 2);
}
std::string chunk(const std::string& name, const std::string& content) {
  return name + u32(content.size()) + content;
}

}  // namespace

AviFile::AviFile(std::string file, const FilmFormat& format)
    : file_(std::move(file)),
      format_(format),
      out_(fdopen(fcntl(file_.number(), F_DUPFD_CLOEXEC, 0), "wb"), std::fclose) {
  if (!out_) fail();
  write(header());
}

void AviFile::fail() const {
  throw FilmError(file_.path() + ": cannot be written: " + std::strerror(errno));
}

void AviFile::write(const std::string& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), out_.get()) != bytes.size()) fail();
}

std::string AviFile::header() const {
  const auto width = static_cast<std::uint64_t>(format_.width), height = static_cast<std::uint64_t>(format_.height);
  const std::uint64_t frames = entries_.size(), fps = static_cast<std::uint64_t>(format_.fps);
  // Main header, header and format of the stream.
  constexpr std::uint64_t has_index = 0x10;
  const std::string main = u32(1'000'000 / fps) + u32(max_frame_bytes_ * fps) + u32(0) + u32(has_index) + u32(frames) +
                           u32(0) + u32(1) + u32(max_frame_bytes_) + u32(width) + u32(height) + std::string(16, '\0');
  const std::string stream = "vidsMJPG" + u32(0) + u32(0) + u32(0) + u32(1) + u32(fps) + u32(0) + u32(frames) +
                             u32(max_frame_bytes_) + u32(0xFFFFFFFF) + u32(0) + u16(0) + u16(0) + u16(width) +
                             u16(height);
  const std::string form =
      u32(40) + u32(width) + u32(height) + u16(1) + u16(24) + "MJPG" + u32(width * height * 3) + std::string(16, '\0');
  const std::string list = chunk("LIST", "strl" + chunk("strh", stream) + chunk("strf", form));
  const std::string head = chunk("LIST", "hdrl" + chunk("avih", main) + list);
  // The list of frames, whose content follows, and the index after it.
  const std::uint64_t list_bytes = 4 + data_bytes_;
  const std::uint64_t all = 4 + head.size() + 8 + list_bytes + 8 + 16 * frames;
  return "RIFF" + u32(all) + "AVI " + head + "LIST" + u32(list_bytes) + "movi";
}

void AviFile::add(const sim::Image8& frame) {
  sim::encode_jpeg(frame, jpeg_quality, jpeg_);
  const auto bytes = static_cast<std::uint32_t>(jpeg_.size());
  // Sizes in RIFF have 32 bits. The index, 16 bytes per frame, is still to come.
  if (data_bytes_ + bytes + 16 * entries_.size() > max_bytes)
    throw FilmError(fmt::format("{}: larger than {} bytes, which an .avi may have; write an .mp4, or a shorter film",
                                file_.path(), max_bytes));
  entries_.push_back({static_cast<std::uint32_t>(4 + data_bytes_), bytes});
  max_frame_bytes_ = std::max(max_frame_bytes_, bytes);
  std::string data = "00dc" + u32(bytes);
  data.append(reinterpret_cast<const char*>(jpeg_.data()), jpeg_.size());
  // Chunks of RIFF begin at even offsets.
  if (bytes % 2 != 0) data += '\0';
  write(data);
  data_bytes_ += data.size();
}

void AviFile::finish() {
  // Index, and the header again with the numbers that are known now.
  constexpr std::uint64_t key_frame = 0x10;
  std::string index;
  for (const Entry& entry : entries_) index += "00dc" + u32(key_frame) + u32(entry.offset) + u32(entry.bytes);
  write(chunk("idx1", index));
  if (std::fseek(out_.get(), 0, SEEK_SET) != 0) fail();
  write(header());
  if (std::fflush(out_.get()) != 0) fail();
  file_.finish();
  out_.reset();
}

}  // namespace viewer
