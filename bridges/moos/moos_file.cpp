// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "sim/base/geodesy.hpp"
#include "sim/base/number.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

namespace {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

bool equal_names(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char left, unsigned char right) { return std::tolower(left) == std::tolower(right); });
}

class MoosFileReader {
 public:
  explicit MoosFileReader(const std::string& path) { file_.path = path; }

  MoosFile read(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      ++line_;
      read_line(trimmed(std::string_view(line).substr(0, line.find("//"))));
    }
    if (file_.latitude_deg.has_value() != file_.longitude_deg.has_value())
      errors_.push_back(file_.path + ": needs both 'LatOrigin' and 'LongOrigin', or none");
    if (!errors_.empty()) throw sim::ConfigError(errors_);
    return std::move(file_);
  }

 private:
  void read_line(const std::string& line) {
    const auto equals = line.find('=');
    if (line.starts_with('{')) is_block_ = true;
    if (line.starts_with('}')) is_block_ = false;
    if (is_block_ || equals == line.npos) return;
    const std::string key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
    if (equal_names(key, "ProcessConfig")) is_block_ = line.find('{') != line.npos && line.find('}') == line.npos;
    take(key, value);
  }

  void take(const std::string& key, const std::string& value) {
    const auto number = [&](double low, double high, const std::function<void(double)>& set) {
      const auto read = sim::read_number(value);
      if (read && *read >= low && *read <= high) return set(*read);
      refuse(key, value, "a number from " + sim::number_text(low) + " to " + sim::number_text(high));
    };
    if (equal_names(key, "ServerHost")) {
      file_.host = value;
      file_.host_line = line_;
    } else if (equal_names(key, "ServerPort")) {
      const auto port = sim::exact_number<int>(value);
      if (port && *port >= 1 && *port <= 65535)
        file_.port = *port;
      else
        refuse(key, value, "a whole number from 1 to 65535");
    } else if (equal_names(key, "Community")) {
      file_.community = value;
    } else if (equal_names(key, "LatOrigin")) {
      number(-90, 90, [&](double degrees) { file_.latitude_deg = degrees; });
    } else if (equal_names(key, "LongOrigin")) {
      number(-180, 180, [&](double degrees) { file_.longitude_deg = degrees; });
    } else if (equal_names(key, "MOOSTimeWarp")) {
      number(0.001, 1000, [&](double warp) { file_.time_warp = warp; });
    }
  }

  void refuse(const std::string& key, const std::string& value, const std::string& rule) {
    errors_.push_back(file_.path + ":" + std::to_string(line_) + ": '" + key + "' must be " + rule + ", got '" +
                      sim::shortened(sim::printable(value)) + "'");
  }

  MoosFile file_;
  int line_ = 0;
  bool is_block_ = false;
  std::vector<std::string> errors_;
};

}  // namespace

MoosFile read_moos_text(const std::string& text, const std::string& path) {
  return MoosFileReader(path).read(text);
}

MoosFile read_moos_file(const std::string& name) {
  std::error_code error;
  const std::filesystem::path shipped = std::filesystem::path(sim::shipped_folder()) / "worlds" / name;
  const std::string path =
      !std::filesystem::exists(name, error) && std::filesystem::exists(shipped, error) ? shipped.string() : name;
  try {
    return read_moos_text(sim::whole_file<std::runtime_error>(path, 1), path);
  } catch (const sim::ConfigError&) {
    throw;
  } catch (const std::runtime_error& failure) {
    throw sim::ConfigError({path + ": " + failure.what()});
  }
}

bool is_loopback(const std::string& host) {
  return host == "localhost" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

std::string moos_host(const MoosFile& file, const std::string& peer) {
  if (!peer.empty()) return peer;
  if (is_loopback(file.host)) return file.host;
  const std::string host = sim::shortened(sim::printable(file.host));
  throw sim::ConfigError({file.path + ":" + std::to_string(file.host_line) + ": 'ServerHost' is another machine, '" +
                          host + "'; only the command line allows it: --peer " + host});
}

void check_moos_origin(const MoosFile& file, const std::string& world, double latitude_deg, double longitude_deg) {
  if (!file.latitude_deg) return;
  const double apart_m =
      sim::Geodesy({latitude_deg, longitude_deg, 0}).to_local({*file.latitude_deg, *file.longitude_deg, 0}).norm();
  if (apart_m <= 1) return;
  const auto place = [](double latitude, double longitude) {
    return sim::number_text(latitude) + ", " + sim::number_text(longitude);
  };
  throw sim::ConfigError({file.path + ": LatOrigin and LongOrigin are " +
                          place(*file.latitude_deg, *file.longitude_deg) + ", and 'origin' of world '" + world +
                          "' is " + place(latitude_deg, longitude_deg) + ", " +
                          sim::number_text(sim::rounded_to(apart_m, 3)) + " m away: positions would not agree"});
}

}  // namespace bridges
