// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ClockPubSubTypes.h"
#include "ImagePubSubTypes.h"
#include "ImuPubSubTypes.h"
#include "OdometryPubSubTypes.h"
#include "TickPubSubTypes.h"
#include "TwistPubSubTypes.h"
#include "TwistStampedPubSubTypes.h"
#include "servicesPubSubTypes.h"

// ros2_judge DOMAIN drive VEHICLE         drives a vehicle by its odometry until it is 0.3 m ahead
// ros2_judge DOMAIN imu|image TOPIC COUNT receives so many messages; prints how many stamps came in a wrong order
// ros2_judge DOMAIN lockstep NODE VEHICLE answers each tick with commands that depend on the odometry, to the last one
// ros2_judge DOMAIN step COUNT            calls /shoal/step_simulation, and prints what it responds

namespace {

namespace dds = eprosima::fastdds::dds;
using namespace std::chrono_literals;

/// With default settings, or those of FASTRTPS_DEFAULT_PROFILES_FILE.
struct Participant {
  explicit Participant(int domain)
      : made(dds::DomainParticipantFactory::get_instance()->create_participant(static_cast<std::uint32_t>(domain),
                                                                               dds::PARTICIPANT_QOS_DEFAULT)),
        subscriber(made->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)),
        publisher(made->create_publisher(dds::PUBLISHER_QOS_DEFAULT)) {}
  ~Participant() {
    made->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(made);
  }
  dds::Topic* topic(const std::string& name, dds::TopicDataType* type) {
    const dds::TypeSupport support(type);
    support.register_type(made);
    return made->create_topic(name, support.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  }

  dds::DomainParticipant* made;
  dds::Subscriber* subscriber;
  dds::Publisher* publisher;
};

/// Reads messages of a topic in a thread of Fast DDS, and calls `take` with each.
template <class Type>
class Reader final : public dds::DataReaderListener {
 public:
  using Message = typename Type::type;

  /// `kept`: also those that were sent before it was there.
  Reader(Participant& participant, const std::string& topic, std::function<void(const Message&)> take, bool reliable,
         bool kept = false)
      : take_(std::move(take)) {
    dds::DataReaderQos qos;
    qos.reliability().kind = reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
    if (kept) qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.history().depth = kept ? 1000 : 10;
    reader_ = participant.subscriber->create_datareader(participant.topic(topic, new Type), qos, this);
  }
  void on_data_available(dds::DataReader* reader) override {
    Message message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK)
      if (info.valid_data) take_(message);
  }

 private:
  std::function<void(const Message&)> take_;
  dds::DataReader* reader_;
};

bool await(const std::function<bool()>& holds, const std::function<void()>& meanwhile = {},
           std::chrono::seconds limit = 180s) {
  for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;) {
    if (holds()) return true;
    if (meanwhile) meanwhile();
    std::this_thread::sleep_for(20ms);
  }
  return false;
}

int drive(int domain, const std::string& vehicle) {
  struct Seen {
    int clocks = 0, imus = 0, odometries = 0;
    std::int64_t clock_s = 0;
    double gravity_mps2 = 0, x_m = 0, start_m = 0;
    std::string frame, child;
  } seen;
  std::mutex mutex;
  const auto now = [&] {
    const std::scoped_lock lock(mutex);
    return seen;
  };
  Participant participant(domain);
  const std::string topics = "rt/" + vehicle;
  const Reader<rosgraph_msgs::msg::ClockPubSubType> clock(
      participant, "rt/clock",
      [&](const auto& message) {
        const std::scoped_lock lock(mutex);
        ++seen.clocks;
        seen.clock_s = message.clock().sec();
      },
      false);
  const Reader<sensor_msgs::msg::ImuPubSubType> imu(
      participant, topics + "/imu/imu",
      [&](const auto& message) {
        const std::scoped_lock lock(mutex);
        ++seen.imus;
        seen.frame = message.header().frame_id();
        seen.gravity_mps2 = message.linear_acceleration().z();
      },
      false);
  const Reader<nav_msgs::msg::OdometryPubSubType> odometry(
      participant, topics + "/odometry/odometry",
      [&](const auto& message) {
        const std::scoped_lock lock(mutex);
        if (++seen.odometries == 1) seen.start_m = message.pose().pose().position().x();
        seen.x_m = message.pose().pose().position().x();
        seen.child = message.child_frame_id();
      },
      true);
  if (!await([&] { return now().clocks > 0 && now().imus > 0 && now().odometries > 0; })) return 1;
  auto* writer = participant.publisher->create_datawriter(
      participant.topic(topics + "/cmd_vel", new geometry_msgs::msg::TwistPubSubType), dds::DATAWRITER_QOS_DEFAULT);
  geometry_msgs::msg::Twist ahead;
  ahead.linear().x(0.5);
  if (!await([&] { return now().x_m > now().start_m + 0.3; }, [&] { writer->write(&ahead); })) return 1;
  const Seen end = now();
  std::cout << "frame " << end.frame << ", child frame " << end.child << ", gravity " << std::lround(end.gravity_mps2)
            << " m/s2, clock " << end.clock_s << " s" << std::endl;
  return 0;
}

/// Writes to a topic as soon as the door has found this writer.
template <class Type>
class Writer {
 public:
  Writer(Participant& participant, const std::string& topic)
      : writer_(participant.publisher->create_datawriter(participant.topic(topic, new Type),
                                                         dds::DATAWRITER_QOS_DEFAULT)) {}
  bool write(typename Type::type message) {
    dds::PublicationMatchedStatus status;
    const auto is_matched = [&] {
      return writer_->get_publication_matched_status(status) == ReturnCode_t::RETCODE_OK && status.current_count > 0;
    };
    return (is_found_ || (is_found_ = await(is_matched))) && writer_->write(&message);
  }

 private:
  dds::DataWriter* writer_;
  bool is_found_ = false;
};

/// Messages of a tick, and what has arrived of them.
class Ticks {
 public:
  using Tick = shoal_interfaces::msg::Tick;

  void take(const Tick& tick) {
    const std::scoped_lock lock(mutex_);
    tick_ = tick;
    const auto& counts = std::exchange(is_first_, false) ? tick.kept() : tick.counts();
    for (std::size_t i = 0; i < tick.topics().size(); ++i) expected_[tick.topics()[i]] += counts[i];
    changed_.notify_all();
  }
  void take(const std::string& topic, const std::function<void()>& change) {
    const std::scoped_lock lock(mutex_);
    change();
    ++received_[topic];
    changed_.notify_all();
  }
  /// Waits for the next tick and its messages on these topics.
  std::optional<Tick> next(const std::vector<std::string>& topics) {
    std::unique_lock lock(mutex_);
    const bool is_there = changed_.wait_for(lock, 180s, [&] {
      return tick_ && std::all_of(topics.begin(), topics.end(),
                                  [&](const std::string& topic) { return received_[topic] >= expected_[topic]; });
    });
    return is_there ? std::exchange(tick_, std::nullopt) : std::nullopt;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Tick> tick_;
  std::map<std::string, std::uint64_t> expected_, received_;
  bool is_first_ = true;
};

/// Two commands in each tick, on two topics, after a random time each: that of the last topic by name is the one that
/// stays.
int keep_step(int domain, const std::string& node, const std::string& vehicle) {
  Participant participant(domain);
  const std::string rover = "/" + vehicle, odometry_topic = rover + "/odometry/odometry";
  Ticks ticks;
  double x_m = 0;
  int answered = 0;
  const Reader<shoal_interfaces::msg::TickPubSubType> clock(
      participant, "rt/shoal/tick", [&](const auto& tick) { ticks.take(tick); }, true, true);
  const Reader<nav_msgs::msg::OdometryPubSubType> odometry(
      participant, "rt" + odometry_topic,
      [&](const auto& message) { ticks.take(odometry_topic, [&] { x_m = message.pose().pose().position().x(); }); },
      true, true);
  Writer<shoal_interfaces::msg::TickPubSubType> answers(participant, "rt/shoal/tick_done");
  Writer<geometry_msgs::msg::TwistPubSubType> twist(participant, "rt" + rover + "/cmd_vel");
  Writer<geometry_msgs::msg::TwistStampedPubSubType> stamped(participant, "rt" + rover + "/cmd_vel_stamped");
  std::mt19937 random{std::random_device{}()};
  while (const auto tick = ticks.next({odometry_topic})) {
    if (tick->last()) {
      std::cout << answered << " ticks, x " << x_m << " m" << std::endl;
      return 0;
    }
    shoal_interfaces::msg::Tick answer = *tick;
    answer.node(node);
    answer.topics({rover + "/cmd_vel", rover + "/cmd_vel_stamped"});
    answer.counts({1, 1});
    geometry_msgs::msg::TwistStamped wanted;
    wanted.twist().linear().x(0.5);
    wanted.twist().angular().z(0.3 * std::sin(3 * x_m));
    const auto pause = [&] { std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000)); };
    const auto send_stamped = [&] { return stamped.write(wanted); };
    const auto send_other = [&] { return twist.write(geometry_msgs::msg::Twist{}); };
    const bool is_stamped_first = random() % 2 == 0;
    pause();
    bool sent = is_stamped_first ? send_stamped() : send_other();
    pause();
    sent = sent && (is_stamped_first ? send_other() : send_stamped());
    if (!sent || !answers.write(answer)) return 1;
    ++answered;
  }
  return 1;
}

int step(int domain, int steps) {
  Participant participant(domain);
  namespace srv = simulation_interfaces::srv;
  std::mutex mutex;
  std::optional<srv::StepSimulation_Response> response;
  const Reader<srv::StepSimulation_ResponsePubSubType> responses(
      participant, "rr/shoal/step_simulationReply",
      [&](const auto& message) {
        const std::scoped_lock lock(mutex);
        response = message;
      },
      true);
  Writer<srv::StepSimulation_RequestPubSubType> requests(participant, "rq/shoal/step_simulationRequest");
  srv::StepSimulation_Request request;
  request.client(11);
  request.call(22);
  request.steps(static_cast<std::uint64_t>(steps));
  const auto has_come = [&] {
    const std::scoped_lock lock(mutex);
    return response.has_value();
  };
  // A call is lost when its reader, which is volatile as all of services are, learns of the writer only after it: a
  // client that has no answer calls again.
  for (int attempt = 0; attempt < 30 && !has_come(); ++attempt) {
    request.call(22 + attempt);
    if (!requests.write(request)) return 1;
    await(has_come, {}, 5s);
  }
  if (!has_come()) return 1;
  std::cout << "client " << response->client() << ", call " << response->call() << ", result "
            << static_cast<int>(response->result()) << " '" << response->error_message() << "'" << std::endl;
  return 0;
}

template <class Type>
int count(int domain, const std::string& topic, int wanted) {
  std::atomic<int> received = 0, disordered = 0;
  std::int64_t last_ns = 0;
  bool is_heard = false;
  Participant participant(domain);
  const Reader<Type> reader(
      participant, "rt" + topic,
      [&](const auto& message) {
        const auto& stamp = message.header().stamp();
        const std::int64_t ns = 1'000'000'000LL * stamp.sec() + stamp.nanosec();
        // A writer may know of a reader after the reader knows of the writer: it counts from the first message on.
        if (ns == 0) {
          if (!std::exchange(is_heard, true)) std::cout << "heard" << std::endl;
          return;
        }
        if (ns <= last_ns) ++disordered;
        last_ns = ns;
        ++received;
      },
      true);
  const bool all = await([&] { return received >= wanted; });
  std::cout << received << " received, " << disordered << " disordered" << std::endl;
  return all && disordered == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int index) {
    if (index >= argc) throw std::invalid_argument("too few arguments");
    return std::string(argv[index]);
  };
  const int domain = std::stoi(argument(1));
  const std::string mode = argument(2);
  if (mode == "drive") return drive(domain, argument(3));
  if (mode == "imu") return count<sensor_msgs::msg::ImuPubSubType>(domain, argument(3), std::stoi(argument(4)));
  if (mode == "image") return count<sensor_msgs::msg::ImagePubSubType>(domain, argument(3), std::stoi(argument(4)));
  if (mode == "lockstep") return keep_step(domain, argument(3), argument(4));
  if (mode == "step") return step(domain, std::stoi(argument(3)));
  throw std::invalid_argument("unknown mode " + mode);
}
