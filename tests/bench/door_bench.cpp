// SPDX-License-Identifier: BSD-3-Clause
// What the doors of a run cost: ten boats at real time, in turn with a door of the first boat to MOOS, to NMEA, and one
// of all boats to rosbridge.  Prints the CPU time of the door, by message that its client gets, and how much later than
// a plain subscriber of LCM the client has the time of the run.
//   door_bench [SECONDS] [BIN]     BIN: folder of other programs than those built here
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bridges/lcm/lcm_listener.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/moos/small_moosdb.hpp"
#include "tests/bridges/nmea/nmea_peer.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/own_ports.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using system_test::Program;
using web_test::Json;

/// CPU time of a process so far, by the nanoseconds that the scheduler counts for each thread.
double cpu_s(const Program& program) {
  double sum_s = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(program.pid()) + "/task")) {
    double on_cpu_ns = 0;
    std::ifstream(thread.path() / "schedstat") >> on_cpu_ns;
    sum_s += 1e-9 * on_cpu_ns;
  }
  return sum_s;
}

/// When a plain subscriber and the client of a door had each time of the run.
class Arrivals {
 public:
  explicit Arrivals(const std::string& url) : thread_([this, url] { listen(url); }) {}
  ~Arrivals() {
    stop_ = true;
    thread_.join();
  }
  /// The client has this time of the run; without one, that of the last tenth of a second.
  void at_client(std::optional<std::int64_t> utime = {}) {
    const auto now = Clock::now();
    const std::lock_guard lock(mutex_);
    at_client_.emplace_back(utime, now);
  }
  void print() {
    const std::lock_guard lock(mutex_);
    std::vector<double> later_ms;
    for (const auto& [utime, at] : at_client_) {
      // The client may have been first.
      const auto is_after = [end = at + 50ms](const auto& each) { return each.second > end; };
      auto direct = utime ? direct_.find(*utime) : std::find_if(direct_.begin(), direct_.end(), is_after);
      if (!utime && direct != direct_.begin()) --direct;
      if (direct == direct_.end()) continue;
      later_ms.push_back(std::chrono::duration<double, std::milli>(at - direct->second).count());
    }
    if (later_ms.empty()) return static_cast<void>(std::printf("  no time came\n"));
    std::sort(later_ms.begin(), later_ms.end());
    const auto at = [&](double q) {
      return later_ms[static_cast<std::size_t>(q * static_cast<double>(later_ms.size() - 1))];
    };
    std::printf("  later than LCM: p50 %.3f, p99 %.3f ms, of %zu\n", at(0.5), at(0.99), later_ms.size());
  }

 private:
  void listen(const std::string& url) {
    bridges::LcmListener lcm(url);
    lcm.listen("sim.clock");
    while (!stop_)
      if (const auto message = lcm.next(100ms)) {
        const auto now = Clock::now();
        const std::lock_guard lock(mutex_);
        direct_.emplace(shoal::decode<shoal::utime_t>(message->payload, shoal::Finite::any).utime, now);
      }
  }

  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::map<std::int64_t, Clock::time_point> direct_;
  std::vector<std::pair<std::optional<std::int64_t>, Clock::time_point>> at_client_;
  std::thread thread_;
};

std::string ten_boats() {
  std::string text =
      "shoal: 1\nname: doors\nphysics: {step_s: 0.02}\nmedium: {water: {}, wind: {speed_mps: 6}}\n"
      "origin: {latitude_deg: 43.8253, longitude_deg: -70.3304}\nobjects:\n"
      "  - {name: bottom, fixed: true, position_m: [0, 0, -12], parts: [{shape: plane}]}\nvehicles:\n";
  for (int i = 1; i <= 10; ++i)
    text += "  - {name: boat" + std::to_string(i) +
            ", file: " + test_support::source_path("examples/nmea/otter_instruments.yaml") + ", position_m: [0, " +
            std::to_string(20 * i) +
            ", 0], overrides: {devices.autopilot.hold: {speed_mps: 1, heading_deg: 90}, devices.ais.mmsi: " +
            std::to_string(211'000'000 + i) + "}}\n";
  return text;
}

/// Counts while `read` gets messages from the door, and prints what they cost.  `door_cpu_s`: of the door; `before_s`:
/// what the same time took without it.
void measure(const char* name, Arrivals& arrivals, double seconds, double before_s,
             const std::function<double()>& door_cpu_s, const std::function<int()>& read) {
  const auto until = [&](double length_s) {
    long messages = 0;
    for (const auto end = Clock::now() + std::chrono::duration<double>(length_s); Clock::now() < end;)
      messages += read();
    return messages;
  };
  until(3);  // the first messages describe the run
  const double begin_s = door_cpu_s();
  const long messages = until(seconds);
  const double used_s = door_cpu_s() - begin_s - before_s;
  std::printf("%s: %.0f messages/s, %.2f %% of a core, %.1f us of CPU a message\n", name,
              static_cast<double>(messages) / seconds, 100 * used_s / seconds,
              1e6 * used_s / static_cast<double>(messages));
  arrivals.print();
}

/// A MOOSDB of one client, which only counts.
void measure_moos(const std::string& bin, const std::string& url, double seconds) {
  const int port = test_support::own_port(2), listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), yes = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address = moos_test::loopback(port);
  if (bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || listen(listener, 1) != 0)
    throw std::runtime_error("no port for a MOOSDB");
  Arrivals arrivals(url);
  const Program door({bin + "/shoal-moos", "--name", "boat1", "--port", std::to_string(port), "--lcm-url", url});
  const int client = accept(listener, nullptr, nullptr);
  moos_test::Msg welcome{'W'};
  welcome.text = "asynchronous";
  const std::string hello = moos_test::packet({welcome});
  send(client, hello.data(), hello.size(), MSG_NOSIGNAL);
  std::string bytes;
  bool greeted = false;
  measure(
      "MOOS", arrivals, seconds, 0, [&] { return cpu_s(door); },
      [&] {
        char chunk[65536];
        const ssize_t got = recv(client, chunk, sizeof chunk, 0);
        if (got <= 0) throw std::runtime_error("shoal-moos has gone");
        bytes.append(chunk, static_cast<std::size_t>(got));
        if (!greeted && bytes.size() >= 32) bytes.erase(0, 32), greeted = true;
        std::vector<moos_test::Msg> messages;
        while (moos_test::take_packet(bytes, messages)) {
        }
        for (moos_test::Msg& each : messages) {
          if (each.key == "SHOAL_TIME") arrivals.at_client(std::llround(1e6 * each.value));
          if (each.type != 'T') continue;
          const std::string answer = moos_test::packet({each});
          send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
        }
        return static_cast<int>(messages.size());
      });
  close(client);
  close(listener);
}

void measure_nmea(const std::string& bin, const std::string& url, double seconds) {
  const int port = test_support::own_port(3);
  Arrivals arrivals(url);
  const Program door({bin + "/shoal-nmea", "--vehicle", "boat1", "--listen", "127.0.0.1:" + std::to_string(port),
                      "--period-s", "0.1", "--lcm-url", url});
  std::optional<nmea_test::Peer> peer;
  web_test::await([&] {
    try {
      peer.emplace(static_cast<std::uint16_t>(port));
    } catch (const std::runtime_error&) {
    }
    return peer.has_value();
  });
  measure(
      "NMEA, ten times a second", arrivals, seconds, 0, [&] { return cpu_s(door); },
      [&] {
        const auto line = peer.value().line();
        if (!line) throw std::runtime_error("shoal-nmea has gone");
        if (line->starts_with("$GPRMC")) arrivals.at_client();
        return 1;
      });
}

/// All topics but images, clouds, and what is to be drawn.
void measure_rosbridge(const Program& run, int port, const std::string& url, double seconds) {
  const double idle_begin_s = cpu_s(run);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const double idle_s = cpu_s(run) - idle_begin_s;
  Arrivals arrivals(url);
  web_test::Client client(static_cast<std::uint16_t>(port));
  client.upgrade("");
  // What was published before the first client has its topics from the start.
  client.send_json({{"op", "call_service"}, {"service", "/rosapi/topics"}});
  const Json values = client.read_json()["values"];
  for (std::size_t i = 0; i < values["topics"].size(); ++i) {
    const std::string type = values["types"][i];
    const auto has = [&](const char* word) { return type.find(word) != std::string::npos; };
    if (!has("Image") && !has("PointCloud") && !has("MarkerArray") && !has("SimAsset") && !has("SimScene"))
      client.send_json({{"op", "subscribe"}, {"topic", values["topics"][i]}});
  }
  measure(
      "rosbridge, without a client beside it", arrivals, seconds, idle_s, [&] { return cpu_s(run); },
      [&] {
        const auto frame = client.read_frame();
        if (!frame) throw std::runtime_error("the server of the run has gone");
        if (frame->payload.find(R"("topic":"/clock")") != std::string::npos) {
          const Json time = frame->json()["msg"]["clock"];
          arrivals.at_client(time["sec"].get<std::int64_t>() * 1'000'000 + time["nanosec"].get<std::int64_t>() / 1000);
        }
        return 1;
      });
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const double seconds = argc > 1 ? std::atof(argv[1]) : 20;
  const std::string bin = argc > 2 ? argv[2] : test_support::built_path("bin"), url = test_support::own_url();
  const test_support::ScratchFolder folder;
  const std::string world = folder.file("doors.yaml");
  std::ofstream(world) << ten_boats();
  const std::string port = std::to_string(test_support::own_port(1));
  try {
    const Program run({bin + "/shoal", "run", world, "--speed", "1", "--duration", "forever", "--quiet", "--no-keys",
                       "--rosbridge", "--view-port", port, "--allow-path", test_support::source_path(""), "--lcm-url",
                       url});
    measure_moos(bin, url, seconds);
    measure_nmea(bin, url, seconds);
    measure_rosbridge(run, std::atoi(port.c_str()), url, seconds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "door_bench: %s\n", error.what());
    return 1;
  }
}
