// SPDX-License-Identifier: BSD-3-Clause
#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#include "sim/image/image_file.hpp"
// Requires cstdio.
#include <jpeglib.h>

namespace sim {

namespace {

// libjpeg reports errors by longjmp.  Functions that it may leave hold no objects with destructors.

struct JpegErrors {
  jpeg_error_mgr manager;  // must be first: libjpeg returns this address
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void jump_out(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  errors->manager.format_message(info, errors->message);
  std::longjmp(errors->jump, 1);
}

/// Treats warnings as errors: they mean damaged data.
void refuse_warnings(j_common_ptr info, int level) {
  if (level < 0) jump_out(info);
}

void use_errors(j_common_ptr info, JpegErrors& errors) {
  info->err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = jump_out;
  errors.manager.emit_message = refuse_warnings;
  errors.message[0] = 0;
}

/// Limits the number of scans, because a progressive file can hold thousands of empty ones.
void limit_scans(j_common_ptr info) {
  if (!info->is_decompressor || reinterpret_cast<j_decompress_ptr>(info)->input_scan_number < 500) return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  std::snprintf(errors->message, sizeof errors->message, "more than 500 scans");
  std::longjmp(errors->jump, 1);
}

class JpegReader {
 public:
  JpegReader() {
    use_errors(reinterpret_cast<j_common_ptr>(&info), errors);
    jpeg_create_decompress(&info);
    progress.progress_monitor = limit_scans;
    info.progress = &progress;
  }
  ~JpegReader() { jpeg_destroy_decompress(&info); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  bool open(const unsigned char* data, unsigned long size) {
    if (setjmp(errors.jump) != 0) return false;
    jpeg_mem_src(&info, data, size);
    jpeg_read_header(&info, TRUE);
    info.out_color_space = JCS_RGB;
    return true;
  }
  bool read(unsigned char* rgb, unsigned width, unsigned height) {
    if (setjmp(errors.jump) != 0) return false;
    jpeg_start_decompress(&info);
    // Check the size of the output reported by libjpeg against the size of the buffer.
    if (info.output_width != width || info.output_height != height || info.output_components != 3) {
      std::snprintf(errors.message, sizeof errors.message, "rows of another size");
      return false;
    }
    while (info.output_scanline < info.output_height) {
      JSAMPROW row = rgb + std::size_t(info.output_scanline) * info.output_width * 3;
      jpeg_read_scanlines(&info, &row, 1);
    }
    jpeg_finish_decompress(&info);
    return true;
  }

  jpeg_decompress_struct info{};
  jpeg_progress_mgr progress{};
  JpegErrors errors{};
};

class JpegWriter {
 public:
  JpegWriter() {
    use_errors(reinterpret_cast<j_common_ptr>(&info), errors);
    jpeg_create_compress(&info);
  }
  ~JpegWriter() {
    jpeg_destroy_compress(&info);
    std::free(data);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  bool write(const Image8& image, int quality) {
    // libjpeg reports errors by longjmp() to here.
    if (setjmp(errors.jump) != 0) return false;
    jpeg_mem_dest(&info, &data, &size);
    info.image_width = static_cast<JDIMENSION>(image.width);
    info.image_height = static_cast<JDIMENSION>(image.height);
    info.input_components = image.channels;
    info.in_color_space = image.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
      auto* row = const_cast<JSAMPROW>(image.at(0, static_cast<int>(info.next_scanline)));
      jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    return true;
  }

  jpeg_compress_struct info{};
  JpegErrors errors{};
  unsigned char* data = nullptr;
  unsigned long size = 0;
};

[[noreturn]] void fail(const JpegErrors& errors) {
  throw ImageError(std::string("JPEG: ") + errors.message);
}

}  // namespace

void encode_jpeg(const Image8& image, int quality, Bytes& out) {
  JpegWriter writer;
  if (!writer.write(image, quality)) fail(writer.errors);
  const auto* bytes = reinterpret_cast<const std::byte*>(writer.data);
  out.assign(bytes, bytes + writer.size);
}

Image8 decode_jpeg(std::span<const std::byte> bytes) {
  JpegReader reader;
  if (!reader.open(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())) fail(reader.errors);
  check_image_size(reader.info.image_width, reader.info.image_height);
  Image8 image(static_cast<int>(reader.info.image_width), static_cast<int>(reader.info.image_height), 3);
  if (!reader.read(image.data.data(), reader.info.image_width, reader.info.image_height)) fail(reader.errors);
  return image;
}

}  // namespace sim
