// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/pybind11.h>

#include <exception>
#include <new>

#include "python/bindings/bindings.hpp"
#include "python/world/error.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// Class of all errors; lives until the interpreter ends.
PyObject* error_class = nullptr;

/// Gives an exception of Shoal to Python with the text that the command line prints.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const py::builtin_exception&) {
    throw;  // StopIteration, TypeError and others of pybind11 itself
  } catch (const py::error_already_set&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;  // MemoryError
  } catch (const std::exception& error) {
    // Names of files may be bytes that are not UTF-8.
    const std::string text = error.what();
    PyObject* const message = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
    if (message == nullptr) return;
    PyErr_SetObject(error_class, message);
    Py_DECREF(message);
  }
}

}  // namespace

void add_errors(py::module_& module) {
  // The classes that lcm-gen makes raise ValueError for a payload that is not valid.
  const py::tuple bases = py::make_tuple(py::handle(PyExc_RuntimeError), py::handle(PyExc_ValueError));
  error_class =
      PyErr_NewExceptionWithDoc("shoal.Error",
                                "An input, a file, a message or a bus that Shoal refuses.\n\nThe text is the one that "
                                "the program 'shoal' prints; one line for each error found.",
                                bases.ptr(), nullptr);
  if (error_class == nullptr) throw py::error_already_set();
  module.add_object("Error", py::reinterpret_borrow<py::object>(error_class));
  py::register_exception_translator(&translate);
}

}  // namespace python
