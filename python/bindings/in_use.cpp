// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/in_use.hpp"

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <utility>

#include "python/bindings/gil.hpp"
#include "python/world/error.hpp"

namespace py = pybind11;

namespace python {

Guarded::Guarded(std::string name) : name_(std::move(name)), process_(::getpid()) {}

bool Guarded::is_ours() const {
  return process_ == ::getpid();
}

void Guarded::require_made() const {
  if (process_ == 0) throw Error("the object was not initialized");
}

Guarded::Use::Use(Guarded& object) : object_(object) {
  object.require_made();
  if (!object.is_ours())
    throw Error(object.name_ + " belongs to the process that made it, not to a fork of it: make another one here");
  std::thread::id unused;
  if (!object.user_.compare_exchange_strong(unused, std::this_thread::get_id()) && unused != std::this_thread::get_id())
    throw Error(object.name_ + " is in use by another thread");
  ++object.depth_;
}

Guarded::Use::~Use() {
  if (--object_.depth_ == 0) object_.user_ = std::thread::id();
}

bool interrupted() {
  if (interpreter_ends()) return true;
  const WithGil python;
  return PyErr_CheckSignals() != 0;
}

void raise_interrupt() {
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
}

}  // namespace python
