// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_inputs.hpp"

#include "shoal/message_codec.hpp"
#include "sim/base/log.hpp"

namespace experiment {

std::size_t RunInputs::Saved::bytes() const {
  return sizeof *this + input.bus.size() + input.channel.size() + input.payload.size();
}

void RunInputs::keep(std::size_t max_bytes, std::function<void()> too_much) {
  journal_.set_listener(
      [this, max_bytes, too_much = std::move(too_much)](std::int64_t step, const bridges::RunJournal::Input& input) {
        kept_.push_back({step, input});
        bytes_ += kept_.back().bytes();
        if (bytes_ > max_bytes) too_much();
      });
}

void RunInputs::discard_before(std::int64_t step) {
  while (!kept_.empty() && kept_.front().step < step) {
    bytes_ -= kept_.front().bytes();
    kept_.pop_front();
  }
}

void RunInputs::discard_from(std::int64_t step) {
  while (!kept_.empty() && kept_.back().step >= step) {
    bytes_ -= kept_.back().bytes();
    kept_.pop_back();
  }
}

void RunInputs::restart_replay(std::int64_t from_step) {
  buses_.set_muted(true);
  journal_.mute(true);
  service_.set_muted(true);
  lockstep_.suspend(true);
  next_ = 0;
  while (next_ < kept_.size() && kept_[next_].step < from_step) ++next_;
  for (const Saved& kept : kept_)
    if (kept.input.bus == bridges::RunJournal::serial_bus)
      journal_.serial_inputs().add(kept.step, kept.input.channel, kept.input.payload);
}

void RunInputs::deliver(std::int64_t step) {
  journal_.begin_step();
  for (; next_ < kept_.size() && kept_[next_].step <= step; ++next_) deliver(kept_[next_].input);
  buses_.admit([](const std::string&, std::span<const sim::MessageGate::Delivery>) {});
}

void RunInputs::deliver(const bridges::RunJournal::Input& input) {
  if (input.bus == bridges::RunJournal::serial_bus) return;  // read by the ports
  if (!input.bus.empty() || input.channel != bridges::RunJournal::request_channel) {
    buses_.gate(input.bus).waiting().push_back({input.channel, input.payload});
    return;
  }
  try {
    service_.execute_again(shoal::decode<shoal::sim_control_request_t>(input.payload, shoal::Finite::any));
  } catch (const std::exception& error) {  // it was rejected the first time as well
    sim::log_debug("again: {}", error.what());
  }
}

void RunInputs::end_replay() {
  lockstep_.suspend(false);
  service_.set_muted(false);
  journal_.mute(false);
  buses_.set_muted(false);
}

}  // namespace experiment
