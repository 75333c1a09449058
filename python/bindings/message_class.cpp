// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/message_class.hpp"

#include <unordered_map>
#include <utility>

#include "python/bindings/message_objects.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// Makes a class of a name; not deleted, because the interpreter ends before the static objects of a library.
py::object* maker = nullptr;

}  // namespace

MessageClass::MessageClass(py::object type, const shoal::MessageSchema& schema) : type_(std::move(type)) {
  for (const shoal::Member& member : schema.members) {
    PyObject* const name = PyUnicode_InternFromString(member.name.c_str());
    if (name == nullptr) throw py::error_already_set();
    names_.push_back(py::reinterpret_steal<py::str>(name));
  }
}

py::object MessageClass::make() const {
  auto* const type = reinterpret_cast<PyTypeObject*>(type_.ptr());
  static auto* const nothing = new py::tuple();
  PyObject* const made = type->tp_new(type, nothing->ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(made);
}

void MessageClass::set(const py::object& object, std::size_t member, const py::object& value) const {
  if (PyObject_SetAttr(object.ptr(), names_[member].ptr(), value.ptr()) != 0) throw py::error_already_set();
}

py::object MessageClass::get(py::handle object, std::size_t member) const {
  PyObject* const found = PyObject_GetAttr(object.ptr(), names_[member].ptr());
  if (found == nullptr) PyErr_Clear();
  return py::reinterpret_steal<py::object>(found);
}

const MessageClass& message_class(const shoal::MessageSchema& schema) {
  static auto* const known = new std::unordered_map<const shoal::MessageSchema*, MessageClass>();
  if (const auto found = known->find(&schema); found != known->end()) return found->second;
  if (maker == nullptr) throw shoal::MessageError("import shoal, not shoal._shoal");
  py::object type = (*maker)(schema.name);
  return known->try_emplace(&schema, std::move(type), schema).first->second;
}

py::object class_of(const shoal::MessageSchema& schema) {
  return message_class(schema).type();
}

void set_class_maker(py::object make) {
  maker = new py::object(std::move(make));
}

}  // namespace python
