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
    : replayed_(replayed), parts_(replayed.parts()), execute_(std::move(execute)) {
  options_.launch = true;
  options_.quiet = true;
  parts_.service.set_repeating(true);
}

void BranchPrograms::start() {
  stop();
  if (const auto lost = parts_.buses.lost_connection()) throw experiment::RunError(4, "bus", *lost);
  parts_.buses.set_muted(false);
  parts_.service.publish_info();
  parts_.service.publish_step();
  parts_.buses.end_of_step();
  bridges::TimeMachine& time = *this;  // its private base
  programs_ = std::make_unique<experiment::RunPrograms>(options_, parts_, time, "");
  synchronized_ = begun_ = false;
  set_acting(false);
  try {
    awaited_ = programs_->start();
  } catch (const experiment::RunError&) {
    stop();
    throw;
  }
  const double timeout_s = parts_.world.config().lockstep.join_timeout_s;
  join_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
}

void BranchPrograms::stop() {
  if (!programs_) return;
  programs_->stop();
  programs_.reset();
  awaited_.clear();
  parts_.lockstep.remove_all("its branch ended");
  set_acting(false);
  parts_.buses.set_muted(true);
}

void BranchPrograms::set_acting(bool acting) {
  acting_ = acting;
  replayed_.set_live(acting);
  parts_.service.set_repeating(!acting);
}

void BranchPrograms::end_of_step() {
  if (!programs_) return;
  parts_.buses.end_of_step();
  synchronized_ = false;
}

bool BranchPrograms::joined() {
  std::erase_if(awaited_, [this](const std::string& client) {
    return parts_.lockstep.has(client) || programs_->is_gone(client);
  });
  if (awaited_.empty()) return true;
  if (Clock::now() > join_until_)
    throw experiment::RunError(5, "timeout",
                               fmt::format("lockstep: client '{}' has not joined within {:g} s", awaited_.front(),
                                           parts_.world.config().lockstep.join_timeout_s));
  parts_.buses.wait(max_wait);
  return false;
}

bool BranchPrograms::ready() {
  parts_.service.handle_requests(this);
  if (!programs_) return true;
  programs_->check();
  if (const auto lost = parts_.buses.lost_connection()) throw experiment::RunError(4, "bus", *lost);
  if (!begun_ && !joined()) return false;
  begun_ = true;
  if (synchronized_) return true;
  const Clock::time_point until = Clock::now() + max_wait;
  const auto outcome = parts_.lockstep.synchronize([this](milliseconds time) { parts_.buses.wait(time); },
                                                   [until] { return Clock::now() < until; });
  synchronized_ = outcome == bridges::LockstepOutcome::done;
  return synchronized_;
}

std::string BranchPrograms::waits_for() {
  if (!programs_) return "";
  if (!begun_ && !awaited_.empty()) return "'" + awaited_.front() + "' to join";
  return parts_.lockstep.waits_for();
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
