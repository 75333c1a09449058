// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <vector>

#include "shoal/message_schema.hpp"

namespace python {

/// Python class of a type of messages, with the names of its members.
class MessageClass {
 public:
  MessageClass(pybind11::object type, const shoal::MessageSchema& schema);

  const pybind11::object& type() const { return type_; }
  /// Makes an object whose members are not set.
  pybind11::object make() const;
  void set(const pybind11::object& object, std::size_t member, const pybind11::object& value) const;
  /// Returns the value of a member; null when there is none.
  pybind11::object get(pybind11::handle object, std::size_t member) const;

 private:
  pybind11::object type_;
  std::vector<pybind11::str> names_;
};

/// Returns the class of a type.  All are kept until the process ends.
const MessageClass& message_class(const shoal::MessageSchema& schema);

}  // namespace python
