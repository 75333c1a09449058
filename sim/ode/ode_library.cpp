// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/ode_library.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "sim/base/log.hpp"
#include "sim/base/step_memory.hpp"
#include "sim/ode/ode_version.hpp"
#include "sim/ode/physics_fault.hpp"

namespace sim {
namespace {

thread_local std::int64_t message_count = 0;

std::string formatted(const char* text, va_list arguments) {
  char buffer[512];
  std::vsnprintf(buffer, sizeof buffer, text, arguments);
  return buffer;
}

// "LCP internal error, s <= 0" occurs hundreds of times in stacks of boxes, so that only the first is logged.
void on_message(int, const char* text, va_list arguments) {
  if (message_count++ == 0) log_debug("ODE: {} (further messages are only counted)", formatted(text, arguments));
}

[[noreturn]] void on_error(int, const char* text, va_list arguments) {
  throw PhysicsFault("ODE: " + formatted(text, arguments));
}

// Objects up to this size get step memory: ODE allocates each body, geom and joint separately, and visits them several
// times in a step.
constexpr std::size_t max_object_bytes = 4096;

/// Stands before each object.  ODE gives the size again when it frees one, but not always the right one: the destructor
/// of its quadtree frees 32 bytes as 36.
struct alignas(std::max_align_t) ObjectSize {
  std::size_t bytes;  ///< with this
};

void* allocate(std::size_t bytes) {
  bytes += sizeof(ObjectSize);
  void* const memory = bytes <= max_object_bytes ? allocate_for_steps(bytes) : std::malloc(bytes);
  if (memory == nullptr) return nullptr;
  return new (memory) ObjectSize{bytes} + 1;
}

ObjectSize* size_of(void* object) {
  return static_cast<ObjectSize*>(object) - 1;
}

void free(void* object, std::size_t) {
  if (object == nullptr) return;
  ObjectSize* const memory = size_of(object);
  const std::size_t bytes = memory->bytes;
  bytes <= max_object_bytes ? free_for_steps(memory, bytes) : std::free(memory);
}

void* reallocate(void* object, std::size_t, std::size_t new_bytes) {
  void* const grown = allocate(new_bytes);
  if (object == nullptr || grown == nullptr) return grown;
  std::memcpy(grown, object, std::min(size_of(object)->bytes - sizeof(ObjectSize), new_bytes));
  free(object, 0);
  return grown;
}

struct Library {
  Library() {
    dSetAllocHandler(allocate);
    dSetReallocHandler(reallocate);
    dSetFreeHandler(free);
    dInitODE2(0);
    dSetMessageHandler(on_message);
    dSetDebugHandler(on_error);
    dSetErrorHandler(on_error);
  }
  ~Library() { dCloseODE(); }
};

}  // namespace

void start_ode() {
  static const Library library;
  // Per thread; does nothing where ODE was built without thread-local data.
  dAllocateODEDataForThread(dAllocateMaskAll);
}

std::int64_t ode_messages() {
  return message_count;
}

const char* ode_configuration() {
  return dGetConfiguration();
}

}  // namespace sim
