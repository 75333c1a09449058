// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "sim/bus/bus.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/scene/material.hpp"

namespace bridges {

/// Meshes, terrains and images that a scene names, by the hash of their contents; docs/develop/view_protocol.md has the
/// layout.  Files are read again, since the physics keeps them in another form; each is read once.
class SceneAssets {
 public:
  /// Maximum size of an asset, bytes.  A terrain is thinned out to fit; other assets that are larger are left out.
  static constexpr std::size_t max_bytes = 8'000'000;

  /// Add the mesh or terrain of a part, or the image of a texture, and return its hash; empty: the file cannot be read
  /// any more, or the asset is too large.
  std::string add_mesh(const sim::PartConfig& part);
  std::string add_terrain(const sim::PartConfig& part);
  std::string add_image(const sim::TextureConfig& texture);
  /// Returns the assets by hash.
  const std::map<std::string, sim::Bytes>& all() const { return assets_; }

 private:
  std::string keep(const std::string& source, sim::Bytes bytes);

  std::map<std::string, sim::Bytes> assets_;
  std::map<std::string, std::string> hash_of_;  // by source: file and scale
};

}  // namespace bridges
