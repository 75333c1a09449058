// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/gateway.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "devices/common/named_vehicle.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/gateway_state_t.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

bool is_modem(const std::string& type) {
  return type == "modem" || type == "acoustic_modem";
}

}  // namespace

void Gateway::Params::read(sim::ParamReader& in) {
  in.require("between");
  in.read("between", between, "two devices of the vehicle of type modem or acoustic_modem");
  in.read("destinations", destinations,
          "vehicles of the world that the first and the second modem send to; empty text: broadcast");
  in.read("delay_s", delay_s, sim::between(0, 3600), "delay between arrival at one and sending by the other");
  in.read("repeat_s", repeat_s, sim::between(0, 86400),
          "time for which the same bytes are not forwarded again; 0: always forwarded");
  in.read("name_source", name_source, "put the name of the sending vehicle and a colon before the bytes");
  in.read("only_prefix", only_prefix, "forward only messages that start with this text; empty: all");
  in.read("queue_messages", queue_messages, sim::at_least(1),
          "maximum number of delayed messages; further ones are rejected");
  if (in.describing()) return;
  if (between.size() != 2 || between[0] == between[1])
    in.error("between", "'between' must name two different devices, got " + std::to_string(between.size()) + " names");
  if (destinations.size() != 2)
    in.error("destinations", "'destinations' must have 2 names, got " + std::to_string(destinations.size()));
}

Gateway::Gateway(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      vehicle_(context.vehicle),
      faults_(context.faults),
      all_modems_(context.shared(message_modems)) {
  const auto fail = [&](const std::string& text) {
    sim::throw_config_error(context.config.place,
                            "vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'", text);
  };
  for (const std::string& name : params.between) {
    const auto& all = context.vehicle.config().devices;
    if (std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == name && is_modem(one.type); }))
      continue;
    fail("'between' names no modem or acoustic_modem '" + name + "'");
  }
  // A modem of two gateways would forward every message twice.
  for (const sim::DeviceConfig& other : context.vehicle.config().devices) {
    if (other.type != "gateway" || other.name == context.config.name) continue;
    const auto& names = static_cast<const sim::detail::ParamsOf<Params>&>(*other.params).params.between;
    for (const std::string& name : params.between)
      if (std::find(names.begin(), names.end(), name) != names.end())
        fail("'" + name + "' already belongs to gateway '" + other.name + "'");
  }
  for (const std::string& name : params.destinations) {
    if (name == context.vehicle.name()) fail("'destinations' names its own vehicle");
    if (!name.empty() && named_vehicle(context.world, name) == nullptr)
      fail("'destinations' names a vehicle that is not in the world: '" + name + "'");
  }
}

void Gateway::find_modems() {
  for (std::size_t i = 0; i < 2; ++i) {
    modems_[i] = all_modems_.find(vehicle_.name() + "/" + params_.between[i]);
    modems_[i]->set_tap(
        [this, i](sim::Time at, const std::string& source, const sim::Bytes& data) { arrived(i, at, source, data); });
  }
}

bool Gateway::is_same(const sim::Bytes& data, const sim::Bytes& seen) const {
  if (data.size() < seen.size() || !std::equal(seen.rbegin(), seen.rend(), data.rbegin())) return false;
  std::string_view names(reinterpret_cast<const char*>(data.data()), data.size() - seen.size());
  if (!names.empty() && !params_.name_source) return false;
  while (!names.empty()) {
    const std::size_t colon = names.find(':');
    if (colon == std::string_view::npos || world_.find_vehicle(std::string(names.substr(0, colon))) == nullptr)
      return false;
    names.remove_prefix(colon + 1);
  }
  return true;
}

bool Gateway::seen_before(sim::Time at, const sim::Bytes& data) {
  if (params_.repeat_s <= 0) return false;
  const sim::Time oldest = at - sim::from_seconds(params_.repeat_s);
  while (!seen_.empty() && (seen_.front().at < oldest || seen_.size() > 1000)) seen_.pop_front();
  return std::any_of(seen_.begin(), seen_.end(), [&](const Seen& seen) { return is_same(data, seen.data); });
}

void Gateway::remember(sim::Time at, const sim::Bytes& data) {
  if (params_.repeat_s > 0 && !seen_before(at, data)) seen_.push_back({at, data});
}

void Gateway::arrived(std::size_t from, sim::Time at, const std::string& source, const sim::Bytes& data) {
  Counts& counts = counting_[from];
  if (!vehicle_.systems().powered || faults_.silent()) return;
  // Filter by prefix and repetition.
  const std::string& prefix = params_.only_prefix;
  const auto* text = reinterpret_cast<const char*>(data.data());
  if (!std::string_view(text, data.size()).starts_with(prefix)) {
    ++counts.refused;
    return;
  }
  if (seen_before(at, data)) {
    ++counts.repeated;
    return;
  }
  // Make the forwarded message.
  Message message{at + sim::from_seconds(params_.delay_s), from, {}};
  if (params_.name_source) {
    const std::string name = source + ":";
    const auto* bytes = reinterpret_cast<const std::byte*>(name.data());
    message.data.assign(bytes, bytes + name.size());
  }
  message.data.insert(message.data.end(), data.begin(), data.end());
  // Check size and queue.
  if (message.data.size() > modems_[1 - from]->message_limit_bytes()) {
    ++counts.too_long;
    return;
  }
  if (waiting_.size() >= static_cast<std::size_t>(params_.queue_messages)) {
    ++counts.refused;
    return;
  }
  remember(at, data);
  // Remember sent messages, too, in case they return through another gateway.
  if (params_.name_source) remember(at, message.data);
  waiting_.push_back(std::move(message));
}

void Gateway::act(const sim::ActContext& context) {
  if (modems_[0] == nullptr) find_modems();
  while (!waiting_.empty() && waiting_.front().due <= context.now) {
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    const std::size_t to = 1 - message.from;
    try {
      modems_[to]->send(context.now, params_.destinations[to], std::move(message.data));
      ++counting_[message.from].passed;
    } catch (const std::runtime_error&) {
      ++counting_[message.from].refused;  // the destination vehicle was removed
    }
  }
}

void Gateway::visit_state(sim::StateArchive& archive) {
  archive(waiting_, seen_, counting_, counts_);
  if (!archive.restoring()) return;
  for (const Message& message : waiting_)
    if (message.from > 1) archive.fail("a gateway has no modem " + std::to_string(message.from));
  // Messages may arrive before the next act().
  if (modems_[0] == nullptr) find_modems();
}

void fill(const Gateway& gateway, shoal::gateway_state_t& message) {
  for (std::size_t i = 0; i < 2; ++i) {
    const Gateway::Counts& counts = gateway.counts()[i];
    message.passed[i] = counts.passed;
    message.too_long[i] = counts.too_long;
    message.repeated[i] = counts.repeated;
    message.refused[i] = counts.refused;
  }
}

SHOAL_SENSOR("gateway", Gateway, shoal::gateway_state_t);

}  // namespace devices
