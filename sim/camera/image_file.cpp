#include "sim/camera/image_file.hpp"

#include <png.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "sim/camera/jpeg.hpp"

namespace sim {

namespace {

constexpr std::size_t max_file_bytes = 256 << 20;

/// libpng's own record of a reader or a writer, freed whatever happens.
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
  const png_color black{0, 0, 0};  // behind what is transparent
  if (!png_image_finish_read(&png.image, &black, image.data.data(), 0, nullptr)) png.fail();
  return image;
}

bool starts_with(std::span<const std::byte> bytes, std::initializer_list<int> start) {
  return bytes.size() >= start.size() && std::equal(start.begin(), start.end(), bytes.begin(),
                                                    [](int a, std::byte b) { return a == static_cast<int>(b); });
}

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

void write_bytes(const std::string& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw ImageError(std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace

void check_image_size(std::uint64_t width, std::uint64_t height) {
  if (width >= 1 && height >= 1 && width <= max_image_side_px && height <= max_image_side_px &&
      width * height <= max_image_pixels)
    return;
  throw ImageError(fmt::format("{} x {} pixels; at most {} a side and {} in all", width, height, max_image_side_px,
                               max_image_pixels));
}

void encode_png(const Image8& image, Bytes& out) {
  write_png(image, image.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB, out);
}

void encode_png(const Image16& image, Bytes& out) {
  write_png(image, PNG_FORMAT_LINEAR_Y, out);
}

Image8 decode_image(std::span<const std::byte> bytes) {
  if (starts_with(bytes, {0x89, 'P', 'N', 'G'})) return read_png<std::uint8_t>(bytes, PNG_FORMAT_RGB, 3);
  if (starts_with(bytes, {0xFF, 0xD8, 0xFF})) return decode_jpeg(bytes);
  throw ImageError("neither PNG nor JPEG");
}

Image16 decode_png16(std::span<const std::byte> bytes) {
  return read_png<std::uint16_t>(bytes, PNG_FORMAT_LINEAR_Y, 1);
}

bool is_image_name(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

void write_image(const std::string& path, const Image8& image, int jpeg_quality) {
  if (!is_image_name(path)) throw ImageError("the name must end in .png, .jpg or .jpeg");
  Bytes bytes;
  if (ending_of(path) == ".png")
    encode_png(image, bytes);
  else
    encode_jpeg(image, jpeg_quality, bytes);
  write_bytes(path, bytes);
}

void write_image(const std::string& path, const Image16& image) {
  if (ending_of(path) != ".png") throw ImageError("16 bits need a name that ends in .png");
  Bytes bytes;
  encode_png(image, bytes);
  write_bytes(path, bytes);
}

Image8 read_image(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) throw ImageError("cannot be opened");
  if (static_cast<std::size_t>(size) > max_file_bytes) throw ImageError("larger than 256 MiB");
  Bytes bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) throw ImageError("cannot be read");
  return decode_image(bytes);
}

}  // namespace sim
