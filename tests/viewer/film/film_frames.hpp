// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>

#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/film/encoder_program.hpp"
#include "viewer/film/film_writer.hpp"

namespace film_frames {

inline sim::Image8 grey_frame(int level) {
  sim::Image8 frame(64, 48, 3);
  std::fill(frame.data.begin(), frame.data.end(), static_cast<std::uint8_t>(level));
  return frame;
}

inline std::string film_bytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

inline void write_frames(const std::string& file, int frames, bool finish = true) {
  const auto writer = viewer::make_film_writer(file, {64, 48, 30});
  for (int i = 0; i < frames; ++i) writer->add(grey_frame(20 * i));
  if (finish) writer->finish();
}

/// Puts a script in place of ffmpeg while it exists.
class OtherEncoder {
 public:
  explicit OtherEncoder(const std::string& script) {
    std::ofstream(folder_.file("ffmpeg")) << "#!/bin/sh\n" << script << '\n';
    chmod(folder_.file("ffmpeg").c_str(), 0755);
    setenv("PATH", (folder_.file("") + ":" + before_).c_str(), 1);
    signal(SIGPIPE, SIG_IGN);
  }
  ~OtherEncoder() { setenv("PATH", before_.c_str(), 1); }
  OtherEncoder(const OtherEncoder&) = delete;
  OtherEncoder& operator=(const OtherEncoder&) = delete;

 private:
  test_support::ScratchFolder folder_;
  std::string before_ = std::getenv("PATH");
};

}  // namespace film_frames
