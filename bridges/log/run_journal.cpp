// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/run_journal.hpp"

#include <utility>

#include "shoal/message_codec.hpp"
#include "shoal/sim_hash_t.hpp"
#include "sim/world/world_state.hpp"

namespace bridges {

namespace {

/// Approximate size limit of one sim.inputs; the maximum of LCM is 16 MB.
constexpr std::size_t max_bytes = std::size_t{1} << 20;

}  // namespace

void SerialInputs::add(std::int64_t step, const std::string& path, sim::Bytes bytes) {
  waiting_[path].emplace_back(step, std::move(bytes));
}

sim::Bytes SerialInputs::read(const std::string& path, std::int64_t step) {
  const auto known = waiting_.find(path);
  if (known == waiting_.end()) return {};
  auto& inputs = known->second;
  while (!inputs.empty() && inputs.front().first < step) inputs.pop_front();
  if (inputs.empty() || inputs.front().first != step) return {};
  sim::Bytes bytes = std::move(inputs.front().second);
  inputs.pop_front();
  return bytes;
}

/// Serial port that records its input.
class JournalPorts::Port final : public sim::BytePort {
 public:
  Port(JournalPorts& ports, std::string path, std::unique_ptr<sim::BytePort> inner)
      : ports_(ports), path_(std::move(path)), inner_(std::move(inner)) {}

  sim::Bytes read() override {
    if (ports_.muted_) return ports_.inputs_.read(path_, ports_.step_);
    sim::Bytes bytes = inner_->read();
    if (!bytes.empty()) ports_.read_.push_back({ports_.step_, path_, bytes});
    return bytes;
  }
  void write(std::span<const std::byte> bytes) override {
    if (!ports_.muted_) inner_->write(bytes);
  }
  std::uint64_t dropped_bytes() const override { return inner_->dropped_bytes(); }

 private:
  JournalPorts& ports_;
  std::string path_;
  std::unique_ptr<sim::BytePort> inner_;
};

sim::PortOpener JournalPorts::wrap(sim::PortOpener open) {
  if (!open) return {};
  return [this, open = std::move(open)](sim::PortKind kind, const std::string& path) -> std::unique_ptr<sim::BytePort> {
    return std::make_unique<Port>(*this, path, open(kind, path));
  };
}

RunJournal::RunJournal(sim::Bus& bus, const sim::World& world, JournalPorts& ports, std::function<bool()> is_observed)
    : bus_(bus),
      world_(world),
      ports_(ports),
      every_steps_(world.config().run.hash_every_steps),
      is_observed_(std::move(is_observed)) {
  begin_step();
}

void RunJournal::admitted(const std::string& bus, std::span<const sim::MessageGate::Delivery> input_record) {
  for (const sim::MessageGate::Delivery& each : input_record) input(bus, each.channel, each.payload);
}

void RunJournal::request(const shoal::sim_control_request_t& request) {
  shoal::encode_into(request, buffer_);
  input("", request_channel, buffer_);
}

void RunJournal::input(const std::string& bus, const std::string& channel, std::span<const std::byte> payload) {
  take_readings();
  add(step(), bus, channel, payload);
}

void RunJournal::take_readings() {
  for (const JournalPorts::Reading& reading : ports_.take()) add(reading.step, serial_bus, reading.path, reading.bytes);
}

void RunJournal::add(std::int64_t step, const std::string& bus, const std::string& channel,
                     std::span<const std::byte> payload) {
  if (muted_) return;
  if (listener_) listener_(step, {bus, channel, sim::Bytes(payload.begin(), payload.end())});
  // Split before LCM's limit of a message; a reader puts the parts together by `sequence`.
  if (!waiting_.empty() && waiting_bytes_ + payload.size() > max_bytes) publish_inputs();
  shoal::sim_input_t input{};
  input.step = step;
  input.bus = bus;
  input.channel = channel;
  input.size = static_cast<std::int32_t>(payload.size());
  const auto* begin = reinterpret_cast<const std::uint8_t*>(payload.data());
  input.data.assign(begin, begin + payload.size());
  waiting_.push_back(std::move(input));
  waiting_bytes_ += payload.size();
}

void RunJournal::after_step() {
  begin_step();
  if (muted_) return;
  take_readings();
  if (!waiting_.empty()) publish_inputs();
  if (every_steps_ > 0 && world_.step_number() % every_steps_ == 0) publish_hash();
}

void RunJournal::finish(bool step_is_whole) {
  if (muted_) return;
  take_readings();
  if (!waiting_.empty()) publish_inputs();
  if (!step_is_whole || !started_ || last_hash_step_ == world_.step_number()) return;
  if (every_steps_ > 0) return publish_hash();
  if (is_observed_ && !is_observed_()) return;
  publish_inputs();  // without inputs: marks that a log with it is not truncated
  last_hash_step_ = world_.step_number();
}

void RunJournal::start_branch(std::int32_t branch, std::int64_t next_sequence) {
  begin_step();
  branch_ = branch;
  sequence_ = next_sequence;
  waiting_.clear();
  waiting_bytes_ = 0;
  last_hash_step_ = -1;
}

void RunJournal::publish_inputs() {
  shoal::sim_inputs_t message{};
  message.utime = world_.epoch_us() + world_.now().count();
  message.step = world_.step_number();
  message.sequence = sequence_++;
  message.branch = branch_;
  message.count = static_cast<std::int32_t>(waiting_.size());
  message.input = std::move(waiting_);
  waiting_.clear();
  waiting_bytes_ = 0;
  shoal::encode_into(message, buffer_);
  bus_.publish("sim.inputs", buffer_, world_.now());
}

void RunJournal::publish_hash() {
  if (is_observed_ && !is_observed_()) return;
  shoal::sim_hash_t message{};
  message.utime = world_.epoch_us() + world_.now().count();
  message.step = world_.step_number();
  message.branch = branch_;
  message.input_sequence = sequence_;
  sim::StateHash whole;  // WorldState::hash() is the hash of the hashes of all parts, so that one pass over the state
                         // is sufficient
  for (const sim::PartHash& part : world_.state().part_hashes()) {
    whole.add(part.hash);
    message.part.push_back(part.part);
    message.part_hash.push_back(static_cast<std::int64_t>(part.hash));
  }
  message.hash = static_cast<std::int64_t>(whole.value());
  message.part.push_back(run_hash_part);
  message.part_hash.push_back(static_cast<std::int64_t>(world_.state().run_hash(whole.value())));
  message.count = static_cast<std::int32_t>(message.part.size());
  shoal::encode_into(message, buffer_);
  bus_.publish("sim.hash", buffer_, world_.now());
  last_hash_step_ = world_.step_number();
}

}  // namespace bridges
