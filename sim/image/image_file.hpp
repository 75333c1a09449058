// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "sim/bus/bus.hpp"
#include "sim/image/image.hpp"

namespace sim {

/// An image that cannot be read or written.  what() is one line, without the name of the file.
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Written to memory.  `out` is replaced, and keeps its memory from image to image.

/// 8 bits, grey or RGB.
void encode_png(const Image8& image, Bytes& out);
/// 16 bits, grey.
void encode_png(const Image16& image, Bytes& out);
/// `quality`: 1 to 100.
void encode_jpeg(const Image8& image, int quality, Bytes& out);

/// A PNG or JPEG, by its first bytes, as RGB.  Throws ImageError for anything else, damaged or too large.
Image8 decode_image(std::span<const std::byte> bytes);
/// A grey PNG of 16 bits.
Image16 decode_png16(std::span<const std::byte> bytes);
/// The levels of a plain grey PNG of 1 to 16 bits as they were written, without gamma, widened to 0 .. 65535.
/// `check_size` throws what it likes for a size that is not wanted; it is called with width and height before memory is
/// taken for them.  Throws ImageError for damage, colors and transparency.
Image16 decode_png_levels(std::span<const std::byte> bytes,
                          const std::function<void(std::uint64_t width, std::uint64_t height)>& check_size);

/// By the ending of the name: .png, .jpg, .jpeg.  Throws ImageError.
void write_image(const std::string& path, const Image8& image, int jpeg_quality = 90);
/// .png only.
void write_image(const std::string& path, const Image16& image);
Image8 read_image(const std::string& path);
/// `path` ends in a name that write_image knows.
bool is_image_name(const std::string& path);

}  // namespace sim
