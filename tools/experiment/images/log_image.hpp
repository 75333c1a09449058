// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tools {

/// Which message of a channel is drawn: at most one of both.  Neither: the last.
struct ImageChoice {
  std::optional<int> number;   ///< from 0
  std::optional<double> at_s;  ///< the nearest to this simulated time
};

struct LogImage {
  std::string drawn;                  ///< such as `message 12 of 0 to 44, at 12 s`
  std::vector<std::string> problems;  ///< what was wrong with the log, where an image was possible all the same
};

/// Draws what a sensor recorded on a channel of an LCM event log, as a PNG file:
///   image_t         one image of a camera: colour, grey, JPEG and PNG as they are; depth by its logarithm, near is
///                   bright; labels in a colour each
///   sonar_image_t   one image, laid out as a fan in metres
///   side_scan_t     all lines, one above the other, port on the left, over slant range
///   multibeam_t     all pings, one above the other, coloured by depth
///   point_cloud_t   one turn, seen from above, coloured by height
///   planar_lidar_t  one scan, seen from above
/// All but the first are plotted by gnuplot.  Simulated time is from the start of the run, which `sim.info` in the log
/// tells; in a log without it, from the first event.  Throws std::runtime_error with the reason.
LogImage draw_log(const std::string& log, const std::string& channel, const std::string& png,
                  const ImageChoice& choice);

}  // namespace tools
