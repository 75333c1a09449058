// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "experiment/files/part_file.hpp"
#include "viewer/film/film_writer.hpp"

namespace viewer {

/// Film that the program `ffmpeg` encodes: raw frames go to its standard input.
class EncoderProgram final : public FilmWriter {
 public:
  /// `codec`: arguments of ffmpeg between input and output.  Throws FilmError when it cannot be started.
  EncoderProgram(std::string file, const FilmFormat& format, const std::vector<std::string>& codec);
  ~EncoderProgram() override;
  EncoderProgram(const EncoderProgram&) = delete;
  EncoderProgram& operator=(const EncoderProgram&) = delete;

  void add(const sim::Image8& frame) override;
  void finish() override;

 private:
  /// Waits for the end of the program and returns its status.
  int wait();
  [[noreturn]] void fail(int status);
  std::string last_words() const;

  experiment::PartFile<FilmError> file_, log_;  // the log is never finished
  pid_t pid_ = -1;
  bridges::FileDescriptor input_;
};

/// Returns whether the program `ffmpeg` is in PATH.
bool has_ffmpeg();

}  // namespace viewer
