// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "sim/image/image.hpp"

namespace viewer {

/// Film that cannot be written.  what() is one line with the file and the reason.
class FilmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Size and speed of a film.
struct FilmFormat {
  int width = 640;
  int height = 480;
  int fps = 30;
};

/// Writer of the frames of a film.  The file gets its name in finish(); without it nothing is left behind.
class FilmWriter {
 public:
  virtual ~FilmWriter() = default;
  /// Adds an RGB frame of the size of the format.  Throws FilmError.
  virtual void add(const sim::Image8& frame) = 0;
  /// Completes the film.  Throws FilmError.
  virtual void finish() = 0;
};

/// Makes a writer by the ending of a file: .mp4 (H.264) and .webm (VP9) by the program `ffmpeg`, .avi (Motion JPEG) by
/// Shoal itself, .png (NAME_00000.png and so on), or a folder, which ends in a slash (frame_00000.png and so on).
/// Throws std::invalid_argument for another ending or a size that the format lacks, FilmError when the file cannot be
/// written or there is no ffmpeg.
std::unique_ptr<FilmWriter> make_film_writer(const std::string& file, const FilmFormat& format);

/// Throws as make_film_writer() does, and creates nothing.
void check_film_file(const std::string& file, const FilmFormat& format);

}  // namespace viewer
