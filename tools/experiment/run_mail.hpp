#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "sim/bus/bus.hpp"

namespace tools {

/// Something that came into the world from outside.
struct Letter {
  std::string bus;      ///< of `buses:`; empty: the world's
  std::string channel;  ///< `sim.control`: a request that changed the world
  sim::Bytes payload;
};

/// What came into a run from outside, step by step, and a way to let it come in again.
class RunMail {
 public:
  virtual ~RunMail() = default;
  /// `listener` is told of every letter in the order in which they took effect, with the number of the step that was
  /// over then.
  using Listener = std::function<void(std::int64_t step, const Letter& letter)>;
  virtual void set_listener(Listener listener) = 0;
  /// While muted nothing goes out, what comes in is thrown away, and the listener is told of nothing.
  virtual void set_muted(bool muted) = 0;
  /// A letter takes effect again.
  virtual void deliver(const Letter& letter) = 0;
  /// All that was delivered is there: the step may be taken.
  virtual void admit() = 0;
};

}  // namespace tools
