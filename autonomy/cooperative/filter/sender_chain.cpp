// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/filter/sender_chain.hpp"

#include <Eigen/LU>
#include <cmath>

namespace navigation {

namespace {

bool is_positive_definite(const Matrix2& M) {
  return M.allFinite() && M(0, 0) > 0 && M.determinant() > 0;
}

}  // namespace

std::optional<ChainLink> link_between(const Pair& before, const Pair& after) {
  ChainLink link;
  link.about_W = before.mean.tail<2>();
  Vector4 about;
  about << link.about_W, link.about_W;
  const Matrix4 A = before.covariance.inverse();
  const Matrix4 B = after.covariance.inverse();
  const Vector4 a = A * (before.mean - about);
  const Vector4 b = B * (after.mean - about);
  const Matrix2 A_ob = A.topRightCorner<2, 2>();
  const Matrix2 to_before = A_ob.inverse();
  const Matrix2 difference = A.topLeftCorner<2, 2>() - B.topLeftCorner<2, 2>();
  const Matrix2 inverse_M = to_before * difference * to_before.transpose();
  const Matrix2 M = inverse_M.inverse();
  if (!is_positive_definite(M)) return std::nullopt;
  const Vector2 both = M * (to_before * (a.head<2>() - b.head<2>()));  // a_b + f_b
  const Matrix2 F_ba = -M * to_before * B.topRightCorner<2, 2>();
  link.information.topLeftCorner<2, 2>() = M - A.bottomRightCorner<2, 2>();
  link.information.topRightCorner<2, 2>() = F_ba;
  link.information.bottomLeftCorner<2, 2>() = F_ba.transpose();
  link.information.bottomRightCorner<2, 2>() = B.bottomRightCorner<2, 2>() + F_ba.transpose() * inverse_M * F_ba;
  link.information = (0.5 * (link.information + link.information.transpose())).eval();
  link.vector << both - a.tail<2>(), b.tail<2>() + F_ba.transpose() * (inverse_M * both);
  if (!link.information.allFinite() || !link.vector.allFinite() ||
      !is_positive_definite(link.information.bottomRightCorner<2, 2>()))
    return std::nullopt;
  return link;
}

ChainLink link_of(const Pair& both, const Vector2& mean_before, const Matrix2& covariance_before) {
  ChainLink link;
  link.about_W = mean_before;
  Vector4 about;
  about << mean_before, mean_before;
  link.information = both.covariance.inverse();
  link.vector = link.information * (both.mean - about);
  link.information.topLeftCorner<2, 2>() -= covariance_before.inverse();  // its vector about its mean is 0
  return link;
}

SenderChains::SenderChains(const Setup& setup) : filter_(setup.sound_speed_mps, setup.gate) {
  filter_.add(setup.errors(), setup.time, setup.position_W, setup.position_std_m);
}

void SenderChains::advance(int sender, const ChainLink& link) {
  const int part = parts_.at(sender);
  // The later position given the earlier one, and what the link says of the earlier one alone.
  const Matrix2 Q = link.information.bottomRightCorner<2, 2>().inverse();
  const Matrix2 F_ba = link.information.topRightCorner<2, 2>();
  const Matrix2 Phi = -Q * F_ba.transpose();
  const Matrix2 L = link.information.topLeftCorner<2, 2>() - F_ba * Q * F_ba.transpose();
  const Vector2 eta = link.vector.head<2>() - F_ba * Q * link.vector.tail<2>();
  filter_.inform(part, L, eta + L * link.about_W);
  filter_.move_linear(part, Phi, Q * link.vector.tail<2>() + link.about_W - Phi * link.about_W, Q);
}

void SenderChains::range(const ReceivedRange& received, double more_variance_m2) {
  filter_.range(own, parts_.at(received.sender), received.own_z_m - received.sender_z_m, received.range_m,
                std::sqrt(received.std_m * received.std_m + more_variance_m2));
}

bool SenderChains::is_sound() const {
  return filter_.x().allFinite() && filter_.P().allFinite() && filter_.P().diagonal().minCoeff() > 0;
}

}  // namespace navigation
