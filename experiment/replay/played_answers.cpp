// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/played_answers.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "bridges/log/run_journal.hpp"
#include "experiment/replay/recorded_steps.hpp"
#include "experiment/replay/replay_messages.hpp"

namespace experiment {

namespace {

bool is_answer(const ReplayLog::Input& input) {
  return input.bus != bridges::RunJournal::serial_bus && !is_of_the_handshake(input.channel);
}

}  // namespace

PlayedAnswers::PlayedAnswers(const ReplayLog& log) : log_(log) {
  for (const ReplayLog::Input& input : log.inputs)
    if (is_answer(input)) ++channels_[input.channel].recorded;
}

bool PlayedAnswers::is_spoken(std::string_view channel) const {
  const auto known = channels_.find(channel);
  return known != channels_.end() && known->second.spoken;
}

void PlayedAnswers::came(std::int64_t step, std::span<const sim::MessageGate::Delivery> input_record) {
  std::map<std::string_view, std::vector<const sim::Bytes*>> there, here;
  for (; next_ < log_.inputs.size() && log_.inputs[next_].step <= step; ++next_) {
    const ReplayLog::Input& input = log_.inputs[next_];
    if (is_answer(input)) there[input.channel].push_back(&input.payload);
  }
  for (const sim::MessageGate::Delivery& each : input_record) here[each.channel].push_back(&each.payload);
  for (auto& [name, channel] : channels_) {
    const auto published = here.find(name);
    if (published != here.end()) channel.spoken = true;
    const auto recorded = there.find(name);
    if (published == here.end() && recorded == there.end()) continue;
    compare(channel, step, recorded == there.end() ? std::vector<const sim::Bytes*>{} : recorded->second,
            published == here.end() ? std::vector<const sim::Bytes*>{} : published->second);
  }
}

void PlayedAnswers::compare(Channel& channel, std::int64_t step, const std::vector<const sim::Bytes*>& there,
                            const std::vector<const sim::Bytes*>& here) {
  const auto differ = [&](const std::string& what) {
    if (channel.first_step) return;
    channel.first_step = step;
    channel.first = what;
  };
  const std::size_t both = std::min(there.size(), here.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (*there[i] == *here[i]) {
      ++channel.equal;
      continue;
    }
    ++channel.different;
    differ(message_difference(*there[i], *here[i]));
  }
  if (there.size() > both) differ("a message is in the log and was not published here");
  if (here.size() > both) differ("a message was published here and is not in the log");
  channel.missing += static_cast<std::int64_t>(there.size() - both);
  channel.added += static_cast<std::int64_t>(here.size() - both);
}

bool PlayedAnswers::all_equal() const {
  bool some = false;
  for (const auto& [name, channel] : channels_) {
    if (!channel.spoken) continue;
    some = true;
    if (channel.different + channel.missing + channel.added > 0) return false;
  }
  return some;
}

std::vector<std::string> PlayedAnswers::to_lines(double step_s) const {
  std::vector<std::string> lines;
  std::size_t silent = 0;
  // Channels with messages of programs.
  for (const auto& [name, channel] : channels_) {
    if (!channel.spoken) {
      ++silent;
      continue;
    }
    std::string line = fmt::format("{}: {} equal", name, channel.equal);
    if (channel.different > 0) line += fmt::format(", {} different", channel.different);
    if (channel.missing > 0) line += fmt::format(", {} missing here", channel.missing);
    if (channel.added > 0) line += fmt::format(", {} not in the log", channel.added);
    if (channel.first_step)
      line += fmt::format("; first at step {} ({:.3f} s): {}", *channel.first_step,
                          static_cast<double>(*channel.first_step) * step_s, channel.first);
    lines.push_back(std::move(line));
  }
  // Channels without any.
  if (lines.empty())
    lines.push_back("nothing was published here on a channel on which the world of the log received messages");
  else if (silent > 0)
    lines.push_back(fmt::format("{} more channels of the log without messages from this world", silent));
  return lines;
}

}  // namespace experiment
