// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/modem.hpp"

#include <algorithm>
#include <stdexcept>

#include "shoal/message_codec.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// Modems of a world, in device order.
class Modem::Network {
 public:
  void join(Modem& modem) { members_.push_back(&modem); }
  void leave(Modem& modem) { std::erase(members_, &modem); }
  const std::vector<Modem*>& members() const { return members_; }

 private:
  std::vector<Modem*> members_;
};

const sim::SharedKind<Modem::Network> Modem::network_of_world;

void Modem::Params::read(sim::ParamReader& in) {
  in.read("network", network, "only modems of the same network, such as a radio channel, receive each other");
  read_through(in, through);
  in.read("range_m", range_m, sim::above(0), "maximum range of reception");
  in.read("data_rate_bps", data_rate_bps, sim::between(1e-3, 1e12), "bits per second");
  in.read("propagation_mps", propagation_mps, sim::between(1, 1e12),
          "speed of the signal; unset: 299792458, for an acoustic one that of sound at the sender");
  in.read("loss_probability", loss_probability, sim::between(0, 1),
          "loss probability of each message at each receiver");
  in.read("line_of_sight", line_of_sight,
          "objects between the antennas block the signal; the two vehicles themselves do not");
  in.read("queue_messages", queue_messages, sim::at_least(1), "messages waiting to be sent; the oldest is dropped");
  in.read("max_message_bytes", max_message_bytes, sim::between(1, 1 << 20), "maximum length of a message");
  in.read("serial", serial, "pseudo-terminal or FIFO for programs that use no LCM");
}

Modem::Modem(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      host_(context.host),
      network_(context.shared(network_of_world)),
      vehicle_(context.vehicle.name()),
      clock_(context.vehicle.clock()),
      full_name_(context.full_name()),
      seed_(context.world.seed()),
      device_(context.number),
      group_(context.vehicle.group()),
      body_(context.body),
      p_BS_(context.config.position_m) {
  if (params.through == SignalCarrier::acoustic && !context.world.medium().has_water())
    sim::throw_config_error(context.config.place, "vehicle '" + vehicle_ + "': device '" + context.config.name + "'",
                            "'through: acoustic' needs water to carry its sound: the world has no 'medium: {water: "
                            "...}'");
  if (params.serial) serial_ = std::make_unique<SerialMessages>(*params.serial, context);
  // Open the port last, because a failure throws.
  network_.join(*this);
  host_.shared.of(message_modems).join(full_name_, *this);
}

Modem::~Modem() {
  host_.shared.of(message_modems).leave(full_name_);
  network_.leave(*this);
}

sim::Vector3d Modem::p_WS() const {
  return body_.X_WB() * p_BS_;
}

void Modem::send(sim::Time, std::string destination, sim::Bytes data) {
  if (data.empty()) throw std::runtime_error("a message must have at least 1 byte");
  if (data.size() > static_cast<std::size_t>(params_.max_message_bytes))
    throw std::runtime_error("a message must have at most " + std::to_string(params_.max_message_bytes) +
                             " bytes, got " + std::to_string(data.size()));
  const auto& members = network_.members();
  const bool known =
      destination.empty() || std::any_of(members.begin(), members.end(), [&](const Modem* other) {
        return other != this && other->vehicle_ == destination && other->params_.network == params_.network;
      });
  if (!known)
    throw std::runtime_error("'destination' names no vehicle with a modem in network '" + params_.network + "': '" +
                             sim::shortened(sim::printable(destination)) + "'");
  // The oldest message gives way, so that a slow link carries the latest news.
  if (queue_.size() >= static_cast<std::size_t>(params_.queue_messages)) {
    queue_.pop_front();
    ++dropped_;
  }
  queue_.push_back({std::move(destination), std::move(data)});
}

void Modem::act(const sim::ActContext& context) {
  const sim::Time now = context.now;
  if (serial_) read_serial(now);
  // Several short messages may be sent in a step, each when the previous one has ended.
  const sim::Time end = now + sim::from_seconds(context.step_s);
  for (sim::Time start = std::max(now, busy_until_); !queue_.empty() && start < end; start = busy_until_) {
    const Outgoing message = std::move(queue_.front());
    queue_.pop_front();
    transmit(start, message);
  }
}

void Modem::transmit(sim::Time now, const Outgoing& message) {
  // Occupy the modem for the transmission.
  const double air_time_s = 8.0 * static_cast<double>(message.data.size()) / params_.data_rate_bps;
  busy_until_ = now + std::max(sim::from_seconds(air_time_s), sim::Time{1});
  ++sent_;
  // The frame between modems is a modem_received_t; the copy of the receiver is completed on arrival.  Its utime
  // contains the error of the clock of the sender.
  shoal::modem_received_t frame{};
  frame.sent_utime = now.count();
  frame.source = vehicle_;
  frame.destination = message.destination;
  frame.size = static_cast<std::int32_t>(message.data.size());
  frame.data.assign(reinterpret_cast<const std::uint8_t*>(message.data.data()),
                    reinterpret_cast<const std::uint8_t*>(message.data.data()) + message.data.size());
  frame.utime = (clock_.reading(now) - now).count();
  const sim::Bytes payload = shoal::encode(frame);
  ++counts_.sent;
  counts_.sent_bytes += frame.size;
  // Deliver to each addressed modem in range after the propagation delay.
  for (Modem* receiver : network_.members()) {
    if (receiver == this || receiver->params_.network != params_.network) continue;
    if (!message.destination.empty() && receiver->vehicle_ != message.destination) continue;
    if (const sim::SignalLoss loss = loss_to(*receiver); loss != sim::SignalLoss::none) {
      ++receiver->counts_.lost[static_cast<std::size_t>(loss)];
      continue;
    }
    const double distance_m = (receiver->p_WS() - p_WS()).norm();
    const sim::Time due = now + sim::from_seconds(air_time_s + distance_m / propagation_mps());
    host_.schedule_arrival(receiver->device_, due, payload);
  }
}

sim::SignalLoss Modem::loss_to(const Modem& receiver) const {
  const sim::Zones& zones = world_.zones();
  const sim::Medium& medium = world_.medium();
  for (const Modem* end : {this, &receiver}) {
    // Cheap tests first: the ray through the world is the last.
    if (zones.denied(sim::ZoneFlag::radio_denied, end->p_WS())) return sim::SignalLoss::noise;
    if (!carries(medium, params_.through, end->p_WS())) return sim::SignalLoss::blocked;
  }
  if ((receiver.p_WS() - p_WS()).norm() > params_.range_m) return sim::SignalLoss::range;
  if (lost_in_transit_to(receiver)) return sim::SignalLoss::link;
  if (params_.line_of_sight && hidden_from(receiver)) return sim::SignalLoss::blocked;
  return sim::SignalLoss::none;
}

double Modem::propagation_mps() const {
  constexpr double light_mps = 299792458.0;
  if (params_.propagation_mps) return *params_.propagation_mps;
  return params_.through == SignalCarrier::acoustic ? world_.medium().sound_speed_mps(p_WS()) : light_mps;
}

bool Modem::lost_in_transit_to(const Modem& receiver) const {
  if (params_.loss_probability <= 0) return false;
  // One random stream for each pair, so that an additional modem does not change other links.
  sim::Random link(seed_, full_name_ + ">" + receiver.full_name_);
  link.begin_step(sent_);
  return link.uniform() < params_.loss_probability;
}

bool Modem::hidden_from(const Modem& receiver) const {
  sim::RayFilter filter;
  filter.exclude_group = group_;
  const sim::Vector3d displacement_W = receiver.p_WS() - p_WS();
  const double length_m = displacement_W.norm();
  if (length_m < 1e-3) return false;
  const sim::PhysicsWorld& physics = world_.physics();
  const auto hit = physics.scene().cast(p_WS(), displacement_W / length_m, length_m - 1e-3, filter);
  return hit && physics.parts()[static_cast<std::size_t>(hit->part)].group != receiver.group_;
}

void Modem::arrive(sim::Time at, std::span<const std::byte> payload) {
  const auto frame = shoal::decode<shoal::modem_received_t>(payload, shoal::Finite::any);
  const sim::Time sent{frame.sent_utime};
  Packet packet{frame.source, frame.destination, sent, at, sent + sim::Time{frame.utime}, {}};
  const auto* data = reinterpret_cast<const std::byte*>(frame.data.data());
  packet.data.assign(data, data + frame.data.size());
  ++counts_.received;
  if (serial_) serial_->write(packet.data);
  report_to_tap(at, packet.source, packet.data);
  arrived_.push_back(std::move(packet));
}

void Modem::measure(const sim::SenseContext&) {
  received_.clear();
  std::swap(received_, arrived_);
}

void Modem::visit_state(sim::StateArchive& archive) {
  archive(queue_, arrived_, received_, busy_until_, sent_);
  archive.unhashed(dropped_, counts_);
  if (serial_) archive(*serial_);
}

void Modem::read_serial(sim::Time now) {
  for (sim::Bytes& data : serial_->take(message_limit_bytes()))
    if (data.size() > message_limit_bytes())
      warn_of_length(host_.warnings, full_name_, message_limit_bytes());
    else
      send(now, "", std::move(data));
}

void ModemReporter::report(sim::Time, sim::Publisher& out) const {
  for (const Modem::Packet& packet : modem_.received()) {
    shoal::modem_received_t message{};
    message.utime = out.utime(packet.arrived);
    message.sent_utime = out.utime_elsewhere(packet.sent, packet.sent_reading);
    message.source = packet.source;
    message.destination = packet.destination;
    message.size = static_cast<std::int32_t>(packet.data.size());
    const auto* data = reinterpret_cast<const std::uint8_t*>(packet.data.data());
    message.data.assign(data, data + packet.data.size());
    shoal::encode_into(message, out.buffer());
    out.publish(out.buffer());
  }
}

void ModemController::receive(sim::Time now, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::modem_send_t>(payload, shoal::Finite::required);
  const auto* data = reinterpret_cast<const std::byte*>(command.data.data());
  modem_.send(now, command.destination, sim::Bytes(data, data + command.data.size()));
}

SHOAL_TRANSCEIVER("modem", Modem, ModemReporter, ModemController);

}  // namespace devices
