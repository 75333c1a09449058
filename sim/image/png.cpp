// SPDX-License-Identifier: BSD-3-Clause
#include <png.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "sim/image/image_file.hpp"

namespace sim {

namespace {

/// Owner of libpng's state of a reader or writer.
struct PngImage {
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  [[noreturn]] void fail() const { throw ImageError(std::string("PNG: ") + image.message); }
  png_image image{};
};

template <typename T>
void write_png(const Image<T>& image, png_uint_32 format, Bytes& out) {
  PngImage png;
  png.image.width = static_cast<png_uint_32>(image.width);
  png.image.height = static_cast<png_uint_32>(image.height);
  png.image.format = format;
  png.image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png.image);
  out.resize(size);
  if (!png_image_write_to_memory(&png.image, out.data(), &size, 0, image.data.data(), 0, nullptr)) png.fail();
  out.resize(size);
}

template <typename T>
Image<T> read_png(std::span<const std::byte> bytes, png_uint_32 format, int channels) {
  PngImage png;
  if (!png_image_begin_read_from_memory(&png.image, bytes.data(), bytes.size())) png.fail();
  check_image_size(png.image.width, png.image.height);
  Image<T> image(static_cast<int>(png.image.width), static_cast<int>(png.image.height), channels);
  png.image.format = format;
  if (PNG_IMAGE_SIZE(png.image) != image.data.size() * sizeof(T)) throw ImageError("PNG: rows of another size");
  const png_color black{0, 0, 0};  // background of transparent pixels
  if (!png_image_finish_read(&png.image, &black, image.data.data(), 0, nullptr)) png.fail();
  return image;
}

/// Reader based on libpng's row interface, because its simplified interface converts gamma.  libpng reports errors by
/// longjmp; functions that it may leave hold no objects with destructors.
class LevelReader {
 public:
  explicit LevelReader(std::span<const std::byte> bytes) : rest_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &on_error, &on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ != nullptr) return;
    png_destroy_read_struct(&png_, &info_, nullptr);
    throw ImageError("PNG: out of memory");
  }
  ~LevelReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  LevelReader(const LevelReader&) = delete;
  LevelReader& operator=(const LevelReader&) = delete;

  void read_header() {
    if (!try_header()) fail();
  }
  void read_rows(std::uint16_t* levels) {
    if (!try_rows(levels)) fail();
  }
  std::uint32_t width() const { return png_get_image_width(png_, info_); }
  std::uint32_t height() const { return png_get_image_height(png_, info_); }
  bool plain_grey() const {
    return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY && png_get_valid(png_, info_, PNG_INFO_tRNS) == 0;
  }

 private:
  [[noreturn]] void fail() const { throw ImageError(std::string("PNG: ") + message_); }
  bool try_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, &on_read);
    png_read_info(png_, info_);
    return true;
  }
  bool try_rows(std::uint16_t* levels) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_expand_16(png_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    // Check the row size reported by libpng against the buffer: with tRNS it adds a channel.
    if (png_get_rowbytes(png_, info_) != std::size_t{width()} * sizeof *levels) png_error(png_, "rows of another size");
    for (int pass = 0; pass < passes; ++pass)
      for (std::size_t row = 0; row < height(); ++row)
        png_read_row(png_, reinterpret_cast<png_bytep>(levels + row * width()), nullptr);
    png_read_end(png_, nullptr);
    return true;
  }
  static void on_read(png_structp png, png_bytep to, png_size_t size) {
    auto* self = static_cast<LevelReader*>(png_get_io_ptr(png));
    if (size > self->rest_.size()) png_error(png, "the file ends too early");
    std::memcpy(to, self->rest_.data(), size);
    self->rest_ = self->rest_.subspan(size);
  }
  static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<LevelReader*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::span<const std::byte> rest_;
  char message_[120] = "";
};

}  // namespace

void encode_png(const Image8& image, Bytes& out) {
  write_png(image, image.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB, out);
}

void encode_png(const Image16& image, Bytes& out) {
  write_png(image, PNG_FORMAT_LINEAR_Y, out);
}

Image8 decode_png(std::span<const std::byte> bytes) {
  return read_png<std::uint8_t>(bytes, PNG_FORMAT_RGB, 3);
}

Image16 decode_png16(std::span<const std::byte> bytes) {
  return read_png<std::uint16_t>(bytes, PNG_FORMAT_LINEAR_Y, 1);
}

Image16 decode_png_levels(std::span<const std::byte> bytes,
                          const std::function<void(std::uint64_t width, std::uint64_t height)>& check_size) {
  LevelReader png(bytes);
  png.read_header();
  if (!png.plain_grey()) throw ImageError("PNG: has colors or transparency, must be plain grey");
  check_size(png.width(), png.height());
  Image16 levels(static_cast<int>(png.width()), static_cast<int>(png.height()), 1);
  png.read_rows(levels.data.data());
  return levels;
}

}  // namespace sim
