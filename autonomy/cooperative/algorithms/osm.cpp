// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <map>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"
#include "autonomy/cooperative/filter/sender_chain.hpp"

namespace navigation {

namespace {

/// Origin state method (Walls and Eustice, IJRR 33(9), 2014, 10.1177/0278364914525856).  A sender knows the joint
/// distribution of its origin, the start of the run, and its present position, from its own measurements only, and
/// sends it with each packet.  From two such packets a receiver recovers what the sender measured between them,
/// whatever was lost, and so has the sender in its filter with the true correlation: equal to the centralized filter of
/// the two at each reception.  Ranges are not sent on.
///
/// A sender whose fixes by satellite replaced all that it sent before is independent of that, and sends its position
/// alone.  Its first packet is a pair, so that what it knew at the surface is linked to what it says below.
///
/// Exact for senders whose motion has white noise; biases of heading and speed enter the joint distribution, but not
/// the link between two packets.
class OriginStateMethod final : public EstimatorOf<OriginStateMethod> {
 public:
  static constexpr const char* meaning =
      "origin state method: exact with any losses, from each sender's own measurements";
  static constexpr std::size_t numbers = 14;
  static constexpr std::size_t bytes = 1 + 4 * numbers;

  void start(const Setup& setup) override {
    need_bytes(setup, "osm", bytes);
    setup_ = setup;
    chains_ = SenderChains(setup);
    alone_ = chains_.filter();
    origin_ = alone_.copy(own);
    origin_noise_m2_ = std::pow(origin_noise_share * setup.position_std_m, 2);
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    chains_.filter().move(own, time, v_W, q);
    alone_.move(own, time, v_W, q);
  }
  void fix(Time, const Vector2& p_W, double std_m) override {
    chains_.filter().fix(own, p_W, std_m);
    const Matrix2 before = alone_.covariance(own);
    alone_.fix(own, p_W, std_m);
    independence_.fixed(setup_, before, alone_.covariance(own));
  }
  void on_range(const ReceivedRange& received) override {
    const double clock_m2 = sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time);
    PayloadReader reader(received.payload);
    if (reader.whole(1) == position_kind) {
      const auto sender = read_position(reader);
      if (sender)
        chains_.filter().range(own, *sender, received.own_z_m - received.sender_z_m, received.range_m, received.std_m,
                               clock_m2);
      return;
    }
    const auto pair = read_pair(reader);
    if (!pair) return;
    const SenderChains before = chains_;
    if (!chains_.knows(received.sender)) {
      chains_.begin(received.sender, {pair->mean.tail<2>(), pair->covariance.bottomRightCorner<2, 2>()});
    } else {
      const auto link = link_between(last_.at(received.sender), *pair);
      if (!link) return;
      chains_.advance(received.sender, *link);
    }
    chains_.range(received, clock_m2);
    if (chains_.is_sound())
      last_[received.sender] = *pair;
    else
      chains_ = before;
  }
  Bytes make_payload(Time, std::size_t max_bytes) override {
    Bytes payload;
    PayloadWriter writer(payload);
    // Once fixes have replaced all that it shared, its position alone says everything, in fewer bytes.
    const bool has_fixes = has_said_ && independence_.is_independent();
    independence_.shared();
    has_said_ = true;
    if (has_fixes) {
      writer.whole(position_kind, 1);
      write_position(writer, {alone_.position(own), alone_.covariance(own)});
      return payload;
    }
    writer.whole(pair_kind, 1);
    const int places[] = {alone_.offset(origin_), alone_.offset(origin_) + 1, alone_.offset(own),
                          alone_.offset(own) + 1};
    // The receiver takes the difference of two pairs, which costs digits: double precision if the frame has room.
    const int size = max_bytes > 8 * numbers ? 8 : 4;
    for (const int place : places) writer.real(alone_.x()[place], size);
    for (int i = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j)
        writer.real(alone_.P()(places[i], places[j]) + (i == j && i < 2 ? origin_noise_m2_ : 0), size);
    return payload;
  }
  Estimate now(Time time) const override { return chains_.filter().now(own, time); }

 private:
  static constexpr int own = SenderChains::own;

  static constexpr std::uint64_t pair_kind = 0, position_kind = 1;
  /// The origin is the start with a white error of this share of its standard deviation.  Otherwise the joint
  /// distribution of a vehicle that has not moved yet would be singular, and nothing could be linked to it.
  static constexpr double origin_noise_share = 0.01;

  /// Numbers have 8 bytes where all fit, otherwise 4.
  static std::optional<Pair> read_pair(PayloadReader& reader) {
    if (reader.left() != 4 * numbers && reader.left() != 8 * numbers) return std::nullopt;
    const int size = reader.left() == 8 * numbers ? 8 : 4;
    Pair pair;
    for (int i = 0; i < 4; ++i) pair.mean[i] = reader.real(size);
    for (int i = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j) pair.covariance(i, j) = pair.covariance(j, i) = reader.real(size);
    if (!reader.ok() || !(pair.covariance.diagonal().minCoeff() > 0)) return std::nullopt;
    return pair;
  }

  Setup setup_;
  SenderChains chains_;
  JointFilter alone_;  ///< the own vehicle without ranges, and its origin
  int origin_ = 0;
  double origin_noise_m2_ = 0;
  std::map<int, Pair> last_;  ///< newest packet of each sender
  Independence independence_;
  bool has_said_ = false;
};

SHOAL_ESTIMATOR("osm", OriginStateMethod);

}  // namespace

}  // namespace navigation
