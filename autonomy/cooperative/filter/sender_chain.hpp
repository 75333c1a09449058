// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>

#include "autonomy/cooperative/filter/joint_filter.hpp"

namespace navigation {

using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;

/// Gaussian of two positions, such as of a sender at an earlier and a later transmission.
struct Pair {
  Vector4 mean = Vector4::Zero();
  Matrix4 covariance = Matrix4::Identity();
};

/// Factor that links the position of a sender at a transmission with that at a later one: what it measured in between,
/// in information form about a point.
struct ChainLink {
  Matrix4 information = Matrix4::Zero();
  Vector4 vector = Vector4::Zero();
  Vector2 about_W = Vector2::Zero();
};

/// Returns the link from `before` to `after`, where both are of the same origin and, of these two transmissions:
/// p(origin, after) is the marginal of p(origin, before) times the link.  (Walls and Eustice, IJRR 33(9), 2014: what
/// the origin state method recovers.)  With the information matrices A of `before` and B of `after`, and M the block of
/// `before` in their product:
///
///     M^-1 = A_ob^-1 (A_oo - B_oo) A_bo^-1,   F_bb = M - A_bb,   F_ba = -M A_ob^-1 B_oa,   F_aa = B_aa + F_ab M^-1
///     F_ba
///
/// Returns std::nullopt when the two do not determine it.
std::optional<ChainLink> link_between(const Pair& before, const Pair& after);

/// Returns the link that a sender computes itself: p(before, after | all) / p(before | until then).
ChainLink link_of(const Pair& both, const Vector2& mean_before, const Matrix2& covariance_before);

/// Filter of the own vehicle and of the last transmission of each sender, whose positions are correlated with the own
/// one by the ranges.
class SenderChains {
 public:
  SenderChains() = default;
  explicit SenderChains(const Setup& setup);

  JointFilter& filter() { return filter_; }
  const JointFilter& filter() const { return filter_; }
  bool knows(int sender) const { return parts_.contains(sender); }
  /// Adds a sender with its first transmission.
  void begin(int sender, const Position& position) { parts_[sender] = filter_.add(position); }
  /// Advances a sender from its last transmission to a later one.
  void advance(int sender, const ChainLink& link);
  /// Updates by the range to the last transmission of a sender.
  void range(const ReceivedRange& received, double more_variance_m2);

  /// Whether all numbers are finite and all variances above 0, which bytes of another program may have broken.
  bool is_sound() const;

  static constexpr int own = 0;  ///< number of the own vehicle in the filter

 private:
  JointFilter filter_;
  std::map<int, int> parts_;  ///< of the senders
};

}  // namespace navigation
