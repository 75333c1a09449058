// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_kind.hpp"

#include <algorithm>

#include "sim/acoustics/signal.hpp"

namespace sim {

namespace {

std::string meaning_of(SignalLoss loss) {
  switch (loss) {
    case SignalLoss::none:
      return "understood";
    case SignalLoss::noise:
      return "too weak against noise; by radio: in a zone without radio";
    case SignalLoss::interference:
      return "too weak against other sounds";
    case SignalLoss::half_duplex:
      return "the receiver was sending";
    case SignalLoss::busy:
      return "the receiver was taking another signal";
    case SignalLoss::captured:
      return "a stronger signal took the receiver over";
    case SignalLoss::doppler:
      return "sender and receiver close or part too fast";
    case SignalLoss::blocked:
      return "something stands between; by radio: or an antenna is under water";
    case SignalLoss::out_of_water:
      return "sender or receiver left the water";
    case SignalLoss::receiver_off:
      return "the receiver has no power, or is silent by a fault";
    case SignalLoss::link:
      return "`links` of the world, or the radio's `loss_probability`";
    case SignalLoss::range:
      return "too far away";
    case SignalLoss::sender_off:
      return "the sender lost its power or was removed in the middle of it";
  }
  return "";
}

std::vector<FigureKind> delivery_figures() {
  std::vector<FigureKind> figures{
      {"sent", "packets", "packets that its modems sent", true},
      {"received", "packets", "packets addressed to its modems that arrived", true},
      {"lost", "packets", "packets addressed to its modems that were lost", true},
      {"ratio", "1", "received / (received + lost), from 0 to 1; none when nothing was addressed to its modems"},
      {"bytes_sent", "bytes", "payload of the packets that its modems sent", true},
      {"unsent", "packets", "packets not sent: no power, or out of the water", true},
      {"dropped", "packets", "packets dropped from full queues of its modems", true}};
  for (int loss = 1; loss < signal_losses; ++loss)  // 0: none
    figures.push_back({"lost_" + std::string(signal_loss_word(static_cast<SignalLoss>(loss))), "packets",
                       "lost: " + meaning_of(static_cast<SignalLoss>(loss)), true});
  return figures;
}

std::vector<MetricKind> estimate_kinds() {
  return {
      {"position_error",
       "distance between the estimates on a channel and the true position of a vehicle",
       MetricType::position_error,
       {"vehicle", "channel"},
       {"from_s", "dimensions"},
       {{"rms_m", "m", "root mean square of the position errors"},
        {"final_m", "m", "position error of the last estimate"},
        {"max_m", "m", "largest position error"},
        {"per_distance_percent", "%", "last error over the distance travelled until then, when that is at least 1 m"},
        {"longest_gap_s", "s", "longest time without an estimate, from `from_s` to the end"},
        {"samples", "estimates", "estimates that were compared with the truth", true}}},
      {"consistency",
       "whether the covariance of the estimates says how large their errors are",
       MetricType::consistency,
       {"vehicle", "channel"},
       {"from_s", "dimensions"},
       {{"nees_mean", "1", "mean normalised estimation error squared; the number of dimensions when consistent"},
        {"inside_95_share", "1", "share of the errors within their own 95 % bound; 0.95 when consistent"},
        {"samples", "estimates", "estimates that were compared with the truth", true}}}};
}

std::vector<MetricKind> all_kinds() {
  std::vector<MetricKind> kinds = estimate_kinds();
  kinds.insert(
      kinds.end(),
      {{"distance",
        "how far a vehicle went",
        MetricType::distance,
        {"vehicle"},
        {"from_s"},
        {{"travelled_m", "m", "length of the true path, in three dimensions"}}},
       {"delivery",
        "packets of modems, and what became of them",
        MetricType::delivery,
        {},
        {"vehicle", "device"},
        delivery_figures()},
       {"bytes_per_metre",
        "what a metre of smaller position error cost in bytes",
        MetricType::bytes_per_metre,
        {"metric", "against"},
        {"vehicle", "device"},
        {{"bytes_per_metre", "bytes/m", "bytes_sent / reduction_m; none when the error did not become smaller"},
         {"bytes_sent", "bytes", "payload of the packets that the modems sent", true},
         {"reduction_m", "m", "rms error of `against` minus rms error of `metric`"}}},
       {"mission_time",
        "when something became true for the first time",
        MetricType::mission_time,
        {},
        {"when", "vehicle", "position_m", "radius_m"},
        {{"time_s", "s", "simulated time; none: it never became true"}}},
       {"collisions",
        "contacts that began",
        MetricType::collisions,
        {},
        {"vehicle", "with", "from_s"},
        {{"count", "contacts", "contacts that began; again after the two were apart for more than 0.5 s", true},
         {"first_s", "s", "simulated time of the first one; none: there was no contact"}}},
       {"messages",
        "messages on a channel",
        MetricType::messages,
        {"channel"},
        {"vehicle", "from_s"},
        {{"count", "messages", "messages that came on the channel", true},
         {"bytes", "bytes", "their payload, with the fingerprint", true},
         {"first_s", "s", "simulated time of the first one; none: no message came"}}},
       {"lean",
        "how far the first body of a vehicle leans",
        MetricType::lean,
        {"vehicle"},
        {"from_s"},
        {{"max_deg", "deg", "largest angle between its z axis and the vertical"},
         {"rms_deg", "deg", "root mean square of the pitch about its mean"},
         {"mean_deg", "deg", "mean pitch, positive with the nose down"},
         {"fell_s", "s", "simulated time when it leaned more than 45 degrees; none: it did not fall"}}}});
  return kinds;
}

}  // namespace

const FigureKind* MetricKind::find(const std::string& figure) const {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const FigureKind& kind) { return kind.name == figure; });
  return found == figures.end() ? nullptr : &*found;
}

const std::vector<MetricKind>& metric_kinds() {
  static const std::vector<MetricKind> kinds = all_kinds();
  return kinds;
}

const MetricKind& metric_kind(MetricType type) {
  const auto& kinds = metric_kinds();
  return *std::find_if(kinds.begin(), kinds.end(), [type](const MetricKind& kind) { return kind.type == type; });
}

const MetricKind* metric_kind_of_figures(const std::set<std::string>& figures) {
  for (const MetricKind& kind : metric_kinds()) {
    std::set<std::string> names;
    for (const FigureKind& figure : kind.figures) names.insert(figure.name);
    if (names == figures) return &kind;
  }
  return nullptr;
}

}  // namespace sim
