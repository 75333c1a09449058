// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/mrclam_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace experiment {

namespace {

std::runtime_error mrclam_error(const std::string& path, const std::string& why) {
  return std::runtime_error(path + ": cannot be written: " + why);
}

}  // namespace

MrclamFile::MrclamFile(std::string path_of_file, const std::string& comment)
    : path(std::move(path_of_file)), file(std::fopen(path.c_str(), "w")) {
  if (!file) throw mrclam_error(path, std::strerror(errno));
  write("# " + comment + "\n");
}

void MrclamFile::write(const std::string& text) {
  std::fputs(text.c_str(), file.get());
}

void MrclamFile::close() {
  const bool bad = std::ferror(file.get()) != 0;
  if (std::fclose(file.release()) != 0 || bad) throw mrclam_error(path, std::strerror(errno));
}

MrclamPoses::MrclamPoses(const std::string& path, const std::string& robot)
    : file_(path, robot + "\n# Time [s]\tx [m]\ty [m]\torientation [rad]") {}

void MrclamPoses::add(double time_s, double x_m, double y_m, double yaw_rad) {
  file_.write(fmt::format("{:.3f}\t{:.6f}\t{:.6f}\t{:.6f}\n", time_s, x_m, y_m, yaw_rad));
}

void MrclamPoses::close() {
  file_.close();
}

int MrclamWriter::barcode_of(int robot) {
  constexpr std::array<int, 5> of_data_sets = {5, 14, 41, 32, 23};
  return robot < 5 ? of_data_sets[static_cast<std::size_t>(robot)] : 100 + robot;
}

MrclamWriter::MrclamWriter(const std::string& directory, const std::vector<std::string>& robots) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw mrclam_error(directory, error.message());
  MrclamFile barcodes(directory + "/Barcodes.dat", "Subject #\tBarcode #");
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const int robot = static_cast<int>(i);
    barcodes.write(fmt::format("{}\t{}\n", robot + 1, barcode_of(robot)));
    const std::string path = fmt::format("{}/Robot{}_", directory, i + 1);
    robots_.push_back(
        {MrclamPoses(path + "Groundtruth.dat", robots[i]),
         MrclamFile(path + "Odometry.dat", robots[i] + "\n# Time [s]\tforward velocity [m/s]\tangular velocity "
                                                       "[rad/s]"),
         MrclamFile(path + "Measurement.dat", robots[i] + "\n# Time [s]\tBarcode #\trange [m]\tbearing [rad]")});
  }
  barcodes.close();
  MrclamFile(directory + "/Landmark_Groundtruth.dat", "Subject #\tx [m]\ty [m]\tx std-dev [m]\ty std-dev [m]").close();
}

void MrclamWriter::add_truth(int robot, double time_s, double x_m, double y_m, double yaw_rad) {
  robots_[static_cast<std::size_t>(robot)].truth.add(time_s, x_m, y_m, yaw_rad);
}

void MrclamWriter::add_odometry(int robot, double time_s, double forward_mps, double turn_radps) {
  robots_[static_cast<std::size_t>(robot)].odometry.write(
      fmt::format("{:.3f}\t{:.6f}\t{:.6f}\n", time_s, forward_mps, turn_radps));
}

void MrclamWriter::add_measurement(int robot, double time_s, int seen, double range_m, double bearing_rad) {
  robots_[static_cast<std::size_t>(robot)].measurement.write(
      fmt::format("{:.3f}\t{}\t{:.6f}\t{:.6f}\n", time_s, barcode_of(seen), range_m, bearing_rad));
}

void MrclamWriter::close() {
  for (Robot& robot : robots_) {
    robot.truth.close();
    robot.odometry.close();
    robot.measurement.close();
  }
}

}  // namespace experiment
