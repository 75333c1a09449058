// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <span>
#include <string>

#include "shoal/message_schema.hpp"

namespace python {

/// Returns the Python class of a type of messages; the package makes it when it is first used.
pybind11::object class_of(const shoal::MessageSchema& schema);
/// Sets the function that makes the class of a type: `make(name) -> class`.
void set_class_maker(pybind11::object make);

/// Returns an object of the class of a type with the values of a payload.  Arrays of `byte` and `int8_t` are read-only
/// views of `payload`; other arrays of numbers are NumPy arrays in the byte order of the machine; arrays of strings and
/// messages are lists.  Throws shoal::MessageError when the payload is not valid.
pybind11::object decode_message(const shoal::MessageSchema& schema, const pybind11::bytes& payload);

/// Returns decode_message() of a payload of a type that its fingerprint names; the payload itself when the type is
/// unknown.  Throws shoal::MessageError when the payload is not valid.
pybind11::object decode_if_known(std::span<const std::byte> payload);

/// Encodes an object with the members of a type.  Members that are the length of an array follow from the arrays.
/// Throws shoal::MessageError with the member, the rule and the value.
std::string encode_message(const shoal::MessageSchema& schema, pybind11::handle message);

/// Returns a span of the bytes of a Python object, which must outlive it.
std::span<const std::byte> span_of(const pybind11::bytes& payload);

/// Returns the type of a name such as `imu_t` or `shoal.imu_t`.  Throws shoal::MessageError when there is none.
const shoal::MessageSchema& schema_of_name(const std::string& name);

/// Returns the schema of a payload, found by its fingerprint.  Throws shoal::MessageError when it is unknown.
const shoal::MessageSchema& schema_of_payload(std::span<const std::byte> payload);

}  // namespace python
