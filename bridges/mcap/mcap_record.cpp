// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_record.hpp"

#include <cerrno>
#include <ctime>

#include "bridges/mcap/mcap_reader.hpp"
#include "shoal/sim_info_t.hpp"

namespace bridges::mcap {
namespace {

constexpr std::size_t max_problems = 100;
constexpr std::int64_t ns_per_us = 1000;

/// Quality of service for `ros2 bag play`: latched, as tf2 subscribes to it.
constexpr const char* static_qos =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n  deadline:\n    sec: 9223372036\n    nsec: "
    "854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  liveliness: 1\n  liveliness_lease_duration:\n"
    "    sec: 9223372036\n    nsec: 854775807\n  avoid_ros_namespace_conventions: false\n";

std::string utc_text(std::int64_t utime) {
  const std::time_t seconds = static_cast<std::time_t>(utime / 1'000'000 - (utime % 1'000'000 < 0 ? 1 : 0));
  std::tm utc{};
  char text[80];
  if (gmtime_r(&seconds, &utc) == nullptr || std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc) == 0)
    return std::to_string(seconds) + " s since 1970";
  return text;
}

}  // namespace

std::string time_error(std::int64_t utime) {
  if (utime >= 0 && utime <= max_utime) return "";
  return "the time " + utc_text(utime) + " is outside of " + utc_text(0) + " to " + utc_text(max_utime) +
         ", which messages of ROS 2 in an MCAP file can hold";
}

McapRecord::McapRecord(FileDescriptor file, const shoal::MessageTypes& types)
    : types_(types), file_(std::move(file)), topics_(types) {}

bool McapRecord::write(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
  if (utime < 0 || utime > max_utime) {
    errno = EOVERFLOW;
    return false;
  }
  time_ns_ = static_cast<std::uint64_t>(utime * ns_per_us);
  if (channel == "sim.info" && !write_info(payload)) return false;
  return topics_.encode(channel, payload, *this);
}

void McapRecord::learn(std::string_view channel, std::span<const std::byte> payload) {
  ros2::NoTopics nothing;
  if (channel == "sim.scene" || channel == "sim.asset" || channel == "sim.info")
    topics_.encode(channel, payload, nothing);
}

bool McapRecord::take(const ros2::Topic& topic, std::span<const std::byte> bytes) {
  if (topic.encoding == "lcm") ++not_decoded_;
  const std::uint16_t channel = channel_of(topic);
  return channel == 0 || file_.write(channel, time_ns_, bytes);
}

void McapRecord::invalid(std::string_view channel, const std::string& error) {
  report(std::string(channel) + ": " + error);
}

std::uint16_t McapRecord::channel_of(const ros2::Topic& topic) {
  if (channels_.size() <= topic.number) channels_.resize(topic.number + 1);
  if (channels_[topic.number] != 0) return channels_[topic.number];
  // Payloads as they are have no schema.
  const bool is_raw = topic.encoding == "lcm";
  TextMap metadata;
  if (!topic.lcm_channel.empty()) metadata.emplace("lcm_channel", topic.lcm_channel);
  if (!topic.lcm_type.empty()) metadata.emplace("lcm_type", topic.lcm_type);
  if (!is_raw) metadata.emplace("offered_qos_profiles", topic.latched ? static_qos : "");
  const std::uint16_t schema = is_raw ? 0 : file_.add_schema({topic.type, "ros2msg", topic.schema});
  std::uint16_t channel = 0;
  if (is_raw || schema != 0) channel = file_.add_channel({schema, topic.name, topic.encoding, std::move(metadata)});
  if (channel == 0)
    report(topic.name + ": more than 65535 channels are not recorded");
  else if (is_raw)
    report(topic.lcm_channel + ": messages that cannot be decoded are recorded as bytes on " + topic.name);
  return channels_[topic.number] = channel;
}

bool McapRecord::write_info(std::span<const std::byte> payload) {
  const shoal::MessageSchema* schema = types_.find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  if (schema == nullptr || schema->name != "shoal.sim_info_t" || shoal::validate(*schema, payload, shoal::Finite::any))
    return true;
  const auto info = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::any);
  // A run publishes its information every 10 s; only that of a new branch says something new.
  if (branch_ == info.branch) return true;
  if (!branch_ && !file_.write(Attachment{time_ns_, time_ns_, "world.yaml", "application/yaml", info.resolved_config}))
    return false;
  branch_ = info.branch;
  return file_.write(Metadata{"shoal",
                              {{"world", info.world},
                               {"seed", std::to_string(info.seed)},
                               {"step_us", std::to_string(info.step_us)},
                               {"epoch_utime", std::to_string(info.epoch_utime)},
                               {"step", std::to_string(info.step)},
                               {"branch", std::to_string(info.branch)},
                               {"versions", info.versions},
                               {"build", info.build}}});
}

std::unique_ptr<McapRecord> McapRecord::branch(const std::string& path, std::uint64_t messages, FileDescriptor file) {
  auto next = std::make_unique<McapRecord>(std::move(file), types_);
  if (!flush()) return nullptr;
  // Channels keep their numbers, and so do the messages that are copied.
  next->file_.add_all_of(file_);
  next->topics_ = topics_;
  next->channels_ = channels_;
  next->branch_ = branch_;
  McapReader from(path);
  bool written = true;
  while (written && next->file_.messages() < messages) {
    const McapReader::Item item = from.next();
    if (item == McapReader::Item::end) return nullptr;
    if (item == McapReader::Item::attachment) written = next->file_.write(from.attachment());
    if (item == McapReader::Item::metadata) written = next->file_.write(from.metadata());
    if (item == McapReader::Item::message)
      written = next->file_.write(from.message().channel, from.message().log_time_ns, from.message().data);
  }
  return written && next->flush() ? std::move(next) : nullptr;
}

void McapRecord::report(const std::string& problem) {
  if (problems_.size() < max_problems) problems_.push_back(problem);
}

}  // namespace bridges::mcap
