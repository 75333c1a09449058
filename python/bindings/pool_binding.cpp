// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "python/bindings/bindings.hpp"
#include "python/bindings/gil.hpp"
#include "python/bindings/in_use.hpp"
#include "python/world/error.hpp"
#include "python/world/world_pool.hpp"
#include "sim/world/world_state.hpp"

namespace py = pybind11;

namespace python {
namespace {

using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Pool that Python holds.
class Pool : public Guarded {
 public:
  Pool(WorldSource source, std::size_t count, std::int64_t first_seed, WorldPool::Layout layout, int threads)
      : Guarded("the pool"), own(release_and_make(std::move(source), count, first_seed, std::move(layout), threads)) {}
  ~Pool() {
    if (!is_ours()) own.release();  // a fork has the memory but not the threads
  }

  std::unique_ptr<WorldPool> own;

 private:
  static std::unique_ptr<WorldPool> release_and_make(WorldSource source, std::size_t count, std::int64_t first_seed,
                                                     WorldPool::Layout layout, int threads) {
    const WithoutGil others;
    return std::make_unique<WorldPool>(std::move(source), count, first_seed, std::move(layout), threads);
  }
};

std::unique_ptr<Pool> make_pool(
    const std::string& file, const std::optional<std::string>& text, const std::vector<std::string>& sets,
    std::size_t count, std::int64_t seed,
    const std::vector<std::tuple<std::string, std::string, std::vector<std::string>>>& actions,
    const std::vector<std::tuple<std::string, std::string, std::string>>& observations, std::int64_t steps,
    int threads) {
  WorldPool::Layout layout;
  for (const auto& [channel, type, members] : actions) layout.actions.push_back({channel, type, members});
  for (const auto& [channel, member, vehicle] : observations) layout.observations.push_back({channel, member, vehicle});
  layout.steps = steps;
  return std::make_unique<Pool>(WorldSource{file, text, sets, {}}, count, seed, std::move(layout), threads);
}

using Seeds = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

py::tuple step_pool(Pool& pool, const Values& actions, const Seeds& seeds) {
  const Guarded::Use use(pool);
  WorldPool& own = *pool.own;
  const std::size_t count = own.count();
  if (static_cast<std::size_t>(actions.size()) != count * own.action_values())
    throw Error("actions must have " + std::to_string(count) + " rows of " + std::to_string(own.action_values()) +
                " values, got " + std::to_string(actions.size()) + " values");
  if (static_cast<std::size_t>(seeds.size()) != count)
    throw Error("seeds must be " + std::to_string(count) + " numbers, got " + std::to_string(seeds.size()));
  py::array_t<double> observations(
      {static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(own.observation_values())});
  py::array_t<std::uint8_t> ended(static_cast<py::ssize_t>(count));
  const std::span<const double> in(actions.data(), count * own.action_values());
  const std::span<const std::int64_t> anew(seeds.data(), count);
  const std::span<double> out(observations.mutable_data(), count * own.observation_values());
  const std::span<std::uint8_t> status(ended.mutable_data(), count);
  {
    const WithoutGil others;
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<bool> stopped = false;
    // Only the calling thread, which takes steps as the others do, can receive an exception of Python.
    own.step(in, anew, out, status, [&] {
      if (!stopped && std::this_thread::get_id() == caller && interrupted()) stopped = true;
      return stopped.load();
    });
  }
  raise_interrupt();
  return py::make_tuple(observations, ended);
}

/// Returns the function of a property.
template <class Get>
auto of_pool(Get get) {
  return [get](const Pool& pool) {
    pool.require_made();
    return get(*pool.own);
  };
}

}  // namespace

void add_pool(py::module_& module) {
  using py::literals::operator""_a;
  py::class_<Pool>(module, "Pool")
      .def(py::init(&make_pool), "file"_a, "text"_a, "sets"_a, "count"_a, "seed"_a, "actions"_a, "observations"_a,
           "steps"_a, "threads"_a)
      .def("step", &step_pool, "actions"_a, "seeds"_a)
      .def(
          "run_hash",
          [](Pool& pool, std::size_t index) {
            const Guarded::Use use(pool);
            return pool.own->world(index).world().state().run_hash();
          },
          "index"_a)
      .def_property_readonly("step_s", of_pool([](const WorldPool& pool) { return pool.step_s(); }))
      .def_property_readonly("action_values", of_pool([](const WorldPool& pool) { return pool.action_values(); }))
      .def_property_readonly("offsets", of_pool([](const WorldPool& pool) { return pool.offsets(); }));
}

}  // namespace python
