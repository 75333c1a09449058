// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace motion {

/// Key of an MTN file; angles in 1e-6 rad.
struct MtnKey {
  std::int32_t between = 0;  ///< frames of 16 ms between the key before and this one; 0 in the first key
  std::int32_t roll = 0, pitch = 0, yaw = 0;  ///< of the body
  std::vector<std::int32_t> joints;
};

/// Content of an MTN file, version 1.2, data type 0 (angles).
struct MtnFile {
  std::string name, creator, design;
  std::vector<std::string> locators;  ///< of the joints
  std::vector<MtnKey> keys;
};

constexpr double mtn_frame_s = 0.016;

/// Reads a file.  Throws sim::ConfigError with the offset of the byte.
MtnFile parse_mtn(std::string_view bytes, const std::string& file);
/// Returns the bytes of a file with texts of at most 255 bytes, 1 to 65535 keys, and locators and joints of the same
/// number.
std::string mtn_bytes(const MtnFile& file);

}  // namespace motion
