// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_record.hpp"

#include <algorithm>
#include <limits>

#include "bridges/mcap/mcap_reader.hpp"
#include "bridges/ros2/cdr_transcoder.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "bridges/ros2/standard_types.hpp"
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

std::uint64_t ns_of(std::int64_t utime) {
  return static_cast<std::uint64_t>(
      std::clamp<std::int64_t>(utime, 0, std::numeric_limits<std::int64_t>::max() / ns_per_us) * ns_per_us);
}

}  // namespace

McapRecord::McapRecord(FileDescriptor file, const shoal::MessageTypes& types) : types_(types), file_(std::move(file)) {}

bool McapRecord::write(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
  const std::uint64_t time_ns = ns_of(utime);
  const shoal::MessageSchema* schema = types_.find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  // Keep what cannot be transcoded.
  if (schema == nullptr) return write_raw(channel, time_ns, payload);
  if (const auto error = ros2::to_cdr(*schema, payload, cdr_)) {
    report(std::string(channel) + ": " + *error);
    return write_raw(channel, time_ns, payload);
  }
  // Write the message to its topics.
  if (channel == "sim.info" && schema->name == "shoal.sim_info_t" && !write_info(time_ns, payload)) return false;
  Route* route = route_of(channel, *schema);
  if (route == nullptr) return true;
  return file_.write(route->channel, time_ns, cdr_) && write_standard(*route, channel, time_ns, payload);
}

McapRecord::Route* McapRecord::route_of(std::string_view channel, const shoal::MessageSchema& schema) {
  const auto of_channel = routes_.find(channel);
  if (of_channel != routes_.end())
    if (const auto known = of_channel->second.find(schema.fingerprint); known != of_channel->second.end())
      return &known->second;
  Route route;
  route.schema = &schema;
  const std::string type = ros2::type_name(schema.name);
  const std::uint16_t number = file_.add_schema({type, "ros2msg", ros2::schema_text(schema)});
  if (number > 0)
    route.channel = file_.add_channel(
        {number,
         own_topic(ros2::topic_of(channel), std::string(channel) + " " + type),
         "cdr",
         {{"lcm_channel", std::string(channel)}, {"lcm_type", schema.name}, {"offered_qos_profiles", ""}}});
  if (route.channel == 0) {
    report(std::string(channel) + ": more than 65535 channels are not recorded");
    return nullptr;
  }
  for (const ros2::Converter* converter : ros2::ConverterTable::instance().of(schema.name))
    route.standard.push_back({converter, 0});
  return &routes_[std::string(channel)].emplace(schema.fingerprint, std::move(route)).first->second;
}

bool McapRecord::write_standard(Route& route, std::string_view channel, std::uint64_t time_ns,
                                std::span<const std::byte> payload) {
  for (Route::Standard& each : route.standard) {
    if (!each.converter->convert(payload, channel, context_, cdr_)) continue;
    if (each.channel == 0) each.channel = standard_channel(*each.converter, channel);
    if (each.channel != 0 && !file_.write(each.channel, time_ns, cdr_)) return false;
  }
  return true;
}

std::uint16_t McapRecord::standard_channel(const ros2::Converter& converter, std::string_view channel) {
  const bool common = converter.topic.starts_with('/');
  const std::string topic = converter.topic_for(channel);
  if (common)
    if (const auto known = common_channels_.find(topic); known != common_channels_.end()) return known->second;
  const std::uint16_t schema =
      file_.add_schema({converter.ros_type, "ros2msg", ros2::standard_schema_text(converter.ros_type)});
  if (schema == 0) return 0;
  const std::string owner = (common ? "" : std::string(channel)) + " " + converter.ros_type;
  TextMap metadata{{"offered_qos_profiles", topic == "/tf_static" ? static_qos : ""}};
  if (!common) metadata.emplace("lcm_channel", channel);
  const std::uint16_t number = file_.add_channel({schema, own_topic(topic, owner), "cdr", std::move(metadata)});
  if (common) common_channels_.emplace(topic, number);
  return number;
}

bool McapRecord::write_raw(std::string_view channel, std::uint64_t time_ns, std::span<const std::byte> payload) {
  ++not_decoded_;
  auto known = raw_channels_.find(channel);
  if (known == raw_channels_.end()) {
    const std::string topic = own_topic(ros2::topic_of(channel) + "/bytes", std::string(channel) + " lcm");
    const std::uint16_t number = file_.add_channel({0, topic, "lcm", {{"lcm_channel", std::string(channel)}}});
    if (number == 0) return true;
    report(std::string(channel) + ": messages that cannot be decoded are recorded as bytes on " + topic);
    known = raw_channels_.emplace(channel, number).first;
  }
  return file_.write(known->second, time_ns, payload);
}

std::string McapRecord::own_topic(const std::string& topic, const std::string& owner) {
  std::string own = topic;
  for (int number = 2;; ++number) {
    const auto [known, fresh] = topic_owners_.emplace(own, owner);
    if (fresh || known->second == owner) return own;
    own = topic + "_" + std::to_string(number);
  }
}

bool McapRecord::write_info(std::uint64_t time_ns, std::span<const std::byte> payload) {
  const auto info = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::any);
  if (branch_ == info.branch) return true;
  if (!branch_ && !file_.write(Attachment{time_ns, time_ns, "world.yaml", "application/yaml", info.resolved_config}))
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
  next->routes_ = routes_;
  next->raw_channels_ = raw_channels_;
  next->common_channels_ = common_channels_;
  next->topic_owners_ = topic_owners_;
  next->context_ = context_;
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
