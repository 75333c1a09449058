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

/// Error of an image that cannot be read or written.  what() is one line without the name of the file.
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Encoders to memory.  `out` is overwritten; its capacity is reused.

/// Encodes a PNG of 8 bits, grey or RGB.
void encode_png(const Image8& image, Bytes& out);
/// Encodes a PNG of 16 bits, grey.
void encode_png(const Image16& image, Bytes& out);
/// Encodes a JPEG.  `quality`: 1 to 100.
void encode_jpeg(const Image8& image, int quality, Bytes& out);

/// Decodes a PNG or JPEG, detected by its first bytes, to RGB.  Throws ImageError for other formats and for damaged or
/// too large images.
Image8 decode_image(std::span<const std::byte> bytes);
/// Decodes a PNG to 16 bits of grey.  Throws ImageError.
Image16 decode_png16(std::span<const std::byte> bytes);
/// Decodes the levels of a plain grey PNG of 1 to 16 bits without gamma conversion, scaled to 0 .. 65535.  `check_size`
/// is called with width and height before memory is allocated and may throw to reject the size.  Throws ImageError for
/// damaged images and for images with colors or transparency.
Image16 decode_png_levels(std::span<const std::byte> bytes,
                          const std::function<void(std::uint64_t width, std::uint64_t height)>& check_size);

/// Writes an image in the format of the file extension: .png, .jpg or .jpeg.  Throws ImageError.
void write_image(const std::string& path, const Image8& image, int jpeg_quality = 90);
/// Writes a PNG of 16 bits; the extension must be .png.  Throws ImageError.
void write_image(const std::string& path, const Image16& image);
/// Reads a PNG or JPEG as RGB.  Throws ImageError.
Image8 read_image(const std::string& path);
/// Returns true when the file extension is one that write_image supports.
bool is_image_name(const std::string& path);

/// Throws ImageError for an image that is empty or too large.
void check_image_size(std::uint64_t width, std::uint64_t height);
/// Decodes a JPEG to RGB.  Throws ImageError.
Image8 decode_jpeg(std::span<const std::byte> bytes);

/// Decodes a PNG to RGB; transparent pixels are blended with black.  Throws ImageError.
Image8 decode_png(std::span<const std::byte> bytes);

}  // namespace sim
