// SPDX-License-Identifier: BSD-3-Clause
#include "devices/common/param_checks.hpp"

#include <spdlog/fmt/fmt.h>

namespace devices {

namespace {

constexpr double max_rays = 1e6;

}  // namespace

void check_rays(sim::ParamReader& in, std::span<const RayFactor> factors) {
  double rays = 1;
  std::string keys, counts;
  const char* last_given = nullptr;
  for (const RayFactor& factor : factors) {
    const std::string between = keys.empty() ? "" : " x ";
    rays *= factor.count;
    keys += between + "'" + factor.key + "'";
    counts += between + fmt::format("{:.0f}", factor.count);
    if (in.has(factor.key.c_str())) last_given = factor.key.c_str();
  }
  if (rays <= max_rays) return;
  const std::string text =
      fmt::format("{} must be at most {:.0f} rays in a sample, got {} = {:.0f}", keys, max_rays, counts, rays);
  // At the key given last, the one most likely to be changed; else the defaults alone are too many.
  last_given ? in.error(last_given, text) : in.error(text);
}

double rate_hz_of(const sim::ParamReader& in, double default_rate_hz) {
  double rate_hz = default_rate_hz;
  if (in.node() == nullptr) return rate_hz;
  sim::Diagnostics reported_elsewhere;
  sim::ParamReader again(*in.node(), in.who(), reported_elsewhere);
  again.read_or_word("rate_hz", rate_hz, sim::between(1e-6, 1e6), {"every_step"}, "");
  return rate_hz;
}

}  // namespace devices
