// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/memory_forecast.hpp"

#include <malloc.h>
#include <spdlog/fmt/fmt.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace sim {

namespace {

/// Returns the value of a file that holds one number, such as those of a control group; none: `max`, or no such file.
std::optional<std::size_t> number_in(const std::string& path) {
  std::ifstream in(path);
  std::size_t value = 0;
  if (in >> value) return value;
  return {};
}

std::optional<std::size_t> left_in_system() {
  std::ifstream in("/proc/meminfo");
  std::string key, unit;
  for (std::size_t kiB = 0; in >> key >> kiB; std::getline(in, unit))
    if (key == "MemAvailable:") return kiB * 1024;
  return {};
}

std::size_t rest(std::size_t limit, std::size_t used) {
  return limit > used ? limit - used : 0;
}

std::optional<std::size_t> left_in_control_group() {
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("0::")) continue;
    const std::string folder = "/sys/fs/cgroup" + line.substr(3);
    const auto limit = number_in(folder + "/memory.max"), used = number_in(folder + "/memory.current");
    if (limit && used) return rest(*limit, *used);
  }
  return {};
}

std::optional<std::size_t> left_in_address_space() {
  rlimit limit{};
  std::ifstream in("/proc/self/statm");
  std::size_t pages = 0;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !(in >> pages)) return {};
  return rest(limit.rlim_cur, pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

std::optional<std::size_t> allocated_bytes() {
  const struct mallinfo2 info = mallinfo2();
  // A sanitizer's allocator does not count here.
  const std::size_t bytes = info.uordblks + info.hblkhd;
  return bytes > 0 ? std::optional(bytes) : std::nullopt;
}

std::optional<std::size_t> available_bytes() {
  auto available = left_in_system();
  for (const auto& other : {left_in_control_group(), left_in_address_space()})
    if (other) available = std::min(available.value_or(*other), *other);
  return available;
}

MemoryForecast::MemoryForecast(std::size_t vehicles, std::optional<std::size_t> allocated,
                               std::optional<std::size_t> available)
    : vehicles_(vehicles),
      start_bytes_(allocated.value_or(0)),
      available_bytes_(available.value_or(0)),
      known_(allocated && available) {}

std::string MemoryForecast::problem(std::size_t built, std::size_t allocated) {
  next_ *= 2;
  // The scene for rays, messages and buffers take up to half as much again in the first steps.
  constexpr double later = 1.5;
  const double each = later * static_cast<double>(rest(allocated, start_bytes_)) / static_cast<double>(built);
  const double all = each * static_cast<double>(vehicles_);
  if (all <= static_cast<double>(available_bytes_)) return {};
  return fmt::format("{} vehicles would need about {} of memory, {} each; {} are available", vehicles_, size_text(all),
                     size_text(each), size_text(static_cast<double>(available_bytes_)));
}

std::string size_text(double bytes) {
  const char* const units[] = {"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < std::size(units)) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", bytes, unit > 0 && bytes < 9.95 ? 1 : 0, units[unit]);
}

}  // namespace sim
