// SPDX-License-Identifier: BSD-3-Clause
#include "sim/image/image_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "sim/base/whole_file.hpp"

namespace sim {

namespace {

constexpr std::uintmax_t max_file_mb = 256;

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

Image8 decode_image(std::span<const std::byte> bytes) {
  if (starts_with(bytes, {0x89, 'P', 'N', 'G'})) return decode_png(bytes);
  if (starts_with(bytes, {0xFF, 0xD8, 0xFF})) return decode_jpeg(bytes);
  throw ImageError("neither PNG nor JPEG");
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
  const std::string bytes = whole_file<ImageError>(path, max_file_mb);
  return decode_image(std::as_bytes(std::span(bytes)));
}

}  // namespace sim
