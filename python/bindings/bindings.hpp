// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

// The parts of the module `shoal._shoal`.  Each function adds the classes and functions of one file.

namespace python {

void add_errors(pybind11::module_& module);
void add_messages(pybind11::module_& module);
void add_world(pybind11::module_& module);
void add_client(pybind11::module_& module);
void add_records(pybind11::module_& module);
void add_runs(pybind11::module_& module);
void add_pool(pybind11::module_& module);

}  // namespace python
