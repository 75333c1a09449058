// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/log/state_frame.hpp"

namespace viewer {

/// Names of the movable bodies of scenes, by which states of one scene are shown in another: of another time, branch or
/// log.
class SceneNames {
 public:
  /// Maximum number of scenes that are known; the oldest are forgotten.
  static constexpr std::size_t max_scenes = 200;

  /// Takes a scene: a JSON text as in docs/develop/view_protocol.md.  One that is not a scene is ignored.
  void add(std::string_view scene);
  /// Returns the revision of the scene that was added last; 0: none.
  std::uint32_t newest() const { return newest_; }
  /// Returns the names of the movable bodies of a revision, in the order of its states; empty: unknown.
  const std::vector<std::string>& of(std::uint32_t revision) const;

  /// Adds bodies of a revision to a frame, in the order of the newest scene.  Bodies that the revision lacks are
  /// unknown; those that only it has are left out.
  void arrange(std::uint32_t revision, std::span<const std::byte> bodies, StateFrame& frame) const;

 private:
  std::map<std::uint32_t, std::vector<std::string>> names_;
  std::uint32_t newest_ = 0;
};

/// Adds bodies with names of their own to a frame, in the order of other names.
void arrange(std::span<const std::byte> bodies, const std::vector<std::string>& names,
             const std::vector<std::string>& order, StateFrame& frame);

}  // namespace viewer
