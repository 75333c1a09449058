// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/resimulate/branch_programs.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "experiment/results/run_error.hpp"
#include "sim/config/message_text.hpp"

namespace viewer {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds max_wait{20};

template <std::size_t count>
bool is_one_of(const std::string& command, const std::array<const char*, count>& names) {
  return std::find(names.begin(), names.end(), command) != names.end();
}

}  // namespace

BranchPrograms::BranchPrograms(experiment::ReplayedWorld& replayed, Execute execute)
    : replayed_(replayed), execute_(std::move(execute)) {
  options_.launch = true;
  options_.quiet = true;
  replayed_.service().set_repeating(true);
}

void BranchPrograms::start() {
  stop();
  if (const auto lost = replayed_.buses().lost_connection()) throw experiment::RunError(4, "bus", *lost);
  replayed_.buses().set_muted(false);
  replayed_.service().publish_info();
  replayed_.service().publish_step();
  replayed_.buses().end_of_step();
  programs_ = std::make_unique<experiment::RunPrograms>(replayed_.loaded().config, options_, replayed_.buses(), "");
  synchronized_ = begun_ = false;
  set_acting(false);
  try {
    awaited_ = programs_->start();
  } catch (const experiment::RunError&) {
    stop();
    throw;
  }
  const double timeout_s = replayed_.loaded().config.lockstep.join_timeout_s;
  join_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
}

void BranchPrograms::stop() {
  if (!programs_) return;
  programs_->stop();
  programs_.reset();
  awaited_.clear();
  replayed_.lockstep().remove_all("its branch ended");
  set_acting(false);
  replayed_.buses().set_muted(true);
}

void BranchPrograms::set_acting(bool acting) {
  acting_ = acting;
  replayed_.set_live(acting);
  replayed_.service().set_repeating(!acting);
}

void BranchPrograms::end_of_step() {
  if (!programs_) return;
  replayed_.buses().end_of_step();
  synchronized_ = false;
}

experiment::RunPrograms::Clients BranchPrograms::clients() {
  return {[this](const std::string& client) {
            replayed_.service().handle_requests(this);  // the last request may be to leave
            return replayed_.lockstep().has_left(client);
          },
          [this](const std::string& client) {
            replayed_.service().client_exited(client);
            return !replayed_.lockstep().has(client);
          },
          [this](const std::string& client) {
            return experiment::RunPrograms::Left{replayed_.lockstep().reason_to_leave(client),
                                                 replayed_.lockstep().end_s(client)};
          }};
}

bool BranchPrograms::joined() {
  std::erase_if(awaited_, [this](const std::string& client) {
    return replayed_.lockstep().has(client) || programs_->is_gone(client);
  });
  if (awaited_.empty()) return true;
  if (Clock::now() > join_until_)
    throw experiment::RunError(5, "timeout",
                               fmt::format("lockstep: client '{}' has not joined within {:g} s", awaited_.front(),
                                           replayed_.loaded().config.lockstep.join_timeout_s));
  replayed_.buses().wait(max_wait);
  return false;
}

bool BranchPrograms::ready() {
  replayed_.service().handle_requests(this);
  if (!programs_) return true;
  programs_->check(replayed_.world().now(), clients());
  if (const auto lost = replayed_.buses().lost_connection()) throw experiment::RunError(4, "bus", *lost);
  if (!begun_ && !joined()) return false;
  begun_ = true;
  if (synchronized_) return true;
  const Clock::time_point until = Clock::now() + max_wait;
  const auto outcome = replayed_.lockstep().synchronize([this](milliseconds time) { replayed_.buses().wait(time); },
                                                        [until] { return Clock::now() < until; });
  synchronized_ = outcome == bridges::LockstepOutcome::done;
  return synchronized_;
}

std::string BranchPrograms::waits_for() {
  if (!programs_) return "";
  if (!begun_ && !awaited_.empty()) return "'" + awaited_.front() + "' to join";
  return replayed_.lockstep().waits_for();
}

std::optional<std::string> BranchPrograms::execute(const std::string& command, const std::string& text, double value) {
  static_cast<void>(text);
  static constexpr std::array<const char*, 5> of_programs{"alive", "describe", "follow", "join", "leave"};
  static constexpr std::array<const char*, 3> changes{"do", "remove", "spawn"};
  static constexpr std::array<const char*, 5> of_time{"pause", "resume", "speed", "step", "where"};
  if (is_one_of(command, of_time)) return execute_(command, value);
  if (is_one_of(command, of_programs) || is_one_of(command, changes)) {
    if (!programs_) throw std::runtime_error("'" + command + "': a record is run again, without programs");
    if (is_one_of(command, changes) && !acting_) return "";
    return std::nullopt;
  }
  throw std::runtime_error("'" + sim::shortened(sim::printable(command)) +
                           "' is not possible in a record that is run again: use its page");
}

}  // namespace viewer
