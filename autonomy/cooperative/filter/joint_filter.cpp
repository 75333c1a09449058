// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/filter/joint_filter.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "autonomy/filters/chi_square.hpp"

namespace navigation {

namespace {

constexpr int max_refused_fixes = 5;  ///< in a row
constexpr double min_seen_m = 0.1;    ///< least distance at which a bearing has its error

double square(double x) {
  return x * x;
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

Vector2 left_of(const Vector2& v) {
  return {-v.y(), v.x()};
}

Vector2 turned(const Vector2& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace

StateLayout layout_of(const DeviceErrors& errors) {
  StateLayout layout;
  const auto place = [&](bool exists, int& index, int count = 1) {
    if (!exists) return;
    index = layout.size;
    layout.size += count;
  };
  place(errors.heading_bias_rad > 0 || errors.heading_walk_radprts > 0, layout.heading_bias);
  place(errors.slow_heading_rad > 0, layout.slow_heading);
  place(errors.speed_scale > 0, layout.speed_scale);
  place(errors.clock_s > 0 || errors.clock_drift > 0 || errors.clock_walk_srts > 0, layout.clock);
  place(errors.clock_drift > 0, layout.drift);
  place(errors.slow_fix_m > 0, layout.slow_fix, 2);
  return layout;
}

int JointFilter::add_part(const Part& part) {
  const int n = size();
  Part added = part;
  added.offset = n;
  x_.conservativeResize(n + part.layout.size);
  x_.tail(part.layout.size).setZero();
  P_.conservativeResize(n + part.layout.size, n + part.layout.size);
  P_.bottomRows(part.layout.size).setZero();
  P_.rightCols(part.layout.size).setZero();
  // Numbers of parts stay valid when others are removed, so free ones are used again.
  const auto free = std::find_if(parts_.begin(), parts_.end(), [](const Part& each) { return !each.in_use; });
  if (free != parts_.end()) {
    *free = added;
    return static_cast<int>(free - parts_.begin());
  }
  parts_.push_back(added);
  return static_cast<int>(parts_.size()) - 1;
}

int JointFilter::add(const DeviceErrors& errors, Time time, const Vector2& p_W, double std_m) {
  Part part;
  part.layout = layout_of(errors);
  part.time = time;
  part.errors = errors;
  const int number = add_part(part);
  const int o = at(number).offset;
  const StateLayout& layout = at(number).layout;
  x_.segment<2>(o) = p_W;
  const auto set = [&](int index, double deviation) {
    if (index >= 0) P_(o + index, o + index) = square(deviation);
  };
  set(0, std_m);
  set(1, std_m);
  set(layout.heading_bias, errors.heading_bias_rad);
  set(layout.slow_heading, errors.slow_heading_rad);
  set(layout.speed_scale, errors.speed_scale);
  // The clock is estimated as a length, the error that it makes of a range.
  set(layout.clock, sound_speed_mps_ * errors.clock_s);
  set(layout.drift, sound_speed_mps_ * errors.clock_drift);
  set(layout.slow_fix, errors.slow_fix_m);
  if (layout.slow_fix >= 0) set(layout.slow_fix + 1, errors.slow_fix_m);
  return number;
}

int JointFilter::add(const Position& position) {
  const int number = add_part({});
  const int o = at(number).offset;
  x_.segment<2>(o) = position.p_W;
  P_.block<2, 2>(o, o) = position.P;
  return number;
}

int JointFilter::copy(int part) {
  // A copy is a past state, which never moves again. Ranges depend on its position and clock only.
  Part copied;
  copied.time = at(part).time;
  const int from_clock = at(part).layout.clock;
  if (from_clock >= 0) {
    copied.layout.clock = 2;
    copied.layout.size = 3;
  }
  const int from = at(part).offset;
  const int number = add_part(copied);
  const int to = at(number).offset;
  for (int i = 0; i < copied.layout.size; ++i) {
    const int source = from + (i < 2 ? i : from_clock);
    x_[to + i] = x_[source];
    // At this moment copy and source are the same random variable: equal variances and correlation 1.
    P_.row(to + i) = P_.row(source);
    P_.col(to + i) = P_.col(source);
    P_(to + i, to + i) = P_(source, source);
  }
  return number;
}

JointFilter JointFilter::joined_with(const JointFilter& other) const {
  JointFilter joined = *this;
  for (const Part& part : other.parts_) joined.add_part(part);
  joined.x_.tail(other.size()) = other.x_;
  joined.P_.bottomRightCorner(other.size(), other.size()) = other.P_;
  return joined;
}

void JointFilter::remove(int part) {
  const int o = at(part).offset;
  const int size_of_part = at(part).layout.size;
  const int rest = size() - o - size_of_part;
  // eval(): source and target overlap.
  x_.segment(o, rest) = x_.tail(rest).eval();
  P_.middleRows(o, rest) = P_.bottomRows(rest).eval();
  P_.middleCols(o, rest) = P_.rightCols(rest).eval();
  const int n = size() - size_of_part;
  x_.conservativeResize(n);
  P_.conservativeResize(n, n);
  at(part).in_use = false;
  for (Part& each : parts_)
    if (each.in_use && each.offset > o) each.offset -= size_of_part;
}

double JointFilter::heading_error(const Part& part) const {
  double error_rad = 0;
  for (const int index : {part.layout.heading_bias, part.layout.slow_heading})
    if (index >= 0) error_rad += x_[part.offset + index];
  return error_rad;
}

Vector2 JointFilter::corrected(const Part& part, const Vector2& v_W) const {
  const double scale = part.layout.speed_scale >= 0 ? x_[part.offset + part.layout.speed_scale] : 0;
  return (1 + scale) * turned(v_W, heading_error(part));
}

JointFilter::Step JointFilter::step_of(const Part& part, Time time, const Vector2& v_W) const {
  Step step;
  step.dt_s = seconds(time - part.time);
  step.slow_heading_kept = std::exp(-step.dt_s / part.errors.slow_heading_time_s);
  step.slow_fix_kept = std::exp(-step.dt_s / part.errors.slow_fix_time_s);
  step.moved_W = corrected(part, v_W) * step.dt_s;
  step.per_scale_W = turned(v_W, heading_error(part)) * step.dt_s;
  step.per_heading_W = left_of(step.moved_W);
  return step;
}

template <class Line>
void JointFilter::apply(const Part& part, const Step& step, const Line& line) {
  const StateLayout& layout = part.layout;
  const int o = part.offset;
  for (int i = 0; i < 2; ++i) {
    if (layout.heading_bias >= 0) line(o + i) += step.per_heading_W[i] * line(o + layout.heading_bias);
    if (layout.slow_heading >= 0) line(o + i) += step.per_heading_W[i] * line(o + layout.slow_heading);
    if (layout.speed_scale >= 0) line(o + i) += step.per_scale_W[i] * line(o + layout.speed_scale);
  }
  // The clock is a length, and so is its drift in a second.
  if (layout.drift >= 0) line(o + layout.clock) += step.dt_s * line(o + layout.drift);
  if (layout.slow_heading >= 0) line(o + layout.slow_heading) *= step.slow_heading_kept;
  for (int i = 0; i < 2 && layout.slow_fix >= 0; ++i) line(o + layout.slow_fix + i) *= step.slow_fix_kept;
}

void JointFilter::move(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) {
  Part& part = at(vehicle);
  if (time <= part.time) return;
  const Step step = step_of(part, time, v_W);
  const StateLayout& layout = part.layout;
  const DeviceErrors& errors = part.errors;
  const int o = part.offset;
  const Matrix2 turn = Eigen::Rotation2Dd(heading_error(part)).toRotationMatrix();
  part.time = time;
  part.v_W = v_W;
  // State.
  x_.segment<2>(o) += step.moved_W;
  if (layout.drift >= 0) x_[o + layout.clock] += x_[o + layout.drift] * step.dt_s;
  if (layout.slow_heading >= 0) x_[o + layout.slow_heading] *= step.slow_heading_kept;
  if (layout.slow_fix >= 0) x_.segment<2>(o + layout.slow_fix) *= step.slow_fix_kept;
  // Covariance F P F'.
  if (layout.size > 2) {
    apply(part, step, [this](int i) { return P_.row(i); });
    apply(part, step, [this](int i) { return P_.col(i); });
  }
  // Noise.
  P_.block<2, 2>(o, o) += turn * q * turn.transpose() * step.dt_s;
  const auto grow = [&](int index, double variance) {
    if (index >= 0) P_(o + index, o + index) += variance;
  };
  grow(layout.heading_bias, square(errors.heading_walk_radprts) * step.dt_s);
  grow(layout.slow_heading, square(errors.slow_heading_rad) * (1 - square(step.slow_heading_kept)));
  grow(layout.clock, square(sound_speed_mps_ * errors.clock_walk_srts) * step.dt_s);
  for (int i = 0; i < 2 && layout.slow_fix >= 0; ++i)
    grow(layout.slow_fix + i, square(errors.slow_fix_m) * (1 - square(step.slow_fix_kept)));
}

Eigen::MatrixXd JointFilter::jacobian(int vehicle, Time time, const Vector2& v_W) const {
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(size(), size());
  const Part& part = at(vehicle);
  if (time > part.time) apply(part, step_of(part, time, v_W), [&F](int i) { return F.row(i); });
  return F;
}

void JointFilter::move_linear(int part, const Matrix2& F, const Vector2& offset, const Matrix2& Q) {
  const int o = at(part).offset;
  x_.segment<2>(o) = (F * x_.segment<2>(o) + offset).eval();
  P_.middleRows<2>(o) = (F * P_.middleRows<2>(o)).eval();
  P_.middleCols<2>(o) = (P_.middleCols<2>(o) * F.transpose()).eval();
  P_.block<2, 2>(o, o) += Q;
  symmetrize();
}

JointFilter::Outcome JointFilter::fix(int vehicle, const Vector2& p_W, double std_m, Eigen::MatrixXd* kept) {
  Part& part = at(vehicle);
  const int o = part.offset;
  const int slow = part.layout.slow_fix;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, size());
  for (int i = 0; i < 2; ++i) {
    H(i, o + i) = 1;
    if (slow >= 0) H(i, o + slow + i) = 1;
  }
  const Vector2 innovation = p_W - H * x_;
  const Matrix2 R = square(std_m) * Matrix2::Identity();
  if (gate_ > 0) {
    const Matrix2 S = H * P_ * H.transpose() + R;
    if (!(innovation.dot(S.inverse() * innovation) <= autonomy::chi_square_999_2)) {
      // Several refusals in a row mean that the filter is wrong, not the receiver. Its variance grows by the squared
      // innovation, and the fix is used.
      if (++part.refused_fixes < max_refused_fixes || !innovation.allFinite()) return Outcome::refused;
      P_.block<2, 2>(o, o) += innovation.squaredNorm() * Matrix2::Identity();
    }
    part.refused_fixes = 0;
  }
  const Eigen::MatrixXd kept_here = update(H, innovation, R);
  if (kept != nullptr) *kept = kept_here;
  return Outcome::used;
}

JointFilter::RangeRow JointFilter::range_row(int own, const Position& other, double dz_m) const {
  const Part& part = at(own);
  const Vector2 d_W = position(own) - other.p_W;
  // At the same place the direction is undefined.
  const double distance_m = std::max(std::hypot(d_W.norm(), dz_m), 0.1);
  RangeRow row;
  row.u = d_W / distance_m;
  row.predicted_m = distance_m;
  row.H = Eigen::VectorXd::Zero(size());
  row.H.segment<2>(part.offset) = row.u;
  if (part.layout.clock >= 0) {
    row.H[part.offset + part.layout.clock] = 1;
    row.predicted_m += x_[part.offset + part.layout.clock];
  }
  // Second-order term of the range: for an error s across the line to the sender the mean of the range is off by s^2
  // / 2r.
  const Matrix2 P = covariance(own) + other.P;
  const double sideways_m2 = std::max(0.0, P.trace() - row.u.dot(P * row.u));
  row.bend_variance_m2 = 3 * square(sideways_m2 / (2 * std::max(distance_m, 1.0)));
  return row;
}

JointFilter::RangeRow JointFilter::range_row(int own, int other, double dz_m) const {
  RangeRow row = range_row(own, Position{position(other), Matrix2::Zero()}, dz_m);
  const Part& part = at(other);
  row.H.segment<2>(part.offset) -= row.u;
  if (part.layout.clock >= 0) {
    row.H[part.offset + part.layout.clock] -= 1;
    row.predicted_m -= x_[part.offset + part.layout.clock];
  }
  const Matrix2 across = P_.block<2, 2>(at(own).offset, part.offset);
  const Matrix2 P = covariance(own) + covariance(other) - across - across.transpose();
  const double sideways_m2 = std::max(0.0, P.trace() - row.u.dot(P * row.u));
  const double distance_m = std::hypot((position(own) - position(other)).norm(), dz_m);
  row.bend_variance_m2 = 3 * square(sideways_m2 / (2 * std::max(distance_m, 1.0)));
  return row;
}

JointFilter::Outcome JointFilter::use_range(const RangeRow& row, double range_m, double variance_m2) {
  const double innovation_m = range_m - row.predicted_m;
  if (!std::isfinite(innovation_m)) return Outcome::refused;
  const double R = variance_m2 + row.bend_variance_m2;
  if (!within_gate(innovation_m, row.H.dot(P_ * row.H) + R)) return Outcome::refused;
  update(row.H, innovation_m, R);
  return Outcome::used;
}

JointFilter::Outcome JointFilter::range(int own, int other, double dz_m, double range_m, double std_m) {
  return use_range(range_row(own, other, dz_m), range_m, square(std_m));
}

JointFilter::Outcome JointFilter::range(int own, const Position& other, double dz_m, double range_m, double std_m,
                                        double more_variance_m2) {
  const RangeRow row = range_row(own, other, dz_m);
  return use_range(row, range_m, square(std_m) + row.u.dot(other.P * row.u) + more_variance_m2);
}

Matrix2 JointFilter::bend_of(const Vector2& d_W, const Matrix2& P) {
  const double distance_m = std::max(d_W.norm(), 0.1);
  const Vector2 u = d_W / distance_m;
  const double along_m2 = std::max(0.0, u.dot(P * u));
  const double sideways_m2 = std::max(0.0, P.trace() - along_m2);
  const Vector2 variances(3 * square(sideways_m2 / (2 * distance_m)),
                          along_m2 * sideways_m2 / square(square(distance_m)));
  return variances.asDiagonal();
}

JointFilter::RelativeRow JointFilter::relative_row(const Part& own, const Position& other, const Relative& seen,
                                                   const Part* observer) const {
  RelativeRow row;
  row.H = Eigen::MatrixXd::Zero(2, size());
  double bearing_rad = seen.bearing_rad, variance_rad2 = square(seen.bearing_std_rad);
  if (observer != nullptr) {
    for (const int index : {observer->layout.heading_bias, observer->layout.slow_heading}) {
      if (index < 0) continue;
      row.H(1, observer->offset + index) = -1;
      variance_rad2 += P_(observer->offset + index, observer->offset + index);
    }
    bearing_rad += heading_error(*observer);
  }
  // Where they are, by their positions and by the relative measurement: the measurement is linearized at what both give
  // together.
  const Vector2 predicted_W = other.p_W - x_.segment<2>(own.offset);
  const Vector2 u_seen(std::cos(bearing_rad), std::sin(bearing_rad));
  const Matrix2 R_seen =
      square(seen.range_std_m) * u_seen * u_seen.transpose() +
      square(std::max(seen.range_m, min_seen_m)) * variance_rad2 * left_of(u_seen) * left_of(u_seen).transpose();
  const Matrix2 gain = other.P * (other.P + R_seen).inverse();
  const Vector2 d_W = predicted_W + gain * (seen.range_m * u_seen - predicted_W);
  const double distance_m = std::max(d_W.norm(), 0.01);
  const Vector2 u = d_W / distance_m;
  row.J.row(0) = u.transpose();
  row.J.row(1) = left_of(u).transpose() / distance_m;
  row.H.middleCols<2>(own.offset) = -row.J;
  row.innovation << seen.range_m - distance_m, wrapped(bearing_rad - std::atan2(d_W.y(), d_W.x()));
  row.innovation -= row.J * (predicted_W - d_W);
  row.R = Vector2(square(seen.range_std_m), square(seen.bearing_std_rad)).asDiagonal();
  row.R += bend_of(d_W, other.P - gain * other.P);
  return row;
}

JointFilter::RelativeRow JointFilter::relative_row(int own, const Position& other, const Relative& seen) const {
  const Position relative{other.p_W, covariance(own) + other.P};
  return relative_row(at(own), relative, seen, seen.by_other ? nullptr : &at(own));
}

JointFilter::RelativeRow JointFilter::relative_row(int own, int other, const Relative& seen) const {
  const Matrix2 across = P_.block<2, 2>(at(own).offset, at(other).offset);
  const Position relative{position(other), covariance(own) + covariance(other) - across - across.transpose()};
  RelativeRow row = relative_row(at(own), relative, seen, &at(seen.by_other ? other : own));
  row.H.middleCols<2>(at(other).offset) += row.J;
  return row;
}

bool JointFilter::within_gate(const Vector2& innovation, const Matrix2& S) const {
  return gate_ <= 0 || innovation.dot(S.inverse() * innovation) <= autonomy::chi_square_999_2;
}

bool JointFilter::within_gate(const RelativeRow& row, const Matrix2& more) const {
  return row.innovation.allFinite() && within_gate(row.innovation, row.H * P_ * row.H.transpose() + row.R + more);
}

JointFilter::Outcome JointFilter::see(const RelativeRow& row, const Matrix2& more) {
  if (!within_gate(row, more)) return Outcome::refused;
  update(row.H, row.innovation, row.R + more);
  return Outcome::used;
}

void JointFilter::update(const Eigen::VectorXd& H, double innovation, double R) {
  // Few elements of H are not 0.
  Eigen::VectorXd PH = Eigen::VectorXd::Zero(size());
  for (int i = 0; i < size(); ++i)
    if (H[i] != 0) PH += H[i] * P_.col(i);
  const Eigen::VectorXd K = PH / (H.dot(PH) + R);
  x_ += K * innovation;
  // Joseph form (I - K H) P (I - K H)' + K R K' as two updates of rank one.
  P_.noalias() -= K * PH.transpose();
  PH.setZero();
  for (int i = 0; i < size(); ++i)
    if (H[i] != 0) PH += H[i] * P_.col(i);
  P_.noalias() -= (PH - R * K) * K.transpose();
  symmetrize();
}

Eigen::MatrixXd JointFilter::update(const Eigen::MatrixXd& H, const Eigen::VectorXd& innovation,
                                    const Eigen::MatrixXd& R) {
  const Eigen::MatrixXd PH = P_ * H.transpose();
  const Eigen::MatrixXd S = H * PH + R;
  const Eigen::MatrixXd K = PH * S.inverse();
  x_ += K * innovation;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(size(), size()) - K * H;
  P_ = A * P_ * A.transpose() + K * R * K.transpose();
  symmetrize();
  return A;
}

void JointFilter::inform(int part, const Matrix2& L, const Vector2& eta) {
  const int o = at(part).offset;
  const Matrix2 I = Matrix2::Identity();
  const Eigen::MatrixXd PH = P_.middleCols<2>(o);
  const Vector2 p = x_.segment<2>(o);
  const Matrix2 M = (I + L * P_.block<2, 2>(o, o)).inverse();
  x_ += PH * M * (eta - L * p);
  P_ -= (PH * M * L * PH.transpose()).eval();
  symmetrize();
}

Estimate JointFilter::now(int vehicle, Time time) const {
  const Part& part = at(vehicle);
  Estimate estimate;
  estimate.v_W = corrected(part, part.v_W);
  estimate.p_W = position(vehicle) + estimate.v_W * seconds(time - part.time);
  estimate.P = covariance(vehicle);
  estimate.heading_bias_rad = heading_error(part);
  if (part.layout.clock >= 0) estimate.clock_error_s = x_[part.offset + part.layout.clock] / sound_speed_mps_;
  return estimate;
}

void JointFilter::symmetrize() {
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

}  // namespace navigation
