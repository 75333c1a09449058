// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "python/bindings/bindings.hpp"
#include "python/bindings/gil.hpp"
#include "python/bindings/in_use.hpp"
#include "python/bindings/message_objects.hpp"
#include "python/world/error.hpp"
#include "shoal/client.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// While it lives, Ctrl-C also ends the waiting of a client, so that Python can raise KeyboardInterrupt.  Only one may
/// live at a time; further ones do nothing.
class StopBySignal {
 public:
  explicit StopBySignal(shoal::Client& client) {
    shoal::Client* none = nullptr;
    if (!client_.compare_exchange_strong(none, &client)) return;
    struct sigaction own {};
    // Python's own handler is only replaced if there is one: a program that ignores Ctrl-C, or ends at once, has
    // chosen so.
    if (sigaction(SIGINT, nullptr, &before_) != 0 || before_.sa_handler == SIG_IGN || before_.sa_handler == SIG_DFL) {
      client_ = nullptr;
      return;
    }
    own.sa_handler = &on_signal;
    sigemptyset(&own.sa_mask);
    active_ = sigaction(SIGINT, &own, nullptr) == 0;
    if (!active_) client_ = nullptr;
  }
  ~StopBySignal() {
    if (!active_) return;
    sigaction(SIGINT, &before_, nullptr);
    client_ = nullptr;
  }
  StopBySignal(const StopBySignal&) = delete;
  StopBySignal& operator=(const StopBySignal&) = delete;

 private:
  static void on_signal(int number) {
    before_.sa_handler(number);  // that of Python only sets a flag
    if (shoal::Client* const client = client_) client->stop();
  }

  static std::atomic<shoal::Client*> client_;
  static struct sigaction before_;
  bool active_ = false;
};

std::atomic<shoal::Client*> StopBySignal::client_{nullptr};
struct sigaction StopBySignal::before_;

/// Clients that wait, to be stopped when the interpreter ends.
class Waiting {
 public:
  explicit Waiting(shoal::Client& client) : client_(client) {
    const std::lock_guard<std::mutex> lock(mutex());
    all().insert(&client_);
  }
  ~Waiting() {
    const std::lock_guard<std::mutex> lock(mutex());
    all().erase(&client_);
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  static void stop_all() {
    const std::lock_guard<std::mutex> lock(mutex());
    for (shoal::Client* const client : all()) client->stop();
  }

 private:
  static std::mutex& mutex() {
    static auto* const made = new std::mutex;
    return *made;
  }
  static std::set<shoal::Client*>& all() {
    static auto* const made = new std::set<shoal::Client*>;
    return *made;
  }

  shoal::Client& client_;
};

const char* word_of(shoal::Client::End end) {
  switch (end) {
    case shoal::Client::End::none:
      return "";
    case shoal::Client::End::last_tick:
      return "last_tick";
    case shoal::Client::End::stopped:
      return "stopped";
    case shoal::Client::End::silence:
      return "silence";
    case shoal::Client::End::rewound:
      return "rewound";
    case shoal::Client::End::dropped:
      return "dropped";
    case shoal::Client::End::left:
      return "left";
  }
  return "";
}

std::chrono::milliseconds milliseconds(const char* what, double seconds) {
  if (!(seconds >= 0) || seconds > 1e9)
    throw Error(std::string(what) + " must be 0 to 1e9 s, got " + std::to_string(seconds));
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
}

/// Client that Python holds.
class Client : public Guarded {
 public:
  Client(const std::string& name, const std::string& lcm_url)
      : Guarded("the client"), own_(std::make_unique<shoal::Client>(name, lcm_url)) {}
  ~Client() {
    if (!is_ours()) {
      own_.release();  // a fork has the memory but neither the socket nor the threads
      return;
    }
    const WithoutGil others;  // it waits until the simulator has let it leave
    own_.reset();
  }

  void subscribe(const std::string& channel, py::function handler, const std::optional<std::string>& type) {
    const Use use(*this);
    const shoal::MessageSchema* const schema = type ? &schema_of_name(*type) : nullptr;
    // Handlers are called without the GIL, and destroyed with it.
    const std::shared_ptr<py::function> held(new py::function(std::move(handler)), [](py::function* one) {
      const WithGil python;
      delete one;
    });
    own_->subscribe_bytes(channel, [held, schema](std::span<const std::byte> payload) {
      const WithGil python;
      const py::bytes copy(reinterpret_cast<const char*>(payload.data()), payload.size());
      (*held)(decode_message(schema != nullptr ? *schema : schema_of_payload(payload), copy));
    });
  }

  void publish(const std::string& channel, const py::bytes& payload) {
    const Use use(*this);
    own_->publish_bytes(channel, span_of(payload));
  }

  void join(double period_s, const std::string& on_timeout, double timeout_s, double wait_s) {
    const Use use(*this);
    shoal::Client::JoinOptions options;
    options.on_timeout = on_timeout;
    options.timeout_s = timeout_s;
    options.timeout = milliseconds("wait_s", wait_s);
    interruptibly([&] { own_->join(period_s, options); });
  }

  /// Returns the channels as tuples, by device.
  py::dict spawn(const std::string& text, double wait_s) {
    const Use use(*this);
    const auto timeout = milliseconds("wait_s", wait_s);
    const auto channels = interruptibly([&] { return std::optional(own_->spawn(text, timeout)); });
    py::dict all;
    if (!channels) return all;
    for (const auto& [device, each] : *channels)
      all[py::str(device)] =
          py::make_tuple(each.type, each.reports, each.report_type, each.rate_hz, each.commands, each.command_types);
    return all;
  }

  void leave(double wait_s) {
    const Use use(*this);
    const auto timeout = milliseconds("wait_s", wait_s);
    interruptibly([&] { own_->leave(timeout); });
  }

  void follow(double period_s) {
    const Use use(*this);
    own_->follow(period_s);
  }

  std::optional<std::int64_t> next_tick() {
    const Use use(*this);
    return interruptibly([&] { return own_->next_tick(); });
  }

  std::optional<std::int64_t> wait_until(std::int64_t utime) {
    const Use use(*this);
    return interruptibly([&] { return own_->wait_until(utime); });
  }

  void on_rewind(py::function handler) {
    const Use use(*this);
    const std::shared_ptr<py::function> held(new py::function(std::move(handler)), [](py::function* one) {
      const WithGil python;
      delete one;
    });
    own_->on_rewind([held](std::int64_t utime) {
      const WithGil python;
      (*held)(utime);
    });
  }

  void set_reason_to_leave(const std::string& reason) {
    if (is_ours()) own_->set_reason_to_leave(reason);
  }
  void stop() {
    if (is_ours()) own_->stop();
  }
  std::string end() const {
    require_made();
    return word_of(own_->end());
  }
  std::string reason() {
    const Use use(*this);
    return own_->reason();
  }
  std::int32_t branch() const {
    require_made();
    return own_->branch();
  }
  void set_silence_limit(double seconds) {
    const Use use(*this);
    own_->set_silence_limit(milliseconds("the silence limit", seconds));
  }
  void set_wait_warning(double seconds) {
    const Use use(*this);
    own_->set_wait_warning(milliseconds("the delay of the warning", seconds));
  }
  py::dict counts() const {
    require_made();
    const shoal::Client::Counts counts = own_->counts();
    py::dict all;
    all["received"] = counts.received;
    all["bad"] = counts.bad;
    all["published"] = counts.published;
    all["requested"] = counts.requested;
    all["repeated"] = counts.repeated;
    return all;
  }

 private:
  template <class Work>
  auto interruptibly(const Work& work) -> decltype(work()) {
    const auto raise = [] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    };
    try {
      // Other threads of Python continue while this one waits.
      const WithoutGil others;
      const StopBySignal stop(*own_);
      const Waiting waiting(*own_);
      if constexpr (std::is_void_v<decltype(work())>) {
        work();
        return;
      } else {
        const auto result = work();
        if (result) return result;
      }
    } catch (const shoal::ClientError&) {
      // The handlers of Python come first, so that Ctrl-C raises KeyboardInterrupt and not an error of the bus.
      raise();
      throw;
    }
    raise();
    return decltype(work())();
  }

  std::unique_ptr<shoal::Client> own_;
};

}  // namespace

void add_client(py::module_& module) {
  using py::literals::operator""_a;
  // Threads that wait in C++ must return before the interpreter ends, or they would take the GIL of a dead one.
  py::module_::import("atexit").attr("register")(py::cpp_function([] { end_interpreter(&Waiting::stop_all); }));
  py::class_<Client>(module, "Client")
      .def(py::init<const std::string&, const std::string&>(), "name"_a, "lcm_url"_a = "")
      .def("subscribe", &Client::subscribe, "channel"_a, "handler"_a, "type"_a = py::none())
      .def("publish", &Client::publish, "channel"_a, "payload"_a)
      .def("join", &Client::join, "period_s"_a, "on_timeout"_a = "", "timeout_s"_a = 0.0, "wait_s"_a = 30.0)
      .def("spawn", &Client::spawn, "text"_a, "wait_s"_a = 30.0)
      .def("leave", &Client::leave, "wait_s"_a = 30.0)
      .def("follow", &Client::follow, "period_s"_a)
      .def("next_tick", &Client::next_tick)
      .def("wait_until", &Client::wait_until, "utime"_a)
      .def("on_rewind", &Client::on_rewind, "handler"_a)
      .def("set_reason_to_leave", &Client::set_reason_to_leave, "reason"_a)
      .def("stop", &Client::stop)
      .def("set_silence_limit", &Client::set_silence_limit, "seconds"_a)
      .def("set_wait_warning", &Client::set_wait_warning, "seconds"_a)
      .def_property_readonly("end", &Client::end)
      .def_property_readonly("reason", &Client::reason)
      .def_property_readonly("branch", &Client::branch)
      .def_property_readonly("counts", &Client::counts);
}

}  // namespace python
