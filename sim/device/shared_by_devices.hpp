// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace sim {

namespace detail {
using MakeShared = std::function<std::shared_ptr<void>()>;
/// Registers a kind and returns its index.
std::size_t register_shared_kind(MakeShared make);
}  // namespace detail

/// Kind of object that devices share, such as the network between radio modems: each world has one T, created with the
/// world.  To be defined once, as a constant beside T: `inline const sim::SharedKind<Network> network_of_modems;`.
template <typename T>
class SharedKind {
 public:
  SharedKind() : number_(detail::register_shared_kind([] { return std::make_shared<T>(); })) {}
  SharedKind(const SharedKind&) = delete;
  SharedKind& operator=(const SharedKind&) = delete;
  /// Returns the index of this kind among all kinds.
  std::size_t number() const { return number_; }

 private:
  std::size_t number_;
};

/// Objects shared by the devices of a world, one of each kind.
class SharedByDevices {
 public:
  /// Makes one object of each registered kind, including those of plugins, which are loaded before a world is built.
  SharedByDevices();

  /// The one thing of this kind.
  template <typename T>
  T& of(const SharedKind<T>& kind) {
    return *static_cast<T*>(things_.at(kind.number()).get());
  }
  /// The one thing of this kind.
  template <typename T>
  const T& of(const SharedKind<T>& kind) const {
    return *static_cast<const T*>(things_.at(kind.number()).get());
  }

 private:
  std::vector<std::shared_ptr<void>> things_;
};

}  // namespace sim
