// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings/bindings.hpp"
#include "python/bindings/gil.hpp"
#include "python/bindings/in_use.hpp"
#include "python/bindings/message_objects.hpp"
#include "python/world/error.hpp"
#include "python/world/in_process_world.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world_state.hpp"

namespace py = pybind11;

namespace python {
namespace {

py::bytes bytes_of(std::span<const std::byte> bytes) {
  return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// World that Python holds.  Every function takes the guard first.
class World : public Guarded, public std::enable_shared_from_this<World> {
 public:
  explicit World(std::unique_ptr<InProcessWorld> world) : Guarded("the world"), own(std::move(world)) {}
  ~World() {
    if (!is_ours()) own.release();  // a fork has the memory but not the threads
  }

  std::unique_ptr<InProcessWorld> own;
};

/// Unread messages of one channel.
class Subscription : public ZeroedMemory {
 public:
  Subscription(std::shared_ptr<World> world, const std::string& channel, std::size_t capacity)
      : world_(std::move(world)), channel_(channel), mailbox_(world_->own->subscribe(channel, capacity)) {}

  py::list take() {
    require_made();
    const Guarded::Use use(*world_);
    py::list all;
    while (const auto message = mailbox_->take()) all.append(decode_if_known(message->payload));
    return all;
  }
  std::uint64_t dropped() const {
    require_made();
    return mailbox_->dropped();
  }
  const std::string& channel() const {
    require_made();
    return channel_;
  }

 private:
  void require_made() const {
    if (!world_) throw Error("the object was not initialized");
  }

  const std::shared_ptr<World> world_;  // the mailbox may not outlive its bus
  const std::string channel_;
  const std::shared_ptr<sim::Mailbox> mailbox_;
};

std::shared_ptr<World> make_world(const std::string& file, const std::optional<std::string>& text,
                                  std::optional<std::int64_t> seed, const std::vector<std::string>& sets) {
  const WithoutGil others;
  return std::make_shared<World>(std::make_unique<InProcessWorld>(load({file, text, sets, seed})));
}

std::int64_t step(World& world, std::int64_t count) {
  if (count < 0) throw Error("a number of steps must be >= 0, got " + std::to_string(count));
  const Guarded::Use use(world);
  std::int64_t taken = 0;
  if (count == 1) {
    // A single step is often shorter than giving up the GIL would be worth checking signals for.
    const WithoutGil others;
    return world.own->step(1);
  }
  {
    const WithoutGil others;
    taken = world.own->step(count, &interrupted);
  }
  raise_interrupt();
  return taken;
}

double run_until(World& world, double time_s) {
  if (!std::isfinite(time_s) || time_s < 0 || time_s > 1e9)
    throw Error("a time must be >= 0 and at most 1e9 s, got " + std::to_string(time_s));
  const double step_s = sim::to_seconds(world.own->world().step_time());
  const auto last = static_cast<std::int64_t>(std::ceil(time_s / step_s - 1e-9));
  step(world, std::max<std::int64_t>(0, last - world.own->world().step_number()));
  return sim::to_seconds(world.own->world().now());
}

const sim::Vehicle& vehicle_of(const World& world, const std::string& name) {
  const sim::Vehicle* found = world.own->world().find_vehicle(name);
  if (found != nullptr) return *found;
  std::vector<std::string> names;
  for (const auto& vehicle : world.own->world().vehicles()) names.push_back(vehicle->name());
  throw Error("there is no vehicle '" + sim::shortened(sim::printable(name)) + "'" + sim::did_you_mean(name, names));
}

py::array_t<Motion> states(World& world, const std::optional<std::vector<std::string>>& names) {
  const Guarded::Use use(world);
  std::vector<Motion> all;
  if (names)
    for (const std::string& name : *names) all.push_back(motion_of(vehicle_of(world, name)));
  else
    for (const auto& vehicle : world.own->world().vehicles()) all.push_back(motion_of(*vehicle));
  return py::array_t<Motion>(static_cast<py::ssize_t>(all.size()), all.data());
}

py::dict joints(World& world, const std::string& vehicle) {
  const Guarded::Use use(world);
  py::dict all;
  for (const auto& [name, joint] : vehicle_of(world, vehicle).joints()) all[py::str(name)] = joint->position();
  return all;
}

py::object last(World& world, const std::string& channel) {
  const Guarded::Use use(world);
  const sim::Bytes* const payload = world.own->last(channel);
  if (payload == nullptr) return py::none();
  return decode_if_known(*payload);
}

py::dict channels(World& world) {
  const Guarded::Use use(world);
  py::dict all;
  for (const auto& [channel, payload] : world.own->bus().all()) {
    const auto* const schema = shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
    all[py::str(channel)] = schema != nullptr ? schema->name : "";
  }
  return all;
}

void publish(World& world, const std::string& channel, const py::bytes& payload) {
  const Guarded::Use use(world);
  world.own->publish(channel, span_of(payload));
}

std::vector<std::string> vehicle_names(World& world) {
  const Guarded::Use use(world);
  std::vector<std::string> names;
  for (const auto& vehicle : world.own->world().vehicles()) names.push_back(vehicle->name());
  return names;
}

std::vector<std::string> device_names(World& world, const std::string& vehicle) {
  const Guarded::Use use(world);
  std::vector<std::string> names;
  for (const sim::MountedDevice* device : vehicle_of(world, vehicle).devices()) names.push_back(device->full_name());
  return names;
}

std::vector<std::string> object_names(World& world) {
  const Guarded::Use use(world);
  std::vector<std::string> names;
  for (const auto& [name, object] : world.own->world().objects()) names.push_back(name);
  return names;
}

/// Returns the function of a property, which may be read while another thread steps the world.
template <class Get>
auto of_world(Get get) {
  return [get](const World& world) {
    world.require_made();
    return get(world.own->world());
  };
}

void add_world_class(py::module_& module) {
  using py::literals::operator""_a;
  py::class_<World, std::shared_ptr<World>>(module, "World")
      .def(py::init(&make_world), "file"_a, "text"_a = py::none(), "seed"_a = py::none(),
           "sets"_a = std::vector<std::string>())
      .def("step", &step, "count"_a = 1)
      .def("run_until", &run_until, "time_s"_a)
      .def("states", &states, "names"_a = py::none())
      .def("joints", &joints, "vehicle"_a)
      .def("last", &last, "channel"_a)
      .def("channels", &channels)
      .def("publish", &publish, "channel"_a, "payload"_a)
      .def("vehicles", &vehicle_names)
      .def("devices", &device_names, "vehicle"_a)
      .def("objects", &object_names)
      .def(
          "subscribe",
          [](const std::shared_ptr<World>& world, const std::string& channel, std::size_t capacity) {
            const Guarded::Use use(*world);
            return std::make_unique<Subscription>(world, channel, capacity);
          },
          "channel"_a, "capacity"_a = sim::Bus::default_mailbox_capacity)
      .def(
          "act",
          [](World& world, const std::string& action) {
            const Guarded::Use use(world);
            world.own->act(action);
          },
          "action"_a)
      .def(
          "spawn",
          [](World& world, const std::string& entry) {
            const Guarded::Use use(world);
            return world.own->spawn(entry);
          },
          "entry"_a)
      .def(
          "remove",
          [](World& world, const std::string& name) {
            const Guarded::Use use(world);
            world.own->remove(name);
          },
          "name"_a)
      .def("snapshot",
           [](World& world) {
             const Guarded::Use use(world);
             return bytes_of(world.own->snapshot());
           })
      .def(
          "restore",
          [](World& world, const py::bytes& snapshot) {
            const Guarded::Use use(world);
            const std::span<const std::byte> bytes = span_of(snapshot);
            const WithoutGil others;
            world.own->restore(bytes);
          },
          "snapshot"_a)
      .def("branch",
           [](World& world) {
             const Guarded::Use use(world);
             const WithoutGil others;
             return std::make_shared<World>(world.own->branch());
           })
      .def(
          "use_threads",
          [](World& world, int threads) {
            const Guarded::Use use(world);
            world.own->world().use_threads(threads);
          },
          "threads"_a)
      .def("state_hash",
           [](World& world) {
             const Guarded::Use use(world);
             return world.own->world().state().hash();
           })
      .def("run_hash",
           [](World& world) {
             const Guarded::Use use(world);
             return world.own->world().state().run_hash();
           })
      .def_property_readonly("name", of_world([](const sim::World& world) { return world.config().name; }))
      .def_property_readonly("description",
                             of_world([](const sim::World& world) { return world.config().description; }))
      .def_property_readonly("seed", of_world([](const sim::World& world) { return world.config().run.seed; }))
      .def_property_readonly("duration_s",
                             of_world([](const sim::World& world) { return world.config().run.duration_s; }))
      .def_property_readonly("step_s",
                             of_world([](const sim::World& world) { return sim::to_seconds(world.step_time()); }))
      .def_property_readonly("step_number", of_world([](const sim::World& world) { return world.step_number(); }))
      .def_property_readonly("time_s", of_world([](const sim::World& world) { return sim::to_seconds(world.now()); }))
      .def_property_readonly("utime",
                             of_world([](const sim::World& world) { return world.epoch_us() + world.now().count(); }))
      .def_property_readonly("ended", [](World& world) -> std::optional<std::string> {
        const Guarded::Use use(world);
        const auto& end = world.own->world().ended();
        return end ? std::optional(end->text) : std::nullopt;
      });
}

}  // namespace

void add_world(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(Motion, position_m, orientation, velocity_mps, rates_radps);
  add_world_class(module);
  py::class_<Subscription>(module, "Subscription")
      .def("take", &Subscription::take, "Removes and returns the unread messages, oldest first.")
      .def_property_readonly("dropped", &Subscription::dropped,
                             "Messages that were lost because they were not taken in time.")
      .def_property_readonly("channel", &Subscription::channel);
}

}  // namespace python
