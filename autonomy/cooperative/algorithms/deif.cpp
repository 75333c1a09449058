// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <deque>
#include <map>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"
#include "autonomy/cooperative/filter/sender_chain.hpp"

namespace navigation {

namespace {

/// Removes from a link what it seems to say of its earlier position by rounding to 32 bits alone.  After a gap, when
/// nothing else is known of that position, it would count.
ChainLink without_rounding(ChainLink link) {
  constexpr double rounding = 1e-6;  ///< of a sum of such numbers
  const Matrix2 F_ba = link.information.topRightCorner<2, 2>();
  const Matrix2 Q = link.information.bottomRightCorner<2, 2>().inverse();
  const Matrix2 by_later = F_ba * Q * F_ba.transpose();
  const Vector2 vector_by_later = F_ba * Q * link.vector.tail<2>();
  const Eigen::SelfAdjointEigenSolver<Matrix2> own(link.information.topLeftCorner<2, 2>() - by_later);
  const Vector2 eta = own.eigenvectors().transpose() * (link.vector.head<2>() - vector_by_later);
  Vector2 L = own.eigenvalues(), kept = eta;
  for (int i = 0; i < 2; ++i)
    if (L[i] < rounding * link.information.cwiseAbs().maxCoeff()) L[i] = kept[i] = 0;
  link.information.topLeftCorner<2, 2>() =
      by_later + own.eigenvectors() * L.asDiagonal() * own.eigenvectors().transpose();
  link.vector.head<2>() = vector_by_later + own.eigenvectors() * kept;
  return link;
}

/// Decentralized extended information filter (Webster, Walls, Whitcomb and Eustice, IEEE T-RO 29(4), 2013).  A sender
/// sends what it measured since its last packet, in information form, numbered; a receiver puts these links into its
/// chain, and then has the same estimate as a centralized filter.  A packet has as many of the last links as fit, so
/// that so many losses in a row do no harm.  After more the chain is broken: the receiver begins a new one, of whose
/// start it knows nothing, and its estimate is no longer the centralized one.
class DecentralizedInformationFilter final : public EstimatorOf<DecentralizedInformationFilter> {
 public:
  static constexpr const char* meaning =
      "decentralized information filter: exact until too many packets are lost in a row";
  static constexpr std::size_t link_bytes = 4 * 16;
  static constexpr std::size_t head_bytes = 3;  ///< number of the newest link, and how many there are
  /// Standard deviation of a position of which nothing is known.
  static constexpr double unknown_m = 1e4;

  void start(const Setup& setup) override {
    need_bytes(setup, "deif", head_bytes + link_bytes);
    setup_ = setup;
    chains_ = SenderChains(setup);
    alone_ = chains_.filter();
    // The first link begins at the origin, of which receivers know nothing but what the link says.
    before_ = alone_.copy(own);
    mean_before_ = setup.position_W;
    covariance_before_ = unknown_m * unknown_m * Matrix2::Identity();
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    chains_.filter().move(own, time, v_W, q);
    alone_.move(own, time, v_W, q);
  }
  void fix(Time, const Vector2& p_W, double std_m) override {
    chains_.filter().fix(own, p_W, std_m);
    alone_.fix(own, p_W, std_m);
  }
  void on_range(const ReceivedRange& received) override {
    PayloadReader reader(received.payload);
    const auto newest = static_cast<int>(reader.whole(2));
    const auto count = static_cast<int>(reader.whole(1));
    std::deque<ChainLink> links;  // the oldest first
    for (int i = 0; i < count && reader.ok(); ++i) links.push_front(read_link(reader));
    if (!reader.ok() || links.empty()) return;
    const auto known = newest_.find(received.sender);
    const int missing = known == newest_.end() ? cycle : (newest - known->second + cycle) % cycle;
    if (missing == 0) return;
    const SenderChains before = chains_;
    const auto begin = links.size() - std::min(links.size(), static_cast<std::size_t>(missing));
    if (known == newest_.end())
      chains_.begin(received.sender, nothing_known(links[begin].about_W));
    else if (static_cast<std::size_t>(missing) > links.size())
      break_chain(received.sender, links[begin].about_W);
    for (std::size_t i = begin; i < links.size(); ++i) chains_.advance(received.sender, links[i]);
    chains_.range(received, sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time));
    if (chains_.is_sound())
      newest_[received.sender] = newest;
    else
      chains_ = before;
  }
  Bytes make_payload(Time, std::size_t max_bytes) override {
    Pair both;
    const int places[] = {alone_.offset(before_), alone_.offset(before_) + 1, alone_.offset(own),
                          alone_.offset(own) + 1};
    for (int i = 0; i < 4; ++i) {
      both.mean[i] = alone_.x()[places[i]];
      for (int j = 0; j < 4; ++j) both.covariance(i, j) = alone_.P()(places[i], places[j]);
    }
    said_.push_front(link_of(both, mean_before_, covariance_before_));
    number_ = (number_ + 1) % cycle;
    // The state of the last frame is marginalized; a copy of the present one begins the next link of the chain.
    alone_.remove(before_);
    before_ = alone_.copy(own);
    mean_before_ = alone_.position(own);
    covariance_before_ = alone_.covariance(own);
    // Each frame repeats earlier links, as many as fit, so that a receiver can follow the chain across lost frames.
    const std::size_t fitting = (max_bytes - head_bytes) / link_bytes;
    if (said_.size() > fitting) said_.resize(fitting);
    Bytes payload;
    PayloadWriter writer(payload);
    writer.whole(static_cast<std::uint64_t>(number_), 2);
    writer.whole(said_.size(), 1);
    for (const ChainLink& link : said_) write_link(writer, link);
    return payload;
  }
  Estimate now(Time time) const override { return chains_.filter().now(own, time); }

 private:
  static constexpr int own = SenderChains::own;
  static constexpr int cycle = 65536;

  static Position nothing_known(const Vector2& p_W) { return {p_W, unknown_m * unknown_m * Matrix2::Identity()}; }
  void break_chain(int sender, const Vector2& near_W) {
    // Noise without bound between the last position known of the sender and the next one.
    ChainLink gap;
    gap.about_W = near_W;
    gap.information.bottomRightCorner<2, 2>() = Matrix2::Identity() / (unknown_m * unknown_m);
    chains_.advance(sender, gap);
  }
  static void write_link(PayloadWriter& writer, const ChainLink& link) {
    for (int i = 0; i < 2; ++i) writer.real(link.about_W[i]);
    for (int i = 0; i < 4; ++i) writer.real(link.vector[i]);
    for (int i = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j) writer.real(link.information(i, j));
  }
  static ChainLink read_link(PayloadReader& reader) {
    ChainLink link;
    for (int i = 0; i < 2; ++i) link.about_W[i] = reader.real();
    for (int i = 0; i < 4; ++i) link.vector[i] = reader.real();
    for (int i = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j) link.information(i, j) = link.information(j, i) = reader.real();
    return without_rounding(link);
  }

  Setup setup_;
  SenderChains chains_;
  JointFilter alone_;  ///< the own vehicle without ranges, and its last transmission
  int before_ = 0;
  Vector2 mean_before_ = Vector2::Zero();  ///< as known at that time
  Matrix2 covariance_before_ = Matrix2::Identity();
  std::deque<ChainLink> said_;  ///< the newest first
  int number_ = 0;              ///< of the newest
  std::map<int, int> newest_;   ///< link known of each sender
};

SHOAL_ESTIMATOR("deif", DecentralizedInformationFilter);

}  // namespace

}  // namespace navigation
