// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cross_check/experiments.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>

#include "tests/cross_check/exact.hpp"

namespace cross_check {

namespace {

using std::numbers::pi;
using test::g;

constexpr double degree = pi / 180;

Pose at(const Vector3d& p_W, const Matrix3d& R = Matrix3d::Identity()) {
  Pose X = Pose::Identity();
  X.translation() = p_W;
  X.linear() = R;
  return X;
}

Matrix3d about_y(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vector3d::UnitY()).toRotationMatrix();
}

/// Kinetic energy and that of the weight, J.
double energy_J(const BodyModel& body, const BodyState& state, double gravity_mps2) {
  const Vector3d w_C = state.R_WC.transpose() * state.w_W;
  const double mass = body.solid.mass_kg;
  return 0.5 * mass * state.v_WC_W.squaredNorm() + 0.5 * w_C.dot(body.solid.inertia_kgm2().cwiseProduct(w_C)) +
         mass * gravity_mps2 * state.p_WC.z();
}

double energy_J(const Model& model, const std::vector<BodyState>& states) {
  double sum = 0;
  for (std::size_t i = 0; i < states.size(); ++i) sum += energy_J(model.bodies[i], states[i], model.gravity_mps2);
  return sum;
}

/// Change of the energy over the run, as a share of `scale_J`.
double energy_change(const Model& model, const Trajectory& run, double scale_J) {
  return (energy_J(model, run.states.back()) - energy_J(model, run.states.front())) / scale_J;
}

/// Mean period of a signal: between the first and the last passage of zero upwards.
double mean_period_s(const Trajectory& run, const std::function<double(const std::vector<BodyState>&)>& signal) {
  double first = -1, last = -1, before = signal(run.states.front());
  int passages = 0;
  for (std::size_t i = 1; i < run.states.size(); ++i) {
    const double now = signal(run.states[i]);
    if (before < 0 && now >= 0) {
      last = (static_cast<double>(i) - now / (now - before)) * run.step_s;
      if (passages++ == 0) first = last;
    }
    before = now;
  }
  if (passages < 2) return std::numeric_limits<double>::quiet_NaN();
  return (last - first) / (passages - 1);
}

/// Angle of a body about the y axis, for those that turn about it only.
double pitch_rad(const BodyState& state) {
  return std::atan2(state.R_WC(0, 2), state.R_WC(0, 0));
}

Experiment thrown_stone() {
  const Vector3d v(3, 0, 8);
  const double time = 2;
  Experiment made{.name = "throw",
                  .title = "A stone that is thrown",
                  .text =
                      "A sphere leaves the origin with 3 m/s ahead and 8 m/s upwards, without air. The path is a "
                      "parabola.",
                  .duration_s = time,
                  .quantities = {{"distance after 2 s (m)", v.x() * time},
                                 {"height after 2 s (m)", v.z() * time - g * time * time / 2}}};
  made.model.bodies = {{.solid = sphere(0.1, 1), .v_WC_W = v}};
  made.measure = [](const Trajectory& run) {
    const Vector3d& p = run.states.back()[0].p_WC;
    return std::vector<double>{p.x(), p.z()};
  };
  return made;
}

Experiment tumbling_brick() {
  const Solid solid = box({0.3, 0.2, 0.1}, 6);  // moments of inertia in ascending order
  const Vector3d inertia = solid.inertia_kgm2(), w(0.1, 10, 0.1);
  Experiment made{.name = "tumbling",
                  .title = "A brick that tumbles",
                  .text =
                      "A brick of 0.3 m by 0.2 m by 0.1 m turns with 10 rad/s about its middle axis, and 0.1 rad/s "
                      "about both others, without weight, for 60 s. It flips over again and again. The period is "
                      "an elliptic integral (Landau & Lifshitz, *Mechanics*, section 37); angular momentum, also "
                      "its direction, and energy are constant.",
                  .duration_s = 60,
                  .quantities = {{"period of the flips (s)", tumbling_period_s(inertia, w)},
                                 {"turn of the angular momentum (mrad)", 0},
                                 {"change of the energy, relative", 0}}};
  made.model.gravity_mps2 = 0;
  made.model.bodies = {{.solid = solid, .w_W = w}};
  made.measure = [inertia, model = made.model](const Trajectory& run) {
    const auto momentum = [&](const BodyState& state) -> Vector3d {
      return state.R_WC * inertia.cwiseProduct(state.R_WC.transpose() * state.w_W);
    };
    const Vector3d before = momentum(run.states.front()[0]), after = momentum(run.states.back()[0]);
    const double period =
        mean_period_s(run, [](const auto& states) { return states[0].R_WC.col(1).dot(states[0].w_W); });
    const double turn = std::atan2(before.cross(after).norm(), before.dot(after));
    return std::vector<double>{period, 1000 * turn, energy_change(model, run, energy_J(model, run.states.front()))};
  };
  return made;
}

Experiment heavy_top() {
  const Solid disc = cylinder(0.2, 0.02, 1);
  const double arm = 0.2, tilt = 30 * degree, spin = 60;
  const Vector3d inertia = disc.inertia_kgm2();
  const double across = inertia.x() + arm * arm * disc.mass_kg;
  const double rate = precession_radps(across, inertia.z(), spin, tilt, disc.mass_kg * g * arm);
  const double duration = 10;
  Experiment made{.name = "top",
                  .title = "A heavy top",
                  .text =
                      "A disc of 0.2 m radius on a massless axle of 0.2 m, held at its foot by a ball joint, spins "
                      "with 60 rad/s and is tilted by 30 degrees. It starts with the rate of steady precession, the "
                      "smaller root of $I_1 \\cos\\theta\\,\\Omega^2 - I_3 \\omega_3 \\Omega + m g l = 0$ "
                      "(Goldstein, *Classical Mechanics*, section 5.7), and should keep it and the tilt.",
                  .duration_s = duration,
                  .quantities = {{"rate of precession over 10 s (rad/s)", rate}, {"tilt after 10 s (degrees)", 30}}};
  const Matrix3d R = about_y(tilt);
  const Vector3d axis = R.col(2);
  // The component of the precession along the axis is part of the spin.
  const Vector3d w = spin * axis + rate * (Vector3d::UnitZ() - std::cos(tilt) * axis);
  made.model.bodies = {{.solid = disc, .X_WC = at(arm * axis, R), .w_W = w, .pivot = Pivot{.kind = Pivot::Kind::ball}}};
  made.measure = [duration](const Trajectory& run) {
    double azimuth = 0;
    for (std::size_t i = 1; i < run.states.size(); ++i) {
      const Vector3d before = run.states[i - 1][0].p_WC, now = run.states[i][0].p_WC;
      azimuth += std::atan2(before.x() * now.y() - before.y() * now.x(), before.head<2>().dot(now.head<2>()));
    }
    const Vector3d& p = run.states.back()[0].p_WC;
    return std::vector<double>{azimuth / duration, std::atan2(p.head<2>().norm(), p.z()) / degree};
  };
  return made;
}

Experiment wide_pendulum() {
  const Solid bob = sphere(0.05, 1);
  const double length = 1, amplitude = 120 * degree;
  const double inertia = bob.inertia_kgm2().y() + bob.mass_kg * length * length;
  const double scale = bob.mass_kg * g * length * (1 - std::cos(amplitude));
  Experiment made{
      .name = "pendulum",
      .title = "A pendulum that swings wide",
      .text =
          "A sphere of 0.05 m radius on a massless rod of 1 m, held by a hinge, swings by 120 degrees to "
          "both sides for 30 s. The period is 4 K(sin 60°) over the angular frequency of small swings; "
          "the energy, whose scale is that of the start above the lowest point, is constant.",
      .duration_s = 30,
      .quantities = {{"period (s)", pendulum_period_s(std::sqrt(bob.mass_kg * g * length / inertia), amplitude)},
                     {"change of the energy, relative", 0}}};
  const Vector3d p = length * Vector3d(std::sin(amplitude), 0, -std::cos(amplitude));
  made.model.bodies = {{.solid = bob, .X_WC = at(p), .pivot = Pivot{}}};
  made.measure = [scale, model = made.model](const Trajectory& run) {
    const double period = mean_period_s(run, [](const auto& states) { return states[0].p_WC.x(); });
    return std::vector<double>{period, energy_change(model, run, scale)};
  };
  return made;
}

Experiment double_pendulum() {
  const Solid rod = box({1, 0.05, 0.05}, 1);
  Experiment made{.name = "double_pendulum",
                  .title = "A double pendulum",
                  .text =
                      "Two rods of 1 m and 1 kg, joined by hinges, are released from the horizontal and swing for "
                      "10 s. The motion is chaotic, so only what is conserved is compared: the energy, whose scale "
                      "is that of the start above the lowest point (2 m g times 1 m), and that the hinge between the "
                      "rods stays together.",
                  .duration_s = 10,
                  .quantities = {{"change of the energy, relative", 0}, {"largest gap in the hinge (mm)", 0}}};
  made.model.bodies = {{.solid = rod, .X_WC = at({0.5, 0, 0}), .pivot = Pivot{}},
                       {.solid = rod, .X_WC = at({1.5, 0, 0}), .pivot = Pivot{.parent = 0, .anchor_W = {1, 0, 0}}}};
  made.measure = [model = made.model](const Trajectory& run) {
    double gap = 0;
    for (const auto& states : run.states) {
      const Vector3d end = states[0].p_WC + states[0].R_WC.col(0) / 2;
      const Vector3d begin = states[1].p_WC - states[1].R_WC.col(0) / 2;
      gap = std::max(gap, (end - begin).norm());
    }
    return std::vector<double>{energy_change(model, run, 2 * g), 1000 * gap};
  };
  return made;
}

Experiment torsion_spring() {
  const Solid rod = box({0.5, 0.05, 0.05}, 1);
  const double inertia = rod.inertia_kgm2().y() + rod.mass_kg * 0.25 * 0.25;
  const double omega = 2 * pi, damping = 0.05, start = 0.5, time = 5.1;
  const double omega_d = omega * std::sqrt(1 - damping * damping);
  const double swing = start * std::exp(-damping * omega * time) *
                       (std::cos(omega_d * time) + damping * omega / omega_d * std::sin(omega_d * time));
  Experiment made{.name = "spring",
                  .title = "A spring with a damper",
                  .text =
                      "A rod on a hinge with a torsion spring, 1 Hz without damping, and a damper of 5 % of critical "
                      "damping, is released at 0.5 rad, without weight. In Shoal the torque is an effort of the joint "
                      "computed at the start of each step, as by `joint_servo` with `control: pid`; in MuJoCo it is "
                      "`stiffness` and `damping` of the joint.",
                  .duration_s = time,
                  .quantities = {{"angle after 5.1 s (rad)", swing}, {"period (s)", 2 * pi / omega_d}}};
  made.model.gravity_mps2 = 0;
  made.model.bodies = {{.solid = rod,
                        .X_WC = at(about_y(start) * Vector3d(0.25, 0, 0), about_y(start)),
                        .pivot = Pivot{.stiffness_Nmprad = inertia * omega * omega,
                                       .damping_Nmsprad = 2 * damping * omega * inertia,
                                       .rest_rad = -start}}};
  made.measure = [](const Trajectory& run) {
    const double period = mean_period_s(run, [](const auto& states) { return pitch_rad(states[0]); });
    return std::vector<double>{pitch_rad(run.states.back()[0]), period};
  };
  return made;
}

Experiment block_on_a_slope() {
  const double slope = 20 * degree, friction = 0.5, speed = 2;
  const double distance = speed * speed / (2 * g * (std::sin(slope) + friction * std::cos(slope)));
  const Vector3d size(0.3, 0.3, 0.1);
  Experiment made{.name = "slope",
                  .title = "A block on a slope",
                  .text =
                      "A block is pushed up a slope of 20 degrees with 2 m/s. Its coefficient of friction is 0.5, and "
                      "the tangent of the slope 0.364: it stops after $v^2 / (2 g (\\sin\\alpha + \\mu \\cos\\alpha))$ "
                      "and then stays where it is, from 1 s to 11 s.",
                  .duration_s = 11,
                  .quantities = {{"distance up the slope (m)", distance}, {"creep downhill in 10 s (mm)", 0}}};
  made.model.ground = Ground{.slope_rad = slope, .friction = friction};
  const Matrix3d R = about_y(slope);
  const Vector3d downhill = R.col(0);
  made.model.bodies = {{.solid = box(size, 1), .X_WC = at(R.col(2) * size.z() / 2, R), .v_WC_W = -speed * downhill}};
  made.measure = [downhill](const Trajectory& run) {
    double highest = 0;
    for (const auto& states : run.states) highest = std::max(highest, -downhill.dot(states[0].p_WC));
    const Vector3d crept = run.states.back()[0].p_WC - run.states[run.at(1)][0].p_WC;
    return std::vector<double>{highest, 1000 * downhill.dot(crept)};
  };
  return made;
}

Experiment bouncing_ball() {
  const double radius = 0.1, height = 1, restitution = 0.5;
  const double fall = std::sqrt(2 * height / g);
  Experiment made{
      .name = "bounce",
      .title = "A ball that bounces",
      .text =
          "A ball falls from 1 m with a coefficient of restitution of 0.5: each bounce reaches a quarter "
          "of the height before. Shoal has this coefficient. MuJoCo has none: its contact gets the "
          "damping that gives a spring and damper of the default time constant, 0.02 s, this "
          "restitution (Schwager & Pöschel, *Granular Matter* 9, 2007); the ball dives into the ground "
          "meanwhile, which this page counts as an error of height and time.",
      .duration_s = 1.5,
      .quantities = {{"height of the first bounce (m)", height * std::pow(restitution, 2)},
                     {"height of the second bounce (m)", height * std::pow(restitution, 4)},
                     {"time of the second top (s)", fall * (1 + 2 * restitution + restitution * restitution)}}};
  made.model.ground = Ground{.friction = 0, .restitution = restitution};
  made.model.bodies = {{.solid = sphere(radius, 1), .X_WC = at({0, 0, radius + height})}};
  made.measure = [radius](const Trajectory& run) {
    std::vector<double> tops, times;
    for (std::size_t i = 1; i + 1 < run.states.size(); ++i) {
      // The parabola through three heights, for a top between two steps.
      const double a = run.states[i - 1][0].p_WC.z(), b = run.states[i][0].p_WC.z(), c = run.states[i + 1][0].p_WC.z();
      if (!(a <= b && b > c && b > 1.01 * radius)) continue;
      const double share = (a - c) / (2 * (a - 2 * b + c));
      tops.push_back(b - (a - c) * share / 4 - radius);
      times.push_back((static_cast<double>(i) + share) * run.step_s);
    }
    tops.resize(2, std::numeric_limits<double>::quiet_NaN());
    times.resize(2, std::numeric_limits<double>::quiet_NaN());
    return std::vector<double>{tops[0], tops[1], times[1]};
  };
  return made;
}

Experiment rolling_down() {
  const double slope = 20 * degree, radius = 0.1, time = 2;
  const double slide = g * std::sin(slope) * time * time / 2;
  Experiment made{.name = "rolling",
                  .title = "A sphere and a cylinder that roll down",
                  .text =
                      "A sphere and a cylinder of 0.1 m radius are released on a slope of 20 degrees and roll without "
                      "slipping, with 5/7 and 2/3 of the acceleration of a block without friction.",
                  .duration_s = time,
                  .quantities = {{"distance of the sphere in 2 s (m)", slide * 5 / 7},
                                 {"distance of the cylinder in 2 s (m)", slide * 2 / 3}}};
  made.model.ground = Ground{.slope_rad = slope};
  const Matrix3d R = about_y(slope), on_its_side = Eigen::AngleAxisd(pi / 2, Vector3d::UnitX()).toRotationMatrix();
  const Vector3d p = R.col(2) * radius;
  made.model.bodies = {{.solid = sphere(radius, 1), .X_WC = at(p + Vector3d(0, 1, 0))},
                       {.solid = cylinder(radius, 0.2, 1), .X_WC = at(p - Vector3d(0, 1, 0), R * on_its_side)}};
  made.measure = [downhill = Vector3d(R.col(0))](const Trajectory& run) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < 2; ++i)
      distances.push_back(downhill.dot(run.states.back()[i].p_WC - run.states.front()[i].p_WC));
    return distances;
  };
  return made;
}

Experiment stack_of_boxes() {
  const int count = 5;
  const double edge = 0.2;
  Experiment made{.name = "stack",
                  .title = "A stack of boxes",
                  .text =
                      "Five cubes of 0.2 m and 1 kg stand on each other for 10 s. The height of the center of the "
                      "uppermost is 0.9 m, and none moves.",
                  .duration_s = 10,
                  .quantities = {{"height of the uppermost (m)", edge * (count - 0.5)},
                                 {"largest drift aside (mm)", 0},
                                 {"largest speed in the last second (mm/s)", 0}}};
  made.model.ground = Ground{};
  for (int i = 0; i < count; ++i)
    made.model.bodies.push_back({.solid = box(Vector3d::Constant(edge), 1), .X_WC = at({0, 0, edge * (i + 0.5)})});
  made.measure = [edge](const Trajectory& run) {
    double drift = 0, speed = 0;
    for (const BodyState& state : run.states.back()) drift = std::max(drift, state.p_WC.head<2>().norm());
    for (std::size_t i = run.at(9); i < run.states.size(); ++i)
      for (const BodyState& state : run.states[i]) speed = std::max(speed, state.v_WC_W.norm());
    if (drift > edge / 2) speed = std::numeric_limits<double>::quiet_NaN();  // it fell
    return std::vector<double>{run.states.back().back().p_WC.z(), 1000 * drift, 1000 * speed};
  };
  return made;
}

std::vector<BodyState> states_of(const Engine& engine, const Model& model) {
  std::vector<BodyState> states;
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) states.push_back(engine.state(i));
  return states;
}

long steps_of(const Experiment& experiment, double step_s) {
  return std::lround(experiment.duration_s / step_s);
}

}  // namespace

std::size_t Trajectory::at(double time_s) const {
  const auto index = static_cast<std::size_t>(std::lround(time_s / step_s));
  if (index >= states.size()) throw std::out_of_range("a time after the end of the run");
  return index;
}

std::vector<Experiment> experiments() {
  return {thrown_stone(),   tumbling_brick(),   heavy_top(),     wide_pendulum(), double_pendulum(),
          torsion_spring(), block_on_a_slope(), bouncing_ball(), rolling_down(),  stack_of_boxes()};
}

std::vector<double> run(const Experiment& experiment, Method method, double step_s) {
  const auto engine = make_engine(method, experiment.model, step_s);
  Trajectory trajectory{.step_s = step_s};
  trajectory.states.push_back(states_of(*engine, experiment.model));
  try {
    for (long i = steps_of(experiment, step_s); i > 0; --i) {
      engine->step();
      trajectory.states.push_back(states_of(*engine, experiment.model));
    }
  } catch (const Diverged&) {
    return std::vector<double>(experiment.quantities.size(), std::numeric_limits<double>::quiet_NaN());
  }
  return experiment.measure(trajectory);
}

double time_per_step_s(const Experiment& experiment, Method method, double step_s) {
  const auto now_s = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  double min_s = std::numeric_limits<double>::infinity();
  for (int repetition = 0; repetition < 3; ++repetition) {
    const auto engine = make_engine(method, experiment.model, step_s);
    long done = 0;
    const double start_s = now_s();
    try {
      for (const long steps = steps_of(experiment, step_s); done < steps; ++done) engine->step();
    } catch (const Diverged&) {
      ++done;
    }
    min_s = std::min(min_s, (now_s() - start_s) / static_cast<double>(done));
  }
  return min_s;
}

}  // namespace cross_check
