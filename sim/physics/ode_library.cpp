#include "sim/physics/ode_library.hpp"

#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "sim/physics/physics_world.hpp"

namespace sim {
namespace {

std::atomic<std::int64_t> message_count = 0;

std::string formatted(const char* text, va_list arguments) {
  char buffer[512];
  std::vsnprintf(buffer, sizeof buffer, text, arguments);
  return buffer;
}

// "LCP internal error, s <= 0" comes by the hundred from stacks of boxes that stand well: say it once.
void on_message(int, const char* text, va_list arguments) {
  if (message_count++ == 0) spdlog::debug("ODE: {} (further messages are only counted)", formatted(text, arguments));
}

[[noreturn]] void on_error(int, const char* text, va_list arguments) {
  throw PhysicsFault("ODE: " + formatted(text, arguments));
}

struct Library {
  Library() {
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

}  // namespace sim
