// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/ais.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/common/radio_horizon.hpp"
#include "shoal/ais_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

constexpr double knot_mps = 1852.0 / 3600;
constexpr double capture_dB = 10;  // co-channel rejection ratio, M.1371-5, annex 2, 2.4
constexpr std::int64_t slots_between_static = 6 * ais_slots_per_minute;

/// Returns a quantity in the steps of its field.
double in_steps(double value, double step) {
  return std::round(value / step) * step;
}

double clockwise_from_north_rad(double yaw_rad) {
  const double turn = 2 * std::numbers::pi;
  const double angle_rad = std::numbers::pi / 2 - yaw_rad;
  return angle_rad - turn * std::floor(angle_rad / turn);
}

}  // namespace

/// Stations of a world, in device order.
class Ais::Band {
 public:
  void join(Ais& station) { stations_.push_back(&station); }
  void leave(Ais& station) { std::erase(stations_, &station); }
  const std::vector<Ais*>& stations() const { return stations_; }

 private:
  std::vector<Ais*> stations_;
};

const sim::SharedKind<Ais::Band> Ais::band_of_world;

void Ais::Params::read(sim::ParamReader& in) {
  in.read_choice(
      "station", station,
      {{"class_a", AisStation::class_a}, {"class_b", AisStation::class_b}, {"receiver", AisStation::receiver}},
      "class_a: of ships; class_b: of small craft; receiver: transmits nothing");
  in.read("mmsi", mmsi, sim::between(0, 999'999'999),
          "identity, unique in the world; 0: 200000000 and the number of the device, which no country has");
  in.read("range_m", range_m, sim::above(0), "maximum range of reception, within the radio horizon of both antennas");
  in.read("loss_probability", loss_probability, sim::between(0, 1), "loss probability of each message that arrives");
  in.read("sends_heading", sends_heading, "it knows the heading of its vehicle");
  in.read("status", status, sim::between(0, 15),
          "navigational status of class A: 0 under way, 1 at anchor, 5 moored, 15 undefined");
  in.read("imo", imo, sim::between(0, 999'999'999), "IMO number of class A; 0: none");
  in.read("ship_name", ship_name, "at most 20 characters; unset: the name of the vehicle");
  in.read("call_sign", call_sign, "at most 7 characters");
  in.read("destination", destination, "of class A, at most 20 characters");
  in.read("ship_type", ship_type, sim::between(0, 255), "type of ship and cargo, such as 36 sailing, 70 cargo");
  in.read("dimensions_m", dimensions_m, sim::between(0, 511),
          "whole meters from the antenna to bow, stern, port and starboard");
  in.read("draught_m", draught_m, sim::between(0, 25.5), "of class A; 0: not available");
  in.read("horizontal_noise", horizontal_noise, "error of its position, of east and of north, m");
  in.read("velocity_noise", velocity_noise, "error of each component of the velocity over ground, m/s");
  in.read("heading_noise", heading_noise, "error of the heading, rad");
  if (!in.describing() && dimensions_m.size() != 4)
    in.error("dimensions_m", "'dimensions_m' must be four numbers: bow, stern, port, starboard");
}

Ais::Ais(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      vehicle_(context.vehicle),
      faults_(context.faults),
      body_(context.body),
      p_BS_(context.config.position_m),
      band_(context.shared(band_of_world)),
      full_name_(context.full_name()),
      epoch_us_(context.host.epoch_us),
      mmsi_(params.mmsi != 0 ? params.mmsi : 200'000'000 + context.number),
      horizontal_noise_(context, params, 2),
      velocity_noise_(context, params, 2),
      heading_noise_(context, params) {
  for (const Ais* other : band_.stations())
    if (other->mmsi_ == mmsi_)
      sim::throw_config_error(
          context.config.place, "device '" + full_name_ + "'",
          "'mmsi' must be unique: '" + other->full_name_ + "' has " + std::to_string(mmsi_) + ", too");
  band_.join(*this);
}

Ais::~Ais() {
  band_.leave(*this);
}

bool Ais::is_on() const {
  return vehicle_.systems().powered && !faults_.silent() && !world_.medium().in_water(p_WS());
}

void Ais::act(const sim::ActContext& context) {
  judge(context.now);
  if (params_.station == AisStation::receiver) return;
  if (position_slot_ == 0) start(slot_from(context.now));
  const std::int64_t end = slot_from(context.now + sim::from_seconds(context.step_s));
  // A station that was off for long does not make up for it.
  const std::int64_t now = slot_from(context.now);
  if (position_slot_ < now) position_slot_ = choose(now + 2, 20, 1);
  if (static_slot_ < now) static_slot_ = choose(now + 4, 20, 2);
  while (std::min(position_slot_, static_slot_) < end)
    if (position_slot_ <= static_slot_)
      transmit_position();
    else
      transmit_static();
}

void Ais::start(std::int64_t slot) {
  constexpr std::int64_t ten_s = ais_slots_per_minute / 6;
  position_slot_ = choose(slot + ten_s / 2, 5 * ten_s, 1);
  static_slot_ = choose(slot + 3 * ten_s / 2, 5 * ten_s, 2);
}

std::int64_t Ais::choose(std::int64_t nominal, std::int64_t interval, int length) {
  sim::Random random(world_.seed(), full_name_ + "/slots");
  random.begin_step(++sent_);
  return choose_ais_slot(nominal, interval, length, reserved_, random);
}

void Ais::transmit_position() {
  const std::int64_t slot = position_slot_;
  const bool moored = params_.status == 1 || params_.status == 5;
  const std::int64_t interval = ais_interval_slots(params_.station, fix_.v_W.norm(), moored, is_turning());
  position_slot_ = choose(slot + interval, interval, 1);
  transmit(position_report(), slot, 1, position_slot_);
}

void Ais::transmit_static() {
  const std::int64_t slot = static_slot_;
  const AisReport report = static_report();
  // Part B of type 24 follows part A by a second.
  const bool more = report.type == 24 && static_part_ == 0;
  static_part_ = more ? 1 : 0;
  const int slots = report.type == 5 ? 2 : 1;
  static_slot_ = more ? choose(slot + ais_slots_per_minute / 60, 20, 1)
                      : choose(slot + slots_between_static, ais_slots_per_minute, slots);
  transmit(report, slot, slots, static_slot_);
}

void Ais::transmit(AisReport report, std::int64_t slot, int slots, std::int64_t next_slot) {
  channel_ = 1 - channel_;
  if (!is_on()) return;
  Heard heard{{std::move(report), slot, slots, channel_, false, begin_of(slot + slots)}, next_slot, 0, false};
  for (Ais* receiver : band_.stations()) {
    if (receiver == this) continue;
    const std::optional<double> level_dB = level_at(*receiver);
    if (!level_dB) continue;
    heard.level_dB = *level_dB;
    receiver->heard_.push_back(heard);
  }
  heard.message.own = true;
  heard_.push_back(std::move(heard));
}

std::optional<double> Ais::level_at(const Ais& receiver) const {
  const sim::Vector3d from_W = p_WS(), to_W = receiver.p_WS();
  const auto height_m = [&](const sim::Vector3d& p_W) {
    return world_.medium().has_water() ? -world_.medium().depth_m(p_W) : p_W.z();
  };
  const double distance_m = (to_W - from_W).norm();
  if (!receiver.is_on() || distance_m > receiver.params_.range_m) return {};
  if (distance_m > radio_horizon_m(height_m(from_W)) + radio_horizon_m(height_m(to_W))) return {};
  for (const sim::Vector3d& p_W : {from_W, to_W})
    if (world_.zones().denied(sim::ZoneFlag::radio_denied, p_W)) return {};
  if (receiver.params_.loss_probability > 0) {
    // A random stream for each pair, so that another station does not change their messages.
    sim::Random link(world_.seed(), full_name_ + ">" + receiver.full_name_);
    link.begin_step(sent_);
    if (link.uniform() < receiver.params_.loss_probability) return {};
  }
  const double power_W = params_.station == AisStation::class_a ? 12.5 : 2;
  return 10 * std::log10(power_W) - 20 * std::log10(std::max(distance_m, 1.0));
}

bool Ais::is_turning() const {
  // The heading has left the mean of 30 s by 5 degrees (M.1371-5, annex 2, 4.3.1).
  if (!params_.sends_heading || mean_heading_.isZero()) return false;
  const double mean_rad = std::atan2(mean_heading_.y(), mean_heading_.x());
  return std::abs(sim::wrap_angle(fix_.yaw_rad - mean_rad)) > sim::degrees_to_radians(5);
}

AisReport Ais::position_report() const {
  AisReport report;
  report.type = params_.station == AisStation::class_a ? 1 : 18;
  report.mmsi = mmsi_;
  report.status = report.type == 1 ? params_.status : 0;
  if (params_.sends_heading) {
    report.heading_rad = in_steps(clockwise_from_north_rad(fix_.yaw_rad), sim::degrees_to_radians(1));
    if (report.type == 1) report.turn_radps = -fix_.turn_radps;
  }
  if (!fix_.valid) return report;
  const sim::GeodeticPosition position = world_.geodesy().to_geodetic(fix_.p_W);
  report.latitude_deg = in_steps(position.latitude_deg, 1.0 / 600'000);
  report.longitude_deg = in_steps(position.longitude_deg, 1.0 / 600'000);
  report.speed_mps = in_steps(fix_.v_W.norm(), 0.1 * knot_mps);
  const double course_rad = clockwise_from_north_rad(std::atan2(fix_.v_W.y(), fix_.v_W.x()));
  report.course_rad = in_steps(course_rad, sim::degrees_to_radians(0.1));
  return report;
}

AisReport Ais::static_report() const {
  AisReport report;
  report.type = params_.station == AisStation::class_a ? 5 : 24;
  report.mmsi = mmsi_;
  report.part = report.type == 24 ? static_part_ : 0;
  const bool has_name = report.type == 5 || report.part == 0;
  if (has_name) report.name = params_.ship_name.empty() ? vehicle_.name() : params_.ship_name;
  if (has_name) report.name.resize(std::min<std::size_t>(report.name.size(), 20));
  if (report.type == 5) {
    report.imo = params_.imo;
    report.destination = params_.destination.substr(0, 20);
    if (params_.draught_m > 0) report.draught_m = in_steps(params_.draught_m, 0.1);
  }
  if (report.type == 24 && report.part == 0) return report;
  report.call_sign = params_.call_sign.substr(0, 7);
  report.ship_type = params_.ship_type;
  int* const sides[] = {&report.bow_m, &report.stern_m, &report.port_m, &report.starboard_m};
  for (std::size_t i = 0; i < 4; ++i) *sides[i] = static_cast<int>(params_.dimensions_m[i]);
  return report;
}

void Ais::measure(const sim::SenseContext& context) {
  const sim::Vector3d& p_W = context.X_WS.translation();
  fix_.valid = !context.world.zones().denied(sim::ZoneFlag::gps_denied, p_W) && !world_.medium().in_water(p_W);
  fix_.p_W = p_W;
  const sim::Vector3d v_E = world_.geodesy().local_axes_W(p_W).transpose() * context.v_WS_W;
  fix_.v_W = v_E.head<2>();
  fix_.yaw_rad = sim::yaw_of(context.X_WS.linear());
  fix_.turn_radps = body_.w_WB_W().z();
  messages_.clear();
  std::swap(messages_, arrived_);
}

void Ais::disturb(double dt_s, sim::Random& random) {
  horizontal_noise_.apply(std::span<double>(fix_.p_W.data(), 2), dt_s, random);
  velocity_noise_.apply(std::span<double>(fix_.v_W.data(), 2), dt_s, random);
  heading_noise_.apply(fix_.yaw_rad, dt_s, random);
  // A mean that forgets with a time constant of half of 30 s has the same delay.
  const Eigen::Vector2d heading(std::cos(fix_.yaw_rad), std::sin(fix_.yaw_rad));
  mean_heading_ += (heading - mean_heading_) * (mean_heading_.isZero() ? 1 : std::min(dt_s / 15, 1.0));
}

bool Ais::is_disturbed(const Heard& heard) const {
  return std::any_of(heard_.begin(), heard_.end(), [&](const Heard& other) {
    const Message &a = heard.message, &b = other.message;
    if (&other == &heard || b.slot >= a.slot + a.slots || a.slot >= b.slot + b.slots) return false;
    return b.own || (a.channel == b.channel && other.level_dB > heard.level_dB - capture_dB);
  });
}

void Ais::judge(sim::Time now) {
  // A message is judged when all that overlap it have begun and are known: transmissions are known a step ahead.
  const std::int64_t slot = slot_from(now);
  for (Heard& heard : heard_) {
    if (heard.judged || heard.message.slot + heard.message.slots >= slot) continue;
    heard.judged = true;
    if (!heard.message.own && is_disturbed(heard)) continue;
    if (!heard.message.own)
      for (int i = 0; i < heard.message.slots; ++i) reserved_.reserve(heard.next_slot + i);
    arrived_.push_back(heard.message);
  }
  constexpr std::int64_t longest = 2;  // of the messages
  while (!heard_.empty() && heard_.front().judged && heard_.front().message.slot + 2 * longest < slot)
    heard_.pop_front();
  reserved_.forget_before(slot);
}

void Ais::visit_state(sim::StateArchive& archive) {
  archive(horizontal_noise_, velocity_noise_, heading_noise_, fix_, mean_heading_, position_slot_, static_slot_,
          static_part_, channel_, sent_, reserved_, heard_, arrived_, messages_);
  archive.require(position_slot_, 0, ais_last_slot, "a slot");
  archive.require(static_slot_, 0, ais_last_slot, "a slot");
  archive.require(channel_, 0, 1, "a channel");
  archive.require(sent_, 0, ais_last_slot, "a number of messages");
}

void AisReporter::report(sim::Time, sim::Publisher& out) const {
  for (const Ais::Message& each : ais_.messages()) {
    const AisReport& report = each.report;
    shoal::ais_t message{};
    message.utime = out.utime(each.end);
    message.own = each.own;
    message.type = static_cast<std::int8_t>(report.type);
    message.part = static_cast<std::int8_t>(report.part);
    message.radio_channel = static_cast<std::int8_t>(each.channel);
    message.slot = static_cast<std::int32_t>(each.slot % ais_slots_per_minute);
    message.mmsi = report.mmsi;
    message.status = static_cast<std::int8_t>(report.status);
    message.latitude = report.latitude_deg;
    message.longitude = report.longitude_deg;
    message.speed_mps = report.speed_mps;
    message.course_rad = report.course_rad;
    message.heading_rad = report.heading_rad;
    message.turn_radps = report.turn_radps;
    message.imo = report.imo;
    message.name = report.name;
    message.call_sign = report.call_sign;
    message.destination = report.destination;
    message.ship_type = static_cast<std::int16_t>(report.ship_type);
    message.bow_m = static_cast<std::int16_t>(report.bow_m);
    message.stern_m = static_cast<std::int16_t>(report.stern_m);
    message.port_m = static_cast<std::int16_t>(report.port_m);
    message.starboard_m = static_cast<std::int16_t>(report.starboard_m);
    message.draught_m = report.draught_m;
    shoal::encode_into(message, out.buffer());
    out.publish(out.buffer());
  }
}

SHOAL_SENSOR("ais", Ais, AisReporter);

}  // namespace devices
