// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shoal/image_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/image/image.hpp"

namespace viewer {

/// Selects the message of a channel that is drawn; at most one member is set.  Neither: the last message.
struct ImageChoice {
  std::optional<int> number;   ///< from 0
  std::optional<double> at_s;  ///< the nearest to this simulated time
};

struct LogImage {
  std::string drawn;                  ///< such as `message 12 of 0 to 44, at 12 s`
  std::vector<std::string> problems;  ///< damage of the log that did not prevent the image
};

/// Draws the recording of a sensor on a channel of an LCM event log, as a PNG file:
///   image_t         one image of a camera: color, grey, JPEG and PNG unchanged; depth on a logarithmic scale, where
///                   near is bright; labels in one color each
///   side_scan_t     all lines, one above the other, port on the left, over slant range
///   multibeam_t     all pings, one above the other, colored by depth
///   point_cloud_t   one turn, seen from above, colored by height
///   planar_lidar_t  one scan, seen from above
///   sonar_image_t   one image, seen from above
///   radar_sector_t  the turn of the antenna that ends with the message, seen from above
/// All but the first are plotted by gnuplot.  Simulated time counts from the start of the run, which `sim.info` in the
/// log contains; without it, from the first event.  Throws std::runtime_error with the reason.
LogImage draw_log(const std::string& log, const std::string& channel, const std::string& png,
                  const ImageChoice& choice);

/// Converts the image of a camera message to a displayable one.  Throws std::runtime_error when its size, format and
/// data are inconsistent; sim::ImageError when compressed data is damaged.
sim::Image8 displayable(const shoal::image_t& message);

/// Returns true for types of which all messages are drawn in one plot, side_scan_t and multibeam_t; false for types of
/// which each message is one image.
bool are_all_drawn(std::int64_t fingerprint);

/// Returns true for types of which the messages before the chosen one complete its image: radar_sector_t.
bool is_drawn_with_those_before(std::int64_t fingerprint);

/// Plots a recording of a range sensor with gnuplot, as a PNG file: all payloads where are_all_drawn(), the turn that
/// ends with the last where is_drawn_with_those_before(), else the first.
/// All are of one type.  Throws std::runtime_error with the reason.
void draw_ranging(const std::vector<sim::Bytes>& payloads, const std::string& title, const std::string& png);

}  // namespace viewer
