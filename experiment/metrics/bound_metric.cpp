// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>

#include "experiment/score/bound/team_bound.hpp"
#include "experiment/score/metric_registry.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/swarm_position_t.hpp"
#include "shoal/usbl_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/world_config.hpp"

namespace experiment {

namespace {

/// Longest time from the start of a transmission to its report.
constexpr sim::Time max_packet{30'000'000};
/// Interval of the motion and of the samples of the bound.
constexpr double motion_interval_s = 0.2;

const std::vector<std::pair<std::string, TeamBound::Known>>& known_words() {
  using Known = TeamBound::Known;
  static const std::vector<std::pair<std::string, Known>> words = {{"clock", Known::clock},
                                                                   {"gps_drift", Known::gps_drift},
                                                                   {"heading_bias", Known::heading_bias},
                                                                   {"heading_drift", Known::heading_drift},
                                                                   {"speed_scale", Known::speed_scale},
                                                                   {"velocity_drift", Known::velocity_drift}};
  return words;
}

/// Posterior Cramer-Rao bound of the position of a vehicle.
class BoundMetric final : public Metric {
 public:
  static constexpr const char* meaning =
      "reference for the rms position error with the measurements of the run: the posterior Cramer-Rao bound, "
      "horizontal, in which a vehicle without DVL and odometry only knows its newest fix";
  static std::vector<sim::FigureKind> figures() {
    return {{"rms_m", "m", "root of the mean variance of the position, from `from_s` to the end"},
            {"final_m", "m", "standard deviation of the position at the end"},
            {"max_m", "m", "largest standard deviation of the position"},
            {"ranges", "packets", "acoustic packets within the team, used as ranges", true},
            {"fixes", "fixes", "GPS positions of the team", true},
            {"sightings", "sightings", "relative positions measured within the team, also by USBL", true}};
  }
  /// Measurements of the team that count, besides fixes and dead reckoning.
  enum class Scope {
    team,      ///< those of all vehicles
    received,  ///< the packets that the vehicle received, and the relative positions of and to it
    alone,     ///< none
  };
  struct Params final : sim::MetricParams {
    Scope of = Scope::team;
    std::vector<std::string> team;
    TeamBound::Options options;
    void read(sim::ParamReader& in) override;
    void check(const sim::MetricConfig& metric, const sim::WorldConfig& world,
               sim::Diagnostics& diagnostics) const override;
  };

  BoundMetric(const MetricContext& context, const Params& params);

  void after_step() override;
  void add_figures(Figures& figures) const override;
  std::string why_none(const std::string&) const override { return "no time was scored" + since_from_s(); }
  std::int64_t bad_messages() const override { return bad_messages_; }
  void visit_state(sim::StateArchive& archive, History) override;

 private:
  struct Member {
    std::string name;
    std::unique_ptr<sim::Mailbox> fixes, sightings, usbl;
    std::vector<std::pair<VehicleErrors::Point, std::unique_ptr<sim::Mailbox>>> packets;
    TeamBound::Pose pose;  ///< the last one, when it was removed
  };
  static std::vector<std::string> names_of(const Params& params, const sim::WorldConfig& world);
  static std::vector<VehicleErrors> errors_of_team(const std::vector<std::string>& names, const sim::World& world);
  TeamBound make_bound(const Params& params) const;
  /// Returns whether ranges and relative positions measured by a vehicle count.
  bool counts(int observer) const {
    return params_.of == Scope::team || (params_.of == Scope::received && observer == scored_);
  }
  std::unique_ptr<sim::Mailbox> open(const std::string& vehicle, const std::string& device) const;
  int index_of(const std::string& name) const;
  /// Passes the messages in a mailbox to `use`.
  template <typename Message, typename Use>
  void read(sim::Mailbox* mailbox, const Use& use);
  void move(bool scores);
  void use_packet(int receiver, const VehicleErrors::Point& modem, const shoal::acoustic_received_t& packet);

  const Params& params_;
  sim::World& world_;
  const std::vector<std::string> names_;
  const int scored_;
  std::vector<Member> members_;
  TeamBound bound_;
  std::int64_t every_steps_;
  std::int64_t bad_messages_ = 0;
  std::optional<std::int64_t> moved_step_;
};

void BoundMetric::Params::read(sim::ParamReader& in) {
  in.require("vehicle");
  read_vehicle(in);
  in.read_choice("of", of, {{"team", Scope::team}, {"received", Scope::received}, {"alone", Scope::alone}},
                 "ranges and relative positions used: those of all vehicles of the team; only those that `vehicle` "
                 "measures itself, as in one-way navigation; none, as in dead reckoning");
  in.read_references("team", team, "vehicle",
                     "vehicles whose devices and packets count, with `vehicle`; unset: all of the world");
  read_from_s(in);
  in.read("start_std_m", options.start_std_m, sim::between(0, 1e6),
          "standard deviation of east and of north at the start");
  in.read_deg("start_heading_std_deg", options.start_heading_std_rad, sim::between(0, 180),
              "standard deviation of the initial heading that odometry propagates");
  in.read("sound_speed_std", options.sound_speed_std, sim::between(0, 1),
          "relative uncertainty of the speed of sound, the same for all ranges");
  std::vector<std::string> known;
  in.read("known", known,
          "errors that the estimator is assumed to know: clock, gps_drift, heading_bias, heading_drift, speed_scale, "
          "velocity_drift");
  options.from_s = from_s;
  for (const std::string& word : known) {
    const auto& words = known_words();
    const auto found = std::find_if(words.begin(), words.end(), [&](const auto& each) { return each.first == word; });
    std::vector<std::string> all;
    for (const auto& each : words) all.push_back(each.first);
    if (found == words.end())
      in.error("known", "'known' has the unknown error '" + sim::shortened(sim::printable(word)) +
                            "'; errors: " + sim::list_text(all) + sim::did_you_mean(word, all));
    else
      options.known.insert(found->second);
  }
}

void BoundMetric::Params::check(const sim::MetricConfig& metric, const sim::WorldConfig& world,
                                sim::Diagnostics& diagnostics) const {
  for (const sim::VehicleInstance& instance : world.vehicles) {
    const bool named = instance.name == vehicle || std::find(team.begin(), team.end(), instance.name) != team.end();
    if (!named || !instance.config || errors_of(*instance.config, world.physics.step_s).can_navigate()) continue;
    diagnostics.error(
        metric.place, "metric '" + metric.name + "'",
        "vehicle '" + instance.name + "' cannot localize itself: it needs gps, odometry, or dvl with ahrs or compass");
  }
}

std::vector<std::string> BoundMetric::names_of(const Params& params, const sim::WorldConfig& world) {
  std::vector<std::string> names;
  for (const sim::VehicleInstance& instance : world.vehicles) {
    const bool meant =
        params.team.empty() || std::find(params.team.begin(), params.team.end(), instance.name) != params.team.end();
    if (instance.name == params.vehicle ||
        (meant && instance.config && errors_of(*instance.config, world.physics.step_s).can_navigate()))
      names.push_back(instance.name);
  }
  return names;
}

std::vector<VehicleErrors> BoundMetric::errors_of_team(const std::vector<std::string>& names, const sim::World& world) {
  std::vector<const sim::VehicleConfig*> vehicles;
  for (const std::string& name : names) vehicles.push_back(&world.find_vehicle(name)->config());
  std::vector<VehicleErrors> team;
  for (const sim::VehicleConfig* vehicle : vehicles) {
    VehicleErrors errors = errors_of(*vehicle, sim::to_seconds(world.step_time()));
    if (errors.usbl)
      errors.usbl->errors.hearing = usbl_hearing(*vehicle, vehicles, world.config().acoustics, world.medium());
    team.push_back(std::move(errors));
  }
  return team;
}

TeamBound BoundMetric::make_bound(const Params& params) const {
  return {errors_of_team(names_, world_), scored_, params.options};
}

BoundMetric::BoundMetric(const MetricContext& context, const Params& params)
    : Metric(context),
      params_(params),
      world_(context.world),
      names_(names_of(params, context.world.config())),
      scored_(index_of(params.vehicle)),
      bound_(make_bound(params)),
      every_steps_(std::max<std::int64_t>(1, std::llround(motion_interval_s / sim::to_seconds(world_.step_time())))) {
  const std::vector<VehicleErrors::Point> no_modems;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const VehicleErrors& errors = bound_.errors(static_cast<int>(i));
    Member member;
    member.name = names_[i];
    if (errors.gps) member.fixes = open(names_[i], errors.gps->device);
    if (errors.sightings && counts(static_cast<int>(i)))
      member.sightings = open(names_[i], errors.sightings->sensor.device);
    if (errors.usbl && params_.of != Scope::alone) member.usbl = open(names_[i], errors.usbl->sensor.device);
    for (const VehicleErrors::Point& modem : counts(static_cast<int>(i)) ? errors.modems : no_modems)
      member.packets.emplace_back(modem, open(names_[i], modem.device));
    members_.push_back(std::move(member));
  }
  move(true);
}

std::unique_ptr<sim::Mailbox> BoundMetric::open(const std::string& vehicle, const std::string& device) const {
  const sim::MountedDevice* mounted = world_.find_device(vehicle + "/" + device);
  return world_.find_vehicle(vehicle)->bus().open_mailbox(mounted->report_channel());
}

int BoundMetric::index_of(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

void BoundMetric::move(bool scores) {
  // Several messages of a step share its motion.
  if (moved_step_ == world_.step_number()) return;
  moved_step_ = world_.step_number();
  std::vector<TeamBound::Pose> poses;
  for (Member& member : members_) {
    // A vehicle that was removed stays where it was last.
    if (const sim::Vehicle* vehicle = world_.find_vehicle(member.name)) {
      const sim::Pose X_WV = vehicle->X_WV();
      member.pose = {X_WV.translation(), sim::yaw_of(X_WV.linear())};
    }
    poses.push_back(member.pose);
  }
  bound_.move(world_.now(), std::move(poses), scores);
}

template <typename Message, typename Use>
void BoundMetric::read(sim::Mailbox* mailbox, const Use& use) {
  while (mailbox != nullptr) {
    const auto message = mailbox->take();
    if (!message) return;
    move(world_.step_number() % every_steps_ == 0);
    try {
      use(shoal::decode<Message>(message->payload, shoal::Finite::any));
    } catch (const shoal::MessageError&) {
      ++bad_messages_;
    }
  }
}

void BoundMetric::after_step() {
  if (world_.step_number() % every_steps_ == 0) move(true);
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    Member& member = members_[static_cast<std::size_t>(i)];
    const sim::Vehicle* vehicle = world_.find_vehicle(member.name);
    const auto true_time = [&](std::int64_t utime) {
      const sim::Time now = world_.now();
      return vehicle == nullptr ? now : std::min(true_time_of(world_, *vehicle, utime), now);
    };
    read<shoal::gps_data_t>(member.fixes.get(), [&](const shoal::gps_data_t& fix) {
      if (fix.gps_lock > 0 && std::isfinite(fix.xyz_pos[0])) bound_.add_fix(true_time(fix.utime), i);
    });
    read<shoal::swarm_position_t>(member.sightings.get(), [&](const shoal::swarm_position_t& seen) {
      for (const std::string& name : seen.vehicle)
        if (const int other = index_of(name); other >= 0 && other != i)
          bound_.add_sighting(true_time(seen.utime), i, other);
    });
    read<shoal::usbl_t>(member.usbl.get(), [&](const shoal::usbl_t& seen) {
      // A transponder is VEHICLE/DEVICE.
      const int other = index_of(seen.target.substr(0, seen.target.find('/')));
      if (other >= 0 && other != i && (counts(i) || other == scored_)) bound_.add_usbl(true_time(seen.utime), i, other);
    });
    for (const auto& packets : member.packets)
      read<shoal::acoustic_received_t>(packets.second.get(), [&](const shoal::acoustic_received_t& packet) {
        use_packet(i, packets.first, packet);
      });
  }
  bound_.advance(world_.now() - max_packet);
}

void BoundMetric::use_packet(int receiver, const VehicleErrors::Point& modem,
                             const shoal::acoustic_received_t& packet) {
  const int sender = index_of(packet.source);
  const sim::Vehicle* from = world_.find_vehicle(packet.source);
  const sim::Vehicle* to = world_.find_vehicle(names_[static_cast<std::size_t>(receiver)]);
  if (sender < 0 || from == nullptr || to == nullptr || bound_.errors(sender).modems.empty()) return;
  const sim::Time sent = true_time_of(world_, *from, packet.sent_utime);
  const sim::Time arrived = true_time_of(world_, *to, packet.utime);
  if (sent < world_.now() - max_packet || arrived > world_.now() || arrived <= sent) return;
  // Clocks that GPS steers have no states.
  double clocks_s2 = 0;
  for (const auto& [index, vehicle] : {std::pair(sender, from), std::pair(receiver, to)})
    if (bound_.errors(index).disciplined()) clocks_s2 += std::pow(vehicle->clock().estimated_std_s(world_.now()), 2);
  constexpr double sound_speed_mps = 1500;  // for errors of less than a centimeter
  bound_.add_range(sent, {sender, bound_.errors(sender).modems.front().at_V}, arrived, {receiver, modem.at_V},
                   world_.now(), clocks_s2 * sound_speed_mps * sound_speed_mps);
}

void BoundMetric::add_figures(Figures& figures) const {
  const TeamBound::Result result = bound_.result();
  const auto count = static_cast<double>(result.samples);
  const bool any = result.samples > 0;
  add(figures, "rms_m", any ? std::sqrt(result.sum_m2 / count) : no_figure);
  add(figures, "final_m", any ? std::sqrt(result.last_m2) : no_figure);
  add(figures, "max_m", any ? std::sqrt(result.max_m2) : no_figure);
  add(figures, "ranges", static_cast<double>(result.ranges));
  add(figures, "fixes", static_cast<double>(result.fixes));
  add(figures, "sightings", static_cast<double>(result.sightings));
}

void BoundMetric::visit_state(sim::StateArchive& archive, History) {
  archive(bound_, bad_messages_, moved_step_);
  for (Member& member : members_) {
    archive(member.pose);
    if (!archive.restoring()) continue;
    if (member.fixes) empty(*member.fixes);
    if (member.sightings) empty(*member.sightings);
    if (member.usbl) empty(*member.usbl);
    for (const auto& [modem, mailbox] : member.packets) empty(*mailbox);
  }
}

SHOAL_METRIC("bound", BoundMetric);

}  // namespace

}  // namespace experiment
