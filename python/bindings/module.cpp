// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/bindings.hpp"

PYBIND11_MODULE(_shoal, module) {
  module.doc() = "The part of the package 'shoal' that is written in C++; its names are public in 'shoal' only.";
  python::add_errors(module);
  python::add_messages(module);
  python::add_world(module);
  python::add_client(module);
  python::add_records(module);
  python::add_runs(module);
  python::add_pool(module);
}
