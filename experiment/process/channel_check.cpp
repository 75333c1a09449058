// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/channel_check.hpp"

#include <set>
#include <string>
#include <vector>

#include "experiment/process/process_check.hpp"
#include "sim/config/message_text.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world_file/config_warnings.hpp"

namespace experiment {

namespace {

using Names = std::set<std::string, std::less<>>;

std::string in_quotes(std::string_view name) {
  return "'" + sim::shortened(name) + "'";
}

class ChannelCheck {
 public:
  ChannelCheck(const sim::LoadedWorld& loaded, const sim::World& world, const bridges::ChannelUse& use,
               bool is_recorded, sim::Warnings& warnings)
      : world_(world),
        use_(use),
        is_recorded_(is_recorded),
        warnings_(warnings),
        declared_(channels_of_programs(loaded)) {
    for (const std::string& channel : sim::channels_of(loaded.config)) spoken_.insert(channel);
    Names received;
    for (const std::string& channel : sim::subscribed_channels_of(loaded.config)) received.insert(channel);
    for (const auto& device : world.devices()) {  // also those of vehicles that were added
      if (!device) continue;
      if (device->senses()) {
        spoken_.insert(device->report_channel());
        if (device->config().truth)
          spoken_.insert(sim::device_channel(loaded.config.channels, device->vehicle().name(), device->config(),
                                             sim::ChannelKind::truth));
      }
      if (device->mailbox() != nullptr) received.insert(device->command_channel());
    }
    for (const auto& [client, channels] : use.clients())
      for (const auto& [channel, each] : channels) {
        if (each.published > 0) spoken_.insert(channel);
        if (each.is_subscribed) received.insert(channel);
      }
    for (const auto& [client, channels] : use.clients())
      for (const auto& [channel, each] : channels)
        if (each.published > 0) received.erase(channel);
    unused_.assign(received.begin(), received.end());
  }

  void check() const {
    for (const auto& [client, channels] : use_.clients()) {
      const std::string who = "client " + in_quotes(client);
      std::vector<std::string> unread;
      for (const auto& [channel, each] : channels) {
        // Declared programs are checked before the run, with the line of the world.
        if (declared_.contains(channel) || channel.starts_with("sim.")) continue;
        if (each.published > 0) check_published(who, channel, each, unread);
        if (each.is_subscribed && !each.has_received && !spoken_.contains(channel))
          warnings_.warn({}, who,
                         "it subscribes to " + in_quotes(channel) + ", on which nothing was published" +
                             sim::did_you_mean(channel, {spoken_.begin(), spoken_.end()}));
      }
      if (!unread.empty())
        warnings_.warn(
            {}, who,
            "no device, metric or client of this run receives what it published on " + sim::list_text(unread, 5));
    }
  }

 private:
  /// Adds a channel that nothing reads to `unread`, unless its fault is known.
  void check_published(const std::string& who, const std::string& channel, const bridges::ChannelUse::Use& use,
                       std::vector<std::string>& unread) const {
    const std::string published = "it published " + std::to_string(use.published) +
                                  (use.published == 1 ? " message" : " messages") + " on " + in_quotes(channel);
    for (const auto& device : world_.devices())
      if (device && device->mailbox() != nullptr && device->senses() && device->report_channel() == channel)
        return warnings_.warn({}, who,
                              published + ", where device '" + device->full_name() +
                                  "' reports; it takes commands on " + in_quotes(device->command_channel()));
    if (use.is_read) return;
    const std::string meant = sim::did_you_mean(channel, unused_);
    if (!meant.empty()) return warnings_.warn({}, who, published + ", which nothing reads" + meant);
    if (!is_recorded_ || channel.ends_with(".cmd")) unread.push_back(in_quotes(channel));
  }

  const sim::World& world_;
  const bridges::ChannelUse& use_;
  const bool is_recorded_;
  sim::Warnings& warnings_;
  const std::set<std::string> declared_;
  Names spoken_;                     // published by something
  std::vector<std::string> unused_;  // received by something, and published by no client
};

}  // namespace

void warn_of_channels(const sim::LoadedWorld& loaded, const sim::World& world, const bridges::ChannelUse& use,
                      bool is_recorded, sim::Warnings& warnings) {
  ChannelCheck(loaded, world, use, is_recorded, warnings).check();
}

}  // namespace experiment
