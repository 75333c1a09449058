#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tools {

/// Draws what a range sensor recorded, by gnuplot, as a PNG file:
///   sonar_image_t   one picture, laid out as a fan in metres
///   side_scan_t     all lines, one above the other, port on the left, over slant range
///   multibeam_t     all pings, one above the other, coloured by depth
///   point_cloud_t   one turn, seen from above, coloured by height
///   planar_lidar_t  one scan, seen from above
/// `number` picks the picture, turn or scan, from 0; unset: the last.  Throws std::runtime_error with the reason.
/// Returns what was wrong with the log where a picture was possible all the same.
std::vector<std::string> draw_ranging(const std::string& log, const std::string& channel, const std::string& png,
                                      std::optional<int> number);

}  // namespace tools
