// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

#include "devices/ranging/camera.hpp"
#include "shoal/image_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/image/image_file.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/images/log_image.hpp"

namespace image_log {

inline constexpr std::int64_t epoch_us = 1'000'000'000'000;

/// A log that is written event by event.
class Log {
 public:
  void add(double time_s, const std::string& channel, const sim::Bytes& payload) {
    const auto put = [&](std::uint64_t value, int bytes) {  // big-endian
      for (int i = bytes - 1; i >= 0; --i) bytes_ += static_cast<char>(value >> (8 * i));
    };
    put(0xEDA1DA01, 4);
    put(number_++, 8);
    put(static_cast<std::uint64_t>(epoch_us + std::llround(1e6 * time_s)), 8);
    put(channel.size(), 4);
    put(payload.size(), 4);
    bytes_ += channel + std::string(reinterpret_cast<const char*>(payload.data()), payload.size());
  }
  void add_start(double first_s) {
    shoal::sim_info_t info{};
    info.epoch_utime = epoch_us;
    add(first_s, "sim.info", shoal::encode(info));
  }
  std::string write(const std::string& path) const {
    std::ofstream(path, std::ios::binary) << bytes_;
    return path;
  }

 private:
  std::string bytes_;
  std::uint64_t number_ = 0;
};

/// A grey image of 2 x 1 pixels.
inline shoal::image_t grey(std::uint8_t left, std::uint8_t right) {
  shoal::image_t image{};
  image.width = 2;
  image.height = 1;
  image.row_stride = 2;
  image.pixelformat = devices::pixel_format_grey;
  image.data = {left, right};
  image.size = 2;
  return image;
}

class LogImage : public testing::Test {
 protected:
  /// Images of a camera at 10.0, 10.5, 11.0, ... s of a run, whose left pixel is their number.
  std::string film(int images) {
    Log log;
    log.add_start(10);
    for (int i = 0; i < images; ++i)
      log.add(10 + 0.5 * i, "r.camera", shoal::encode(grey(static_cast<std::uint8_t>(i), 200)));
    return log.write(folder_.file("film.lcm"));
  }
  sim::Image8 drawn(const shoal::image_t& image) {
    Log log;
    log.add(0, "c", shoal::encode(image));
    viewer::draw_log(log.write(folder_.file("one.lcm")), "c", png_, {});
    return sim::read_image(png_);
  }
  std::string problem(const std::function<void()>& work) {
    try {
      work();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  test_support::ScratchFolder folder_;
  std::string png_ = folder_.file("out.png");
};

}  // namespace image_log
