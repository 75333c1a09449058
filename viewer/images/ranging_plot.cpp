// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiment/files/gnuplot.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/multibeam_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/point_cloud_t.hpp"
#include "shoal/radar_sector_t.hpp"
#include "shoal/side_scan_t.hpp"
#include "shoal/sonar_image_t.hpp"
#include "sim/base/math.hpp"
#include "viewer/images/log_image.hpp"

namespace viewer {

namespace {

constexpr double max_raster_bytes = 1e9;
constexpr const char* sonar_palette =
    "set palette defined (0 '#000000', 0.35 '#5a2d0c', 0.7 '#d08030', 1 '#fff0c0') maxcolors 20\nunset colorbox\n";
constexpr const char* radar_palette =
    "set palette defined (0 '#000814', 0.3 '#00406a', 0.6 '#20b060', 0.8 '#f0e040', 1 '#ff4020') maxcolors 32\n"
    "unset colorbox\n";
constexpr const char* depth_palette =
    "set palette defined (0 '#30123b', 0.25 '#4686fb', 0.5 '#1ae4b6', 0.75 '#faba39', "
    "1 '#7a0403')\nset rmargin at screen 0.8\n";

/// Input of gnuplot: a file of bytes or of text, and the commands that draw it.
struct Drawing {
  std::string data;
  std::string commands;  ///< `data` is the file name
};

template <typename Message>
std::vector<Message> decode_all(const std::vector<sim::Bytes>& payloads) {
  std::vector<Message> all;
  for (const sim::Bytes& payload : payloads) all.push_back(shoal::decode<Message>(payload, shoal::Finite::required));
  return all;
}

template <typename Message>
Message only(const std::vector<sim::Bytes>& payloads) {
  return shoal::decode<Message>(payloads.front(), shoal::Finite::required);
}

/// Checks that the counts in a message match its data, because a log may have any origin.
void check_count(const char* what, std::size_t has, std::int64_t reports) {
  if (reports < 0 || has != static_cast<std::size_t>(reports))
    throw std::runtime_error(fmt::format("a message says it has {} {}, but has {}", reports, what, has));
}

/// Returns the command for a raster of bytes with its lower left corner at (x, y).
std::string image_command(int width, int height, double x, double y, double dx, double dy) {
  return fmt::format("plot 'data' binary array=({},{}) format='%uchar' origin=({},{}) dx={} dy={} with image notitle\n",
                     width, height, x + dx / 2, y + dy / 2, dx, dy);
}

Drawing draw(const shoal::sonar_image_t& image) {
  // Check the dimensions.
  check_count("bytes", image.data.size(), image.size);
  if (image.nbins < 1 || image.nbeams < 1 || image.size != std::int64_t{image.nbins} * image.nbeams ||
      !(image.range_max_m > image.range_min_m) || !(image.range_min_m >= 0))
    throw std::runtime_error("the image has an invalid size");
  // A single beam is drawn as a narrow wedge.
  const double half_rad = std::clamp(0.5 * std::abs(image.radstep) * image.nbeams, 0.05, std::numbers::pi);
  // Extent and resolution of the raster.
  const double half_width_m = image.range_max_m * (half_rad < std::numbers::pi / 2 ? std::sin(half_rad) : 1);
  const double low_m = half_rad < std::numbers::pi / 2 ? 0 : -image.range_max_m;
  const double cell_m = 2 * half_width_m / 500;
  const int width = 500, height = static_cast<int>((image.range_max_m - low_m) / cell_m);
  const double bin_m = (image.range_max_m - image.range_min_m) / image.nbins;
  Drawing drawing;
  // x of the image points to the right, which is -y of the sensor; up is forward.
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double right_m = -half_width_m + (column + 0.5) * cell_m, forward_m = low_m + (row + 0.5) * cell_m;
      const double bin = std::floor((std::hypot(right_m, forward_m) - image.range_min_m) / bin_m);
      const double bearing_rad = std::atan2(-right_m, forward_m);
      const double beam = image.radstep != 0 ? std::round((bearing_rad - image.rad0) / image.radstep) : 0;
      const bool inside = bin >= 0 && bin < image.nbins && beam >= 0 && beam < image.nbeams;
      const std::size_t at = inside ? static_cast<std::size_t>(bin * image.nbeams + beam) : 0;
      drawing.data += inside ? static_cast<char>(image.data.at(at)) : '\0';
    }
  drawing.commands = fmt::format("{}set size ratio -1\nset xlabel 'right (m)'\nset ylabel 'forward (m)'\n{}",
                                 sonar_palette, image_command(width, height, -half_width_m, low_m, cell_m, cell_m));
  return drawing;
}

Drawing draw(const std::vector<shoal::side_scan_t>& lines) {
  // Width of a line with the gap between the sides.
  const int bins = lines.front().nbins;
  const double range_m = lines.front().range_max_m, near_m = lines.front().range_min_m;
  if (bins < 1 || !(range_m > near_m) || !(near_m >= 0)) throw std::runtime_error("the lines have an invalid size");
  const double bin_m = (range_m - near_m) / bins;
  const double gap_bins = std::round(2 * near_m / bin_m);  // gap between the two sides
  const double width = 2.0 * bins + gap_bins;
  if (gap_bins > 10000 || width * static_cast<double>(lines.size()) > max_raster_bytes)
    throw std::runtime_error("the lines have an invalid size");
  // Append each line, port mirrored.
  Drawing drawing;
  for (const auto& line : lines) {
    if (line.nbins != bins) throw std::runtime_error("the number of bins changes");
    check_count("bins to port", line.port.size(), bins);
    check_count("bins to starboard", line.starboard.size(), bins);
    drawing.data.append(line.port.rbegin(), line.port.rend());
    drawing.data.append(static_cast<std::size_t>(gap_bins), '\0');
    drawing.data.append(line.starboard.begin(), line.starboard.end());
  }
  drawing.commands =
      fmt::format("{}set xlabel 'slant range (m): port to the left'\nset ylabel 'ping'\n{}", sonar_palette,
                  image_command(static_cast<int>(width), static_cast<int>(lines.size()), -range_m, -0.5, bin_m, 1));
  return drawing;
}

Drawing draw(const std::vector<shoal::multibeam_t>& pings) {
  Drawing drawing;
  for (std::size_t ping = 0; ping < pings.size(); ++ping) {
    check_count("ranges", pings[ping].ranges_m.size(), pings[ping].count);
    check_count("angles", pings[ping].angles_rad.size(), pings[ping].count);
    check_count("valid flags", pings[ping].valid.size(), pings[ping].count);
    for (std::size_t i = 0; i < pings[ping].ranges_m.size(); ++i)
      if (pings[ping].valid[i])
        drawing.data +=
            fmt::format("{:.3f} {} {:.3f}\n", -pings[ping].ranges_m[i] * std::sin(pings[ping].angles_rad[i]), ping,
                        -pings[ping].ranges_m[i] * std::cos(pings[ping].angles_rad[i]));
  }
  drawing.commands = fmt::format(
      "{}set xlabel 'across (m): port to the left'\nset ylabel 'ping'\nset cblabel 'z (m)'\n"
      "plot 'data' using 1:2:3 with points pt 5 ps 0.35 palette notitle\n",
      depth_palette);
  return drawing;
}

Drawing draw(const shoal::point_cloud_t& cloud) {
  Drawing drawing;
  for (const auto* values : {&cloud.x_m, &cloud.y_m, &cloud.z_m}) check_count("points", values->size(), cloud.count);
  for (std::size_t i = 0; i < cloud.x_m.size(); ++i)
    drawing.data += fmt::format("{:.3f} {:.3f} {:.3f}\n", cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]);
  drawing.commands = fmt::format(
      "{}set size ratio -1\nset xlabel 'x (m)'\nset ylabel 'y (m)'\nset cblabel 'z (m)'\n"
      "plot 'data' using 1:2:3 with points pt 7 ps 0.2 palette notitle\n",
      depth_palette);
  return drawing;
}

Drawing draw(const shoal::planar_lidar_t& scan) {
  Drawing drawing;
  check_count("ranges", scan.ranges.size(), scan.nranges);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle_rad = scan.rad0 + static_cast<double>(i) * scan.radstep;
    drawing.data +=
        fmt::format("{:.3f} {:.3f}\n", scan.ranges[i] * std::cos(angle_rad), scan.ranges[i] * std::sin(angle_rad));
  }
  drawing.commands =
      "set size ratio -1\nset xlabel 'x (m)'\nset ylabel 'y (m)'\n"
      "plot 'data' using 1:2 with points pt 7 ps 0.3 notitle\n";
  return drawing;
}

/// Spoke of a radar: its azimuth, and its cells in the message.
struct DrawnSpoke {
  double azimuth_rad;
  const std::uint8_t* cells;
  bool operator<(const DrawnSpoke& other) const { return azimuth_rad < other.azimuth_rad; }
};

void check_sector(const shoal::radar_sector_t& sector) {
  check_count("azimuths", sector.azimuths_rad.size(), sector.nspokes);
  check_count("bytes", sector.data.size(), sector.size);
  if (sector.ncells < 1 || sector.size != std::int64_t{sector.nspokes} * sector.ncells || !(sector.range_max_m > 0))
    throw std::runtime_error("the sector has an invalid size");
}

/// Draws the spokes of the last turn; earlier ones of another range are left out.
Drawing draw(const std::vector<shoal::radar_sector_t>& sectors) {
  for (const shoal::radar_sector_t& sector : sectors) check_sector(sector);
  const int cells = sectors.back().ncells;
  const double range_m = sectors.back().range_max_m;
  // The newest first, until the antenna has turned once.
  std::vector<DrawnSpoke> spokes;
  double turned_rad = 0;
  for (auto sector = sectors.rbegin(); sector != sectors.rend(); ++sector) {
    if (sector->ncells != cells || sector->range_max_m != sectors.back().range_max_m) break;
    for (int i = sector->nspokes - 1; i >= 0 && turned_rad < 2 * std::numbers::pi; --i) {
      const double azimuth_rad = sector->azimuths_rad[static_cast<std::size_t>(i)];
      if (!spokes.empty()) turned_rad += std::abs(sim::wrap_angle(azimuth_rad - spokes.back().azimuth_rad));
      spokes.push_back(
          {azimuth_rad, sector->data.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(cells)});
    }
  }
  if (spokes.empty()) return {};
  const double step_rad = spokes.size() > 1 ? turned_rad / static_cast<double>(spokes.size() - 1) : 0.05;
  std::sort(spokes.begin(), spokes.end());
  // x of the image points to the right, which is -y of the sensor; up is forward.
  constexpr int width = 500;
  const double pixel_m = 2 * range_m / width;
  Drawing drawing;
  for (int row = 0; row < width; ++row)
    for (int column = 0; column < width; ++column) {
      const double right_m = (column + 0.5) * pixel_m - range_m, forward_m = (row + 0.5) * pixel_m - range_m;
      const double cell = std::floor(std::hypot(right_m, forward_m) / range_m * cells);
      const double azimuth_rad = std::atan2(-right_m, forward_m);
      auto next = std::lower_bound(spokes.begin(), spokes.end(), DrawnSpoke{azimuth_rad, nullptr});
      const DrawnSpoke& after = next == spokes.end() ? spokes.front() : *next;
      const DrawnSpoke& before = next == spokes.begin() ? spokes.back() : *std::prev(next);
      const auto away_rad = [&](const DrawnSpoke& spoke) {
        return std::abs(sim::wrap_angle(spoke.azimuth_rad - azimuth_rad));
      };
      const DrawnSpoke& nearest = away_rad(after) < away_rad(before) ? after : before;
      const bool inside = cell < cells && away_rad(nearest) <= step_rad;
      drawing.data += inside ? static_cast<char>(nearest.cells[static_cast<std::size_t>(cell)]) : '\0';
    }
  drawing.commands = fmt::format("{}set size ratio -1\nset xlabel 'right (m)'\nset ylabel 'forward (m)'\n{}",
                                 radar_palette, image_command(width, width, -range_m, -range_m, pixel_m, pixel_m));
  return drawing;
}

Drawing draw(const std::vector<sim::Bytes>& payloads) {
  const std::int64_t type = shoal::fingerprint(payloads.front());
  if (type == shoal::sonar_image_t::getHash()) return draw(only<shoal::sonar_image_t>(payloads));
  if (type == shoal::side_scan_t::getHash()) return draw(decode_all<shoal::side_scan_t>(payloads));
  if (type == shoal::multibeam_t::getHash()) return draw(decode_all<shoal::multibeam_t>(payloads));
  if (type == shoal::point_cloud_t::getHash()) return draw(only<shoal::point_cloud_t>(payloads));
  if (type == shoal::planar_lidar_t::getHash()) return draw(only<shoal::planar_lidar_t>(payloads));
  if (type == shoal::radar_sector_t::getHash()) return draw(decode_all<shoal::radar_sector_t>(payloads));
  throw std::runtime_error(
      "its type cannot be drawn; image_t, sonar_image_t, side_scan_t, multibeam_t, point_cloud_t, planar_lidar_t and "
      "radar_sector_t can");
}

}  // namespace

bool are_all_drawn(std::int64_t type) {
  return type == shoal::side_scan_t::getHash() || type == shoal::multibeam_t::getHash();
}

bool is_drawn_with_those_before(std::int64_t type) {
  return type == shoal::radar_sector_t::getHash();
}

void draw_ranging(const std::vector<sim::Bytes>& payloads, const std::string& title, const std::string& png) {
  const Drawing drawing = draw(payloads);
  if (drawing.data.empty()) throw std::runtime_error(title + ": there is nothing to draw");
  const experiment::ScratchDirectory scratch;
  std::ofstream(scratch.path / "data", std::ios::binary) << drawing.data;
  std::ofstream(scratch.path / "plot.gp") << fmt::format(
      "set terminal pngcairo size 600,480\nset output {}\nset title {} noenhanced\n"
      "set tics out\nset autoscale fix\n{}",
      experiment::gnuplot_text(std::filesystem::absolute(png).string()), experiment::gnuplot_text(title),
      drawing.commands);
  if (experiment::run_gnuplot(scratch.path.string(), "plot.gp", std::chrono::seconds(60), [] { return false; })) return;
  std::ifstream reported(scratch.path / "plot.log");
  throw std::runtime_error("gnuplot failed: " + std::string(std::istreambuf_iterator<char>(reported), {}));
}

}  // namespace viewer
