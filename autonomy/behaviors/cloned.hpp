// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

namespace autonomy {

/// Object of a derived class that is copied with its owner.  `T` has `std::unique_ptr<T> clone() const`.
template <class T>
class Cloned {
 public:
  /// Must not be null.
  template <class Derived>
  Cloned(std::unique_ptr<Derived> object) : object_(std::move(object)) {}
  Cloned(const Cloned& other) : object_(other.object_->clone()) {}
  Cloned(Cloned&& other) noexcept = default;
  Cloned& operator=(const Cloned& other) {
    object_ = other.object_->clone();
    return *this;
  }
  Cloned& operator=(Cloned&& other) noexcept = default;
  ~Cloned() = default;

  T* operator->() { return object_.get(); }
  const T* operator->() const { return object_.get(); }
  T& operator*() { return *object_; }
  const T& operator*() const { return *object_; }

 private:
  std::unique_ptr<T> object_;
};

}  // namespace autonomy
