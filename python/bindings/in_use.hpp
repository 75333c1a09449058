// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstring>
#include <new>
#include <string>
#include <thread>

namespace python {

/// Base of classes that Python holds: an object that Python made without calling its constructor is all zeros.
struct ZeroedMemory {
  static void* operator new(std::size_t bytes) { return std::memset(::operator new(bytes), 0, bytes); }
  static void* operator new(std::size_t, void* at) { return at; }
  static void operator delete(void* memory) { ::operator delete(memory); }
};

/// Object that one thread may use at a time, in the process that made it.  Python code may hold it in several threads
/// and in forked processes.
class Guarded : public ZeroedMemory {
 public:
  explicit Guarded(std::string name);

  /// Use of the object by this thread, which may be nested.  Its constructor throws Error when another thread uses the
  /// object, and in a forked process, where its threads and sockets are not.
  class Use {
   public:
    explicit Use(Guarded& object);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Guarded& object_;
  };

  /// Returns whether this process made the object.
  bool is_ours() const;
  /// Throws Error when no constructor was called.
  void require_made() const;

 private:
  const std::string name_;  // in errors: `the world`
  const int process_;
  std::atomic<std::thread::id> user_{};
  int depth_ = 0;  // of nested uses by that thread
};

/// Returns whether Python has handled a signal such as Ctrl-C by an exception, which raise_interrupt() raises, or is
/// about to end.  Must be called without the GIL.
bool interrupted();
/// Raises the exception that interrupted() found, if any.  Must be called with the GIL.
void raise_interrupt();

}  // namespace python
