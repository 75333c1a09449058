// SPDX-License-Identifier: BSD-3-Clause
// Speeds of the ERS-7 model with the walk "Fast Forward" of rUNSWift, beside those that were measured on the robot.
//   real_walk_bench [NAME=VALUE...] [fit=CANDIDATES] [seed=N] [turns=1]
// Names: friction, effort_Nm, gain_per_s, speed_factor, play_rad, flap_factor; unset ones are those of
// vehicles/ers7.yaml.  `fit` searches those that are not given by CMA-ES on strides 2, 5 and 8 cm.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiment/optimize/cma_es.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "verification/motions/real_walk.hpp"

namespace {

using verification::DogParameters;
using verification::RealWalk;

/// Parameter of the fit with its range; gains, torques and speeds by their logarithm.
struct Fitted {
  const char* name;
  double low, start, high;
  std::optional<double> DogParameters::*place;
  double at(double share) const { return low * std::pow(high / low, share); }
  double share() const { return std::log(start / low) / std::log(high / low); }
};
constexpr Fitted fitted[] = {{"friction", 0.2, 0.6, 1.5, &DogParameters::friction},
                             {"effort_Nm", 0.5, 1.2, 6, &DogParameters::effort_Nm},
                             {"gain_per_s", 10, 40, 125, &DogParameters::gain_per_s},
                             {"speed_factor", 0.7, 1, 3, &DogParameters::speed_factor},
                             {"play_rad", 0.002, 0.01, 0.05, &DogParameters::play_rad},
                             {"flap_factor", 0.2, 0.7, 1, &DogParameters::flap_factor}};

const motion::WalkOptions options{.warm_up_s = 1.5, .measured_s = 4};

void print(const char* what, std::span<const RealWalk> walks, std::span<const double> simulated) {
  std::printf("%10s %10s %10s %8s\n", what, "real", "model", "error");
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const bool turns = walks[i].step.turn_rad != 0;
    const double unit = turns ? 180 / std::numbers::pi : 1000;
    std::printf("%10.1f %10.1f %10.1f %7.1f%%%s\n",
                turns ? walks[i].step.turn_rad * unit : walks[i].step.forward_m * 100, walks[i].measured * unit,
                simulated[i] * unit, 100 * (simulated[i] / walks[i].measured - 1), walks[i].is_fitted ? " fitted" : "");
  }
  std::printf("rms of the relative error: %.1f %%\n", 100 * verification::relative_rms(walks, simulated, false));
}

DogParameters fit(const sim::WorldConfig& world, DogParameters parameters, int candidates, std::uint64_t seed) {
  std::vector<RealWalk> walks = verification::fast_forward_strides();
  std::erase_if(walks, [](const RealWalk& walk) { return !walk.is_fitted; });
  std::vector<Fitted> free;
  for (const Fitted& one : fitted)
    if (!(parameters.*one.place)) free.push_back(one);
  experiment::Point start;
  for (const Fitted& one : free) start.push_back(one.share());
  experiment::CmaEs search(start, {.population = 8, .sigma = 0.25, .seed = seed});
  double best = 1e9;
  for (int tried = 0; tried < candidates; tried += 8) {
    std::vector<double> values;
    for (const experiment::Point& point : search.propose()) {
      DogParameters candidate = parameters;
      for (std::size_t i = 0; i < free.size(); ++i) candidate.*free[i].place = free[i].at(point[i]);
      const auto simulated = verification::simulated_speeds(verification::with_parameters(world, "dog", candidate),
                                                            "dog", walks, options, 0);
      values.push_back(-verification::relative_rms(walks, simulated, false));
      if (-values.back() >= best) continue;
      best = -values.back();
      parameters = candidate;
      std::printf("after %d candidates: rms of the three %.2f %%:", tried, 100 * best);
      for (const Fitted& one : free) std::printf(" %s %.4g", one.name, *(candidate.*one.place));
      std::printf("\n");
      std::fflush(stdout);
    }
    search.learn(values);
  }
  return parameters;
}

}  // namespace

int main(int argc, char** argv) {
  DogParameters parameters;
  int candidates = 0, seed = 1;
  bool turns = false;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i], name = text.substr(0, text.find('='));
    const double value = std::atof(text.substr(std::min(text.size(), name.size() + 1)).c_str());
    bool known = true;
    if (name == "fit")
      candidates = static_cast<int>(value);
    else if (name == "seed")
      seed = static_cast<int>(value);
    else if (name == "turns")
      turns = value != 0;
    else
      known = false;
    for (const Fitted& one : fitted)
      if (name == one.name) parameters.*one.place = value, known = true;
    if (known) continue;
    std::fprintf(stderr,
                 "usage: real_walk_bench [friction|effort_Nm|gain_per_s|speed_factor|play_rad|flap_factor=VALUE]... "
                 "[fit=N] [seed=N] "
                 "[turns=1]\n");
    return 2;
  }
  const sim::WorldConfig world = sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
  if (candidates > 0) parameters = fit(world, parameters, candidates, static_cast<std::uint64_t>(seed));
  const sim::WorldConfig model = verification::with_parameters(world, "dog", parameters);
  const auto strides = verification::fast_forward_strides();
  print("stride cm", strides, verification::simulated_speeds(model, "dog", strides, options, 0));
  if (!turns) return 0;
  const auto turning = verification::fast_forward_turns();
  print("turn deg", turning, verification::simulated_speeds(model, "dog", turning, options, 0));
}
