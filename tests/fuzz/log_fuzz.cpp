// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/event_log.hpp"
#include "experiment/replay/recorded_steps.hpp"
#include "experiment/replay/replay_log.hpp"
#include "tests/fuzz/memory_file.hpp"

// An LCM event log, as any reader takes it and as a run to repeat.

SHOAL_FUZZ_TARGET(log) {
  const fuzz::MemoryFile file(input);
  fuzz::allow<bridges::BusError>([&] {
    bridges::EventLogReader reader(file.path());
    std::uint64_t bytes = 0;
    bridges::LogEventView event;
    while (reader.next(event)) bytes += 28 + event.channel.size() + event.payload.size();
    fuzz::require(bytes <= input.size(), "events do not overlap");
  });
  fuzz::allow<std::runtime_error>([&] {
    const experiment::ReplayLog log = experiment::read_replay_log(file.path());
    experiment::RecordedSteps steps(log);
    const auto use = [](std::string_view, std::span<const std::byte>) {};
    for (std::int64_t step = log.begin_step(); step <= log.last_step && step < log.begin_step() + 100; ++step) {
      steps.inputs_after(step, use);
      steps.published_at(step, use);
    }
  });
}
