// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/message_objects.hpp"

#include <pybind11/numpy.h>

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

#include "python/bindings/message_class.hpp"
#include "shoal/wire_value.hpp"

namespace py = pybind11;

namespace python {
namespace {

using shoal::big_endian;
using shoal::Member;
using shoal::MessageSchema;
using shoal::WireType;

using Shape = std::vector<py::ssize_t>;
constexpr std::size_t max_lengths = 64;

/// Returns the kind of elements of a NumPy array; null for strings and compounds.
const char* format_of(WireType type) {
  switch (type) {
    case WireType::boolean:
      return "?";
    case WireType::byte:
      return "u1";
    case WireType::int8:
      return "i1";
    case WireType::int16:
      return "i2";
    case WireType::int32:
      return "i4";
    case WireType::int64:
      return "i8";
    case WireType::float32:
      return "f4";
    case WireType::float64:
      return "f8";
    case WireType::string:
    case WireType::compound:
      return nullptr;
  }
  return nullptr;
}

/// Returns the type of the elements, made once for each kind; they live as long as the process.
const py::dtype& dtype_of(WireType type) {
  static auto* const all = new std::array<py::dtype*, 10>{};
  py::dtype*& found = (*all)[static_cast<std::size_t>(type)];
  if (found == nullptr) found = new py::dtype(format_of(type));
  return *found;
}

/// Copies numbers between the byte order of LCM and that of the machine.
void copy_swapped(char* to, const char* from, std::size_t count, std::size_t size) {
  const auto swap = [&](auto zero) {
    using T = decltype(zero);
    for (std::size_t i = 0; i < count; ++i) {
      const T value = big_endian<T>(reinterpret_cast<const std::byte*>(from) + i * sizeof(T));
      std::memcpy(to + i * sizeof(T), &value, sizeof(T));
    }
  };
  if (size == 2) swap(std::uint16_t{});
  if (size == 4) swap(std::uint32_t{});
  if (size == 8) swap(std::uint64_t{});
  if (size == 1) std::memcpy(to, from, count);
}

/// Reads a valid payload.
class Decoder {
 public:
  explicit Decoder(const py::bytes& payload)
      : payload_(payload), at_(span_of(payload).data() + sizeof(std::uint64_t)) {}

  py::object compound(const MessageSchema& schema) {
    const MessageClass& known = message_class(schema);
    py::object object = known.make();
    std::array<std::int64_t, max_lengths> lengths;  // each is set before it is used
    for (std::size_t i = 0; i < schema.members.size(); ++i) {
      const Member& member = schema.members[i];
      if (member.length_slot >= 0)
        lengths[static_cast<std::size_t>(member.length_slot)] = shoal::read_integer(member.type, at_);
      known.set(object, i, value(member, lengths));
    }
    return object;
  }

 private:
  using Lengths = std::array<std::int64_t, max_lengths>;

  py::object value(const Member& member, const Lengths& lengths) {
    if (member.dimensions.empty()) return scalar(member);
    Shape shape;
    for (const shoal::Dimension& dimension : member.dimensions)
      shape.push_back(dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)]
                                              : dimension.constant);
    if (format_of(member.type) == nullptr) return list(member, shape, 0);
    return array(member.type, shape);
  }

  py::object scalar(const Member& member) {
    if (member.type == WireType::compound) return compound(*member.compound);
    if (member.type == WireType::string) return text();
    const std::byte* const here = std::exchange(at_, at_ + shoal::wire_size(member.type));
    if (member.type == WireType::boolean) return py::bool_(shoal::read_integer(member.type, here) != 0);
    if (member.type == WireType::float32 || member.type == WireType::float64)
      return py::float_(shoal::read_real(member.type, here));
    return py::int_(shoal::read_integer(member.type, here));
  }

  /// A string of LCM is any bytes up to a zero; those that are not UTF-8 become lone surrogates, as in names of files.
  py::object text() {
    const auto length = static_cast<Py_ssize_t>(big_endian<std::uint32_t>(at_));
    const char* const start = reinterpret_cast<const char*>(at_) + sizeof(std::uint32_t);
    at_ += sizeof(std::uint32_t) + static_cast<std::size_t>(length);
    PyObject* const made = PyUnicode_DecodeUTF8(start, length - 1, "surrogateescape");
    if (made == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::object>(made);
  }

  py::object list(const Member& member, const Shape& shape, std::size_t dimension) {
    py::list made;
    for (py::ssize_t i = 0; i < shape[dimension]; ++i)
      made.append(dimension + 1 < shape.size() ? list(member, shape, dimension + 1) : scalar(member));
    return made;
  }

  py::object array(WireType type, const Shape& shape) {
    std::size_t count = 1;
    for (const py::ssize_t size : shape) count *= static_cast<std::size_t>(size);
    const std::size_t size = shoal::wire_size(type);
    const auto* const here = reinterpret_cast<const char*>(std::exchange(at_, at_ + count * size));
    if (size == 1) {
      py::array view(dtype_of(type), shape, Shape{}, here, payload_);
      py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;  // bytes never change
      return view;
    }
    py::array made(dtype_of(type), shape);
    copy_swapped(static_cast<char*>(made.mutable_data()), here, count, size);
    return made;
  }

  const py::bytes& payload_;
  const std::byte* at_;
};

[[noreturn]] void refuse(const std::string& where, const std::string& rule, py::handle value) {
  std::string shown = py::repr(value);
  constexpr std::size_t enough = 60;
  if (shown.size() > enough) shown = shown.substr(0, enough) + "...";
  throw shoal::MessageError("'" + where + "' must be " + rule + ", got " + shown);
}

/// Writes the members of an object.
class Encoder {
 public:
  explicit Encoder(const MessageSchema& schema) : path_(schema.name) { number(schema.fingerprint); }

  void compound(const MessageSchema& schema, py::handle object) {
    const MessageClass& known = message_class(schema);
    // Take all values; the arrays give the lengths
    std::vector<py::object> values;
    for (std::size_t i = 0; i < schema.members.size(); ++i) values.push_back(get(known, schema.members[i], i, object));
    Lengths lengths;
    lengths.fill(-1);
    std::vector<Shape> shapes(values.size());
    for (std::size_t i = 0; i < schema.members.size(); ++i)
      if (!schema.members[i].dimensions.empty()) shapes[i] = take_shape(schema.members[i], values[i], lengths);
    // Write them
    for (std::size_t i = 0; i < schema.members.size(); ++i) {
      const Member& member = schema.members[i];
      const std::size_t before = enter(member.name);
      if (member.length_slot >= 0)
        length(member, values[i], lengths[static_cast<std::size_t>(member.length_slot)]);
      else if (member.dimensions.empty())
        scalar(member, values[i]);
      else if (format_of(member.type) != nullptr)
        array(member.type, values[i]);
      else
        list(member, values[i], shapes[i], 0);
      path_.resize(before);
    }
  }

  std::string take() { return std::move(out_); }

 private:
  using Lengths = std::array<std::int64_t, max_lengths>;

  std::size_t enter(const std::string& name) {
    const std::size_t before = path_.size();
    path_ += '.' + name;
    return before;
  }

  py::object get(const MessageClass& known, const Member& member, std::size_t index, py::handle object) {
    py::object value = known.get(object, index);
    if (!value) throw shoal::MessageError("'" + path_ + "' needs the member '" + member.name + "'");
    return value;
  }

  /// Returns the sizes of an array or list, and notes them as lengths; an array becomes one of NumPy.
  Shape take_shape(const Member& member, py::object& value, Lengths& lengths) {
    const std::size_t before = enter(member.name), dimensions = member.dimensions.size();
    Shape shape;
    if (format_of(member.type) != nullptr) {
      const py::array numbers = numbers_of(member.type, value);
      shape.assign(numbers.shape(), numbers.shape() + numbers.ndim());
      value = numbers;
    } else {
      py::object rest = value;
      while (shape.size() < dimensions && is_list(rest) && (shape.empty() || shape.back() > 0)) {
        shape.push_back(static_cast<py::ssize_t>(py::len(rest)));
        if (shape.back() > 0) rest = py::reinterpret_borrow<py::sequence>(rest)[0];
      }
    }
    // An empty list stands for an empty array of any number of dimensions.
    if (!shape.empty() && shape.back() == 0) shape.resize(dimensions, 0);
    if (shape.size() != dimensions)
      refuse(path_, "an array of " + std::to_string(dimensions) + " dimension" + (dimensions > 1 ? "s" : ""), value);
    for (std::size_t k = 0; k < dimensions; ++k) note(member.dimensions[k], shape[k], value, lengths);
    path_.resize(before);
    return shape;
  }

  static bool is_list(const py::handle& value) { return PyList_Check(value.ptr()) || PyTuple_Check(value.ptr()); }

  void note(const shoal::Dimension& dimension, py::ssize_t size, const py::object& value, Lengths& lengths) {
    if (!dimension.is_variable()) {
      if (size != dimension.constant) refuse(path_, dimension.text + " values", value);
      return;
    }
    std::int64_t& length = lengths[static_cast<std::size_t>(dimension.length_slot)];
    if (length >= 0 && length != size)
      refuse(path_, "as long as the other array of '" + dimension.text + "': " + std::to_string(length), value);
    length = size;
  }

  /// Returns the numbers in the type of the member, in rows without gaps.
  py::array numbers_of(WireType type, const py::object& value) {
    if (PyBytes_Check(value.ptr()) && type == WireType::byte)
      return py::array(dtype_of(type), Shape{PyBytes_Size(value.ptr())}, Shape{}, PyBytes_AsString(value.ptr()), value);
    py::array numbers;
    try {
      numbers = py::module_::import("numpy").attr("asarray")(value);
    } catch (const py::error_already_set&) {
      refuse(path_, "an array of numbers", value);
    }
    const py::dtype& own_type = dtype_of(type);
    if (!numbers.dtype().is(own_type) || (numbers.flags() & py::array::c_style) == 0) {
      const char kind = numbers.dtype().kind(), own = own_type.kind();
      const bool fits = numbers.size() == 0 || kind == own || (own == 'f' && (kind == 'i' || kind == 'u')) ||
                        (own != 'f' && own != 'b' && (kind == 'i' || kind == 'u')) || (own == 'b' && kind == 'b');
      if (!fits) refuse(path_, std::string("an array of ") + words_of(type), value);
      py::array cast = numbers.attr("astype")(own_type, py::arg("order") = "C");
      if (own != 'f' && !py::cast<bool>(py::module_::import("numpy").attr("array_equal")(cast, numbers)))
        refuse(path_, std::string("an array of ") + words_of(type), value);
      numbers = cast;
    }
    return numbers;
  }

  static const char* words_of(WireType type) {
    switch (type) {
      case WireType::boolean:
        return "true and false";
      case WireType::byte:
        return "integers from 0 to 255";
      case WireType::int8:
        return "integers from -128 to 127";
      case WireType::int16:
        return "integers of 16 bits";
      case WireType::int32:
        return "integers of 32 bits";
      case WireType::int64:
        return "integers of 64 bits";
      default:
        return "numbers";
    }
  }

  /// Writes the length of an array: that of the array, which may not contradict the member.
  void length(const Member& member, const py::object& value, std::int64_t length) {
    if (!PyIndex_Check(value.ptr())) refuse(path_, "an integer", value);
    const auto given = value.cast<std::int64_t>();
    if (length < 0) return scalar(member, value);
    if (given != 0 && given != length)
      refuse(path_, "the length of its array, " + std::to_string(length) + ", or 0", value);
    scalar(member, py::int_(length));
  }

  void scalar(const Member& member, const py::handle& value) {
    switch (member.type) {
      case WireType::compound:
        return compound(*member.compound, value);
      case WireType::string:
        return text(value);
      case WireType::boolean:
        // Strict: a number where the type has a boolean is most likely meant for another member.
        if (!PyBool_Check(value.ptr()) && !is_numpy_bool(value)) refuse(path_, "True or False", value);
        out_ += static_cast<char>(PyObject_IsTrue(value.ptr()));
        return;
      case WireType::float32:
      case WireType::float64:
        return real(member.type, value);
      case WireType::byte:
        return integer<std::uint8_t>(value, 0, 255);
      case WireType::int8:
        return integer<std::uint8_t>(value, INT8_MIN, INT8_MAX);
      case WireType::int16:
        return integer<std::uint16_t>(value, INT16_MIN, INT16_MAX);
      case WireType::int32:
        return integer<std::uint32_t>(value, INT32_MIN, INT32_MAX);
      case WireType::int64:
        return integer<std::uint64_t>(value, INT64_MIN, INT64_MAX);
    }
  }

  static bool is_numpy_bool(const py::handle& value) {
    return std::string_view(Py_TYPE(value.ptr())->tp_name) == "numpy.bool_";
  }

  void real(WireType type, const py::handle& value) {
    const double number_value = PyFloat_AsDouble(value.ptr());
    if (number_value == -1 && PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      refuse(path_, "a number", value);
    }
    if (type == WireType::float32)
      number(std::bit_cast<std::uint32_t>(static_cast<float>(number_value)));
    else
      number(std::bit_cast<std::uint64_t>(number_value));
  }

  template <class T>
  void integer(const py::handle& value, std::int64_t low, std::int64_t high) {
    const auto wrong = [&] {
      PyErr_Clear();
      refuse(path_, "an integer from " + std::to_string(low) + " to " + std::to_string(high), value);
    };
    // Only true integers: a float would be cut off silently.
    if (!PyIndex_Check(value.ptr())) wrong();
    const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (!index) wrong();
    int overflow = 0;
    const long long known = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow != 0 || known < low || known > high) wrong();
    number(static_cast<T>(known));
  }

  void text(const py::handle& value) {
    if (!PyUnicode_Check(value.ptr())) refuse(path_, "a str", value);
    // Bytes that are not UTF-8 came in by the same escape, so a message can be passed on unchanged.
    const py::object bytes =
        py::reinterpret_steal<py::object>(PyUnicode_AsEncodedString(value.ptr(), "utf-8", "surrogateescape"));
    if (!bytes) {
      PyErr_Clear();
      refuse(path_, "text of Unicode", value);
    }
    const std::string content = bytes.cast<std::string>();
    if (content.find('\0') != std::string::npos) refuse(path_, "text without a NUL character", value);
    number(static_cast<std::uint32_t>(content.size() + 1));
    out_.append(content.c_str(), content.size() + 1);
  }

  void list(const Member& member, const py::handle& values, const Shape& shape, std::size_t dimension) {
    if (!is_list(values) || static_cast<py::ssize_t>(py::len(values)) != shape[dimension])
      refuse(path_, "a list of " + std::to_string(shape[dimension]) + " elements", values);
    const auto sequence = py::reinterpret_borrow<py::sequence>(values);
    for (py::ssize_t i = 0; i < shape[dimension]; ++i) {
      const std::size_t before = path_.size();
      path_ += '[' + std::to_string(i) + ']';
      const py::object element = sequence[static_cast<std::size_t>(i)];
      if (dimension + 1 < shape.size())
        list(member, element, shape, dimension + 1);
      else
        scalar(member, element);
      path_.resize(before);
    }
  }

  void array(WireType type, const py::object& value) {
    const auto numbers = py::reinterpret_borrow<py::array>(value);
    const std::size_t size = shoal::wire_size(type), count = static_cast<std::size_t>(numbers.size());
    const std::size_t start = out_.size();
    out_.resize(start + count * size);
    copy_swapped(out_.data() + start, static_cast<const char*>(numbers.data()), count, size);
  }

  template <class T>
  void number(T value) {
    for (std::size_t i = sizeof(T); i-- > 0;) out_ += static_cast<char>(value >> (8 * i) & 0xff);
  }

  std::string path_;  // of the member that is written, for errors
  std::string out_;
};

}  // namespace

std::span<const std::byte> span_of(const py::bytes& payload) {
  char* start = nullptr;
  py::ssize_t size = 0;
  if (PyBytes_AsStringAndSize(payload.ptr(), &start, &size) != 0) throw py::error_already_set();
  return {reinterpret_cast<const std::byte*>(start), static_cast<std::size_t>(size)};
}

const MessageSchema& schema_of_name(const std::string& name) {
  const MessageSchema* found = shoal::embedded_types().find(name);
  if (found == nullptr) found = shoal::embedded_types().find("shoal." + name);
  if (found == nullptr) throw shoal::MessageError("there is no message type '" + name + "'");
  return *found;
}

const MessageSchema& schema_of_payload(std::span<const std::byte> payload) {
  const auto fingerprint = static_cast<std::uint64_t>(shoal::fingerprint(payload));
  const MessageSchema* const found = shoal::embedded_types().find(fingerprint);
  if (found == nullptr) throw shoal::MessageError("no message type has the fingerprint of this payload");
  return *found;
}

py::object decode_message(const MessageSchema& schema, const py::bytes& payload) {
  if (const auto error = shoal::validate(schema, span_of(payload), shoal::Finite::any))
    throw shoal::MessageError(*error);
  return Decoder(payload).compound(schema);
}

py::object decode_if_known(std::span<const std::byte> payload) {
  const py::bytes copy(reinterpret_cast<const char*>(payload.data()), payload.size());
  const auto* const schema = shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  if (schema == nullptr) return copy;
  return decode_message(*schema, copy);
}

std::string encode_message(const MessageSchema& schema, py::handle message) {
  Encoder encoder(schema);
  encoder.compound(schema, message);
  return encoder.take();
}

}  // namespace python
