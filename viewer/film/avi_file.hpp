// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "experiment/files/part_file.hpp"
#include "sim/bus/bus.hpp"
#include "viewer/film/film_writer.hpp"

namespace viewer {

/// Writer of AVI files (RIFF, version 1) with Motion JPEG, which most players show.
class AviFile final : public FilmWriter {
 public:
  AviFile(std::string file, const FilmFormat& format);

  void add(const sim::Image8& frame) override;
  void finish() override;

 private:
  /// Frame in the index.
  struct Entry {
    std::uint32_t offset = 0, bytes = 0;
  };

  std::string header() const;
  void write(const std::string& bytes);
  [[noreturn]] void fail() const;

  experiment::PartFile<FilmError> file_;
  FilmFormat format_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out_;
  std::vector<Entry> entries_;
  std::uint64_t data_bytes_ = 0;  // of all frames with their heads
  std::uint32_t max_frame_bytes_ = 0;
  sim::Bytes jpeg_;
};

}  // namespace viewer
