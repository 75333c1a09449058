// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cross_check/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <sstream>
#include <string>

namespace cross_check {

namespace {

constexpr double steps_s[] = {0.001, 0.005};
constexpr Method all_methods[] = {Method::shoal, Method::shoal_quick, Method::mujoco_euler, Method::mujoco_implicit,
                                  Method::mujoco_rk4};
constexpr double rounding = 1e-9;  ///< errors below it are not told apart

std::string value_text(double value) {
  if (std::isnan(value)) return "none";
  return std::abs(value) < rounding ? "0" : fmt::format("{:.6g}", value);
}

std::string error_text(double error) {
  if (std::isnan(error)) return "none";
  return std::abs(error) < rounding ? "< 1e-9" : fmt::format("{:.2g}", error);
}

/// A number in CSV; empty: none.
std::string csv_number(double value, int digits) {
  if (std::isnan(value)) return "";
  return std::abs(value) < rounding ? "0" : fmt::format("{:.{}g}", value, digits);
}

std::string csv_text(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

/// The text in lines of at most 120 characters.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t width = 0;
  for (std::string word; words >> word;) {
    const bool fits = width + 1 + word.size() <= 120;
    if (width > 0) lines += fits ? ' ' : '\n';
    width = (width > 0 && fits ? width + 1 : 0) + word.size();
    lines += word;
  }
  return lines;
}

const Row* row_of(const Measured& measured, Method method, double step_s) {
  const auto found = std::find_if(measured.rows.begin(), measured.rows.end(),
                                  [&](const Row& row) { return row.method == method && row.step_s == step_s; });
  return found == measured.rows.end() ? nullptr : &*found;
}

double error_of(const Measured& measured, const Row& row, std::size_t quantity) {
  return row.values[quantity] - measured.experiment.quantities[quantity].exact;
}

/// Size of an error, for comparison: those at the level of rounding are equal, none is worst.
double size_of(double error) {
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(std::abs(error), rounding);
}

/// Whether an error is smaller by more than the 2 % that a table shows.
bool is_less(double size, double other) {
  return size < 0.98 * other;
}

/// Errors of one quantity by all methods, and who has the least.
void write_errors(std::ostream& out, const Measured& measured, std::size_t quantity, double step_s) {
  double min = std::numeric_limits<double>::infinity();
  for (const Row& row : measured.rows)
    if (row.step_s == step_s) min = std::min(min, size_of(error_of(measured, row, quantity)));
  const Quantity& of = measured.experiment.quantities[quantity];
  out << fmt::format("| {} | {} | {} | {:g} |", measured.experiment.name, of.name, value_text(of.exact), 1000 * step_s);
  for (const Method method : all_methods) {
    const Row* row = row_of(measured, method, step_s);
    if (!row) {
      out << " - |";
      continue;
    }
    const double error = error_of(measured, *row, quantity);
    const char* mark = is_less(min, size_of(error)) ? "" : "**";
    out << ' ' << mark << error_text(error) << mark << " |";
  }
  out << '\n';
}

void write_summary(std::ostream& out, const std::vector<Measured>& all) {
  out << "| experiment | quantity | closed form | step ms |";
  for (const Method method : all_methods) out << ' ' << name_of(method) << " |";
  out << "\n|---|---|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const Measured& measured : all)
    for (std::size_t quantity = 0; quantity < measured.experiment.quantities.size(); ++quantity)
      for (const double step_s : steps_s) write_errors(out, measured, quantity, step_s);
}

/// How often each of two methods has the smaller error.
void write_score(std::ostream& out, const std::vector<Measured>& all, Method other) {
  for (const double step_s : steps_s) {
    int smaller = 0, equal = 0, larger = 0;
    for (const Measured& measured : all) {
      const Row* ours = row_of(measured, Method::shoal, step_s);
      const Row* theirs = row_of(measured, other, step_s);
      if (!ours || !theirs) continue;
      for (std::size_t i = 0; i < measured.experiment.quantities.size(); ++i) {
        const double a = size_of(error_of(measured, *ours, i)), b = size_of(error_of(measured, *theirs, i));
        ++(is_less(a, b) ? smaller : is_less(b, a) ? larger : equal);
      }
    }
    out << fmt::format("| {} | {:g} | {} | {} | {} |\n", name_of(other), 1000 * step_s, smaller, equal, larger);
  }
}

void write_cost(std::ostream& out, const std::vector<Measured>& all) {
  out << "| experiment |";
  for (const Method method : all_methods) out << ' ' << name_of(method) << " |";
  out << "\n|---|---:|---:|---:|---:|---:|\n";
  for (const Measured& measured : all) {
    out << "| " << measured.experiment.name << " |";
    for (const Method method : all_methods) {
      const Row* row = row_of(measured, method, steps_s[0]);
      out << (row ? fmt::format(" {:.2f} |", 1e6 * row->cpu_s) : " - |");
    }
    out << '\n';
  }
}

void write_section(std::ostream& out, const Experiment& experiment) {
  out << fmt::format("\n## {}\n\n{}\n\n    build/release/bin/cross_check {}\n", experiment.title,
                     wrapped(experiment.text), experiment.name);
}

constexpr const char* introduction = R"(# Cross-check by another engine

Written by `cross_check --page docs/models/cross_check.md`.

Ten experiments with rigid bodies, by Shoal, by MuJoCo {} and by closed form, with steps of 1 ms and 5 ms. Both
engines get the same bodies, joints and initial states, from one description in `tests/cross_check`.
[fidelity.md](fidelity.md) compares marine vehicles with published trajectories.

- **Shoal** is `PhysicsWorld` with the defaults of a world; [rigid_bodies.md](rigid_bodies.md) describes its step.
  "Quick solver" is `physics: {{solver: quick}}`, the iterative solver of ODE, which is the default only for large
  groups of bodies.
- **MuJoCo** has its defaults except for the integrator: `Euler` (its default), `implicit` or `RK4`. Newer versions
  than that of Debian 12, and other settings of solver and contacts, can be better.
- Errors are differences from the closed form; those below 1e-9 are rounding. The least are bold. `none`: the engine
  diverged, or there was nothing to measure.
- These are small experiments that have an exact answer. They do not show how an engine deals with many bodies.

```sh
apt-get install libmujoco-dev    # optional: without it the rows of MuJoCo are left out
cmake --preset release
ninja -C build/release cross_check
build/release/bin/cross_check          # all experiments
build/release/bin/cross_check slope    # one
```

A build that has not found MuJoCo says so when CMake runs, and its tests skip the rows of MuJoCo. The tests
`CrossCheck` hold Shoal to bars in these experiments.

[runs.csv](cross_check/runs.csv) has the values of every run: `experiment`, `step_ms`, `engine`, `us_per_step` (CPU time
of a step), `closed_form`, `value`, `error` and `quantity`; an empty value is `none`.

## Errors

)";

constexpr const char* conclusions = R"(
In how many of these quantities Shoal with its defaults has a smaller, an equal (within 2 %) and a larger error:

| than | step ms | smaller | equal | larger |
|---|---:|---:|---:|---:|
)";

constexpr const char* where_better = R"(
### Where MuJoCo is better

- **Joints.** MuJoCo computes in joint coordinates: joints cannot come apart, and with any of its integrators a
  pendulum has a period that is hundreds of times more accurate. In Shoal a joint is a constraint between two bodies
  (ODE), which drifts and is corrected: at 5 ms the hinge of the double pendulum gaps by millimeters, and the wide
  pendulum loses 3 % of its energy in 30 s, or 29 % with the quick solver. Robots with fast joints
  need a step of 1 ms.
- **RK4.** Where nothing touches, MuJoCo's Runge-Kutta integrator is exact to many digits, at four times the cost of
  its Euler step. Shoal has no step of that order.
- **A fast top on a joint.** Both engines' steps of first order lose it, Shoal's by sinking; only RK4 holds it.
- **Stacks.** ODE's exact solver gives up on many steps of stacks of three or more boxes ("LCP internal error", in the
  log at `--log-level debug`); Shoal then takes the step back and makes it with the quick solver, at up to ten times the
  time of a step. Higher stacks are pressed by millimeters.

### Where Shoal is better

- **Free bodies**, by [Shoal's own step](rigid_bodies.md). A stone follows its parabola, and a tumbling body keeps its
  energy, its angular momentum and the direction of it, all to rounding, at half the cost of MuJoCo's Euler step. With
  MuJoCo's Euler and implicit integrators a tumbling body gains or loses a fifth of its energy or more within a minute
  at 1 ms.
- **Rest.** In Shoal a block stays on a slope. In MuJoCo friction is soft by default, and the block creeps by almost
  2 mm/s. Other settings mend it: with `impratio='10'` it creeps by 1.8 mm in 10 s, with `cone='elliptic'` and
  `noslip_iterations='10'` by 0.002 mm, at 1.1 and 1.4 times the cost.
- **Restitution** is a coefficient in Shoal, and hardly depends on the step. In MuJoCo it is a spring and a damper
  that the step must resolve.

### Where neither is

Both have a first-order error in contacts: bodies that slide, roll or bounce are wrong by about the distance of half a
step; MuJoCo's RK4 reduces it where the contact itself does not change.

## Cost

CPU time of a step at 1 ms in microseconds, the least of three runs, on machine A of
[performance.md](../develop/performance.md), which is shared. It is that of the physics alone, without devices and
messages. Timings differ from run to run; no test depends on them.

)";

}  // namespace

std::vector<Measured> measure(const std::vector<Experiment>& chosen) {
  std::vector<Measured> all;
  for (const Experiment& experiment : chosen) {
    Measured measured{experiment, {}};
    for (const double step_s : steps_s)
      for (const Method method : methods(experiment.model))
        measured.rows.push_back(
            {method, step_s, run(experiment, method, step_s), time_per_step_s(experiment, method, step_s)});
    all.push_back(std::move(measured));
  }
  return all;
}

void write_tables(std::ostream& out, const std::vector<Measured>& all) {
  for (const Measured& measured : all) {
    const Experiment& experiment = measured.experiment;
    write_section(out, experiment);
    out << "\n| step ms | engine |";
    for (const Quantity& quantity : experiment.quantities) out << ' ' << quantity.name << " | error |";
    out << " microseconds per step |\n|---:|---|";
    for (std::size_t i = 0; i < experiment.quantities.size(); ++i) out << "---:|---:|";
    out << "---:|\n| | closed form |";
    for (const Quantity& quantity : experiment.quantities) out << ' ' << value_text(quantity.exact) << " | |";
    out << " |\n";
    for (const Row& row : measured.rows) {
      out << fmt::format("| {:g} | {} |", 1000 * row.step_s, name_of(row.method));
      for (std::size_t i = 0; i < row.values.size(); ++i)
        out << fmt::format(" {} | {} |", value_text(row.values[i]), error_text(error_of(measured, row, i)));
      out << fmt::format(" {:.2f} |\n", 1e6 * row.cpu_s);
    }
  }
}

void write_page(std::ostream& out, const std::vector<Measured>& all) {
  out << fmt::format(introduction, mujoco_version());
  write_summary(out, all);
  out << conclusions;
  for (const Method other : {Method::mujoco_euler, Method::mujoco_implicit, Method::mujoco_rk4})
    write_score(out, all, other);
  out << where_better;
  write_cost(out, all);
  for (const Measured& measured : all) write_section(out, measured.experiment);
}

void write_csv(std::ostream& out, const std::vector<Measured>& all) {
  out << "experiment,step_ms,engine,us_per_step,closed_form,value,error,quantity\n";
  for (const Measured& measured : all)
    for (const Row& row : measured.rows)
      for (std::size_t i = 0; i < row.values.size(); ++i) {
        const Quantity& quantity = measured.experiment.quantities[i];
        out << fmt::format("{},{:g},{},{:.2f},{},{},{},{}\n", measured.experiment.name, 1000 * row.step_s,
                           csv_text(name_of(row.method)), 1e6 * row.cpu_s, csv_number(quantity.exact, 6),
                           csv_number(row.values[i], 6), csv_number(error_of(measured, row, i), 2),
                           csv_text(quantity.name));
      }
}

}  // namespace cross_check
