// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "python/bindings/bindings.hpp"
#include "python/bindings/message_objects.hpp"

namespace py = pybind11;

namespace python {
namespace {

py::list members_of(const shoal::MessageSchema& schema) {
  py::list all;
  for (const shoal::Member& member : schema.members) {
    py::list dimensions;
    for (const shoal::Dimension& dimension : member.dimensions)
      dimensions.append(dimension.is_variable() ? py::object(py::str(dimension.text))
                                                : py::object(py::int_(dimension.constant)));
    all.append(py::make_tuple(member.name, member.type_name, dimensions, member.comment, member.length_slot >= 0));
  }
  return all;
}

}  // namespace

void add_messages(py::module_& module) {
  module.def(
      "message_types",
      [] {
        std::vector<std::string> names;
        for (const auto& [name, schema] : shoal::embedded_types().all()) names.push_back(name);
        return names;
      },
      "Returns the full names of all message types.");
  module.def(
      "message_type",
      [](const std::string& name) {
        const shoal::MessageSchema& schema = schema_of_name(name);
        return py::make_tuple(schema.name, schema.comment, members_of(schema), schema.fingerprint);
      },
      py::arg("name"), "Returns name, comment, members and fingerprint of a type.");
  module.def("set_class_maker", &set_class_maker, py::arg("make"));
  module.def(
      "decode",
      [](const std::string& name, const py::bytes& payload) { return decode_message(schema_of_name(name), payload); },
      py::arg("name"), py::arg("payload"), "Decodes a payload of a type.");
  module.def(
      "decode_any",
      [](const py::bytes& payload) { return decode_message(schema_of_payload(span_of(payload)), payload); },
      py::arg("payload"), "Decodes a payload of the type that its fingerprint names.");
  module.def(
      "encode",
      [](const std::string& name, const py::object& message) {
        return py::bytes(encode_message(schema_of_name(name), message));
      },
      py::arg("name"), py::arg("message"), "Encodes a message of a type.");
}

}  // namespace python
