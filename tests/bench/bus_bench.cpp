// SPDX-License-Identifier: BSD-3-Clause
// What the bus costs the thread that simulates.  LcmBus::publish must stay below 2 us.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "bridges/bus/lcm_bus.hpp"
#include "bridges/log/recording_bus.hpp"
#include "shoal/message_codec.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/own_ports.hpp"

namespace {

using namespace std::chrono_literals;

constexpr int messages_per_step = 100;

class NoBus final : public sim::Bus {
 public:
  void publish(std::string_view, std::span<const std::byte>, sim::Time) override {}
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string&, std::size_t) override { return nullptr; }
  sim::BusCounts counts() const override { return {}; }
};

// A step publishes a burst; then the sender gets time to empty the queue, as it does in a run at real time.
void lcm_publish(benchmark::State& state) {
  bridges::LcmBus bus(test_support::own_url());
  const sim::Bytes payload(static_cast<std::size_t>(state.range(0)));
  int in_step = 0;
  for (auto _ : state) {
    bus.publish("bench.device", payload, sim::Time(0));
    if (++in_step < messages_per_step) continue;
    in_step = 0;
    bus.end_of_step();
    state.PauseTiming();
    bus.flush(10s);
    state.ResumeTiming();
  }
  state.counters["dropped"] = static_cast<double>(bus.counts().dropped_outgoing);
}
BENCHMARK(lcm_publish)->Arg(64)->Arg(800);

// Without a pause: the sender is busy all the time and takes the lock for every message.
void lcm_publish_flat_out(benchmark::State& state) {
  bridges::LcmBus bus(test_support::own_url());
  const sim::Bytes payload(static_cast<std::size_t>(state.range(0)));
  int in_step = 0;
  for (auto _ : state) {
    bus.publish("bench.device", payload, sim::Time(0));
    if (++in_step % messages_per_step == 0) bus.end_of_step();
  }
}
BENCHMARK(lcm_publish_flat_out)->Arg(64)->Arg(800);

void lcm_end_of_step_wakes_the_sender(benchmark::State& state) {
  bridges::LcmBus bus(test_support::own_url());
  const sim::Bytes payload(64);
  for (auto _ : state) {
    state.PauseTiming();
    bus.flush(10s);
    std::this_thread::sleep_for(50us);
    bus.publish("bench.device", payload, sim::Time(0));
    state.ResumeTiming();
    bus.end_of_step();
  }
}
BENCHMARK(lcm_end_of_step_wakes_the_sender)->Iterations(2000);

void lcm_take_from_empty_mailbox(benchmark::State& state) {
  bridges::LcmBus bus(test_support::own_url());
  const auto mailbox = bus.open_mailbox("bench.cmd");
  for (auto _ : state) benchmark::DoNotOptimize(mailbox->take());
}
BENCHMARK(lcm_take_from_empty_mailbox);

void in_process_publish_without_subscriber(benchmark::State& state) {
  sim::InProcessBus bus;
  const sim::Bytes payload(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) bus.publish("bench.device", payload, sim::Time(0));
}
BENCHMARK(in_process_publish_without_subscriber)->Arg(64)->Arg(800);

void recorder_publish(benchmark::State& state) {
  const auto path = std::filesystem::temp_directory_path() / "shoal-bus-bench.lcm";
  {
    NoBus inner;
    bridges::RecordingBus bus(inner, path.string(), 0, bridges::Existing::overwrite);
    const sim::Bytes payload(static_cast<std::size_t>(state.range(0)));
    std::int64_t step = 0;
    for (auto _ : state) bus.publish("bench.device", payload, sim::Time(++step * 100));
    state.SetBytesProcessed(state.iterations() * (state.range(0) + 42));
  }
  std::filesystem::remove(path);
}
BENCHMARK(recorder_publish)->Arg(64)->Arg(800)->Iterations(300'000);
BENCHMARK(recorder_publish)->Arg(300'000)->Iterations(2'000);

shoal::planar_lidar_t scan_of(int beams) {
  shoal::planar_lidar_t scan{};
  scan.nranges = beams;
  scan.ranges.assign(static_cast<std::size_t>(beams), 3.5f);
  return scan;
}

void encode_scan(benchmark::State& state) {
  const auto scan = scan_of(181);
  std::vector<std::byte> buffer;
  for (auto _ : state) {
    shoal::encode_into(scan, buffer);
    benchmark::DoNotOptimize(buffer.data());
  }
}
BENCHMARK(encode_scan);

void validate_and_decode_scan(benchmark::State& state) {
  const auto payload = shoal::encode(scan_of(181));
  for (auto _ : state) benchmark::DoNotOptimize(shoal::decode<shoal::planar_lidar_t>(payload, shoal::Finite::required));
}
BENCHMARK(validate_and_decode_scan);

void validate_and_decode_twist_command(benchmark::State& state) {
  const auto payload = shoal::encode(shoal::twist_command_t{});
  for (auto _ : state)
    benchmark::DoNotOptimize(shoal::decode<shoal::twist_command_t>(payload, shoal::Finite::required));
}
BENCHMARK(validate_and_decode_twist_command);

}  // namespace

BENCHMARK_MAIN();
