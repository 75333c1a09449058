// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/run/run_mail.hpp"

#include <spdlog/spdlog.h>

#include "shoal/message_codec.hpp"

namespace tools {

std::size_t RunMail::Kept::bytes() const {
  return sizeof *this + letter.bus.size() + letter.channel.size() + letter.payload.size();
}

void RunMail::keep(std::size_t most_bytes, std::function<void()> too_much) {
  journal_.set_listener(
      [this, most_bytes, too_much = std::move(too_much)](std::int64_t step, const bridges::RunJournal::Letter& letter) {
        kept_.push_back({step, letter});
        bytes_ += kept_.back().bytes();
        if (bytes_ > most_bytes) too_much();
      });
}

void RunMail::forget_before(std::int64_t step) {
  while (!kept_.empty() && kept_.front().step < step) {
    bytes_ -= kept_.front().bytes();
    kept_.pop_front();
  }
}

void RunMail::forget_from(std::int64_t step) {
  while (!kept_.empty() && kept_.back().step >= step) {
    bytes_ -= kept_.back().bytes();
    kept_.pop_back();
  }
}

void RunMail::begin_again(std::int64_t from_step) {
  buses_.set_muted(true);
  journal_.mute(true);
  service_.set_muted(true);
  lockstep_.suspend(true);
  next_ = 0;
  while (next_ < kept_.size() && kept_[next_].step < from_step) ++next_;
  for (const Kept& kept : kept_)
    if (kept.letter.bus == bridges::RunJournal::serial_bus)
      journal_.serial_mail().add(kept.step, kept.letter.channel, kept.letter.payload);
}

void RunMail::deliver(std::int64_t step) {
  journal_.begin_step();
  for (; next_ < kept_.size() && kept_[next_].step <= step; ++next_) deliver(kept_[next_].letter);
  buses_.admit([](const std::string&, std::span<const sim::MailGate::Mail>) {});
}

void RunMail::deliver(const bridges::RunJournal::Letter& letter) {
  if (letter.bus == bridges::RunJournal::serial_bus) return;  // the ports read it
  if (!letter.bus.empty() || letter.channel != bridges::RunJournal::request_channel) {
    buses_.gate(letter.bus).waiting().push_back({letter.channel, letter.payload});
    return;
  }
  try {
    service_.obey_again(shoal::decode<shoal::sim_control_request_t>(letter.payload, shoal::Finite::any));
  } catch (const std::exception& error) {  // it was refused the first time as well
    spdlog::debug("again: {}", error.what());
  }
}

void RunMail::end_again() {
  lockstep_.suspend(false);
  service_.set_muted(false);
  journal_.mute(false);
  buses_.set_muted(false);
}

}  // namespace tools
