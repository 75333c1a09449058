// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/motion/formats/format_fixture.hpp"

namespace mtn_format_fixture {

/// Bytes as the description of the format has them.
class Bytes {
 public:
  Bytes& words(std::initializer_list<std::int64_t> values) {
    for (const std::int64_t value : values)
      for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
    return *this;
  }
  Bytes& halves(std::initializer_list<int> values) {
    for (const int value : values) bytes += {static_cast<char>(value & 0xff), static_cast<char>(value >> 8)};
    return *this;
  }
  Bytes& text(const std::string& text) {
    bytes += static_cast<char>(text.size());
    bytes += text;
    return *this;
  }
  Bytes& zeros(int count) {
    bytes.append(static_cast<std::size_t>(count), '\0');
    return *this;
  }
  std::string bytes;
};

/// Locators with the lengths of those of a dog of 20 joints.
inline std::vector<std::string> locators() {
  std::vector<std::string> all{"PRM:/r1/c1-Joint2:j1",          "PRM:/r1/c1/c2-Joint2:j2",
                               "PRM:/r1/c1/c2/c3-Joint2:j3",    "PRM:/r1/c1/c2/c3/c4-Joint2:j4",
                               "PRM:/r1/c1/c2/c3/e1-Joint3:j5", "PRM:/r1/c1/c2/c3/e2-Joint3:j6"};
  for (const char* leg : {"r2", "r3", "r4", "r5"})
    for (const char* part : {"c1-Joint2:j1", "c1/c2-Joint2:j2", "c1/c2/c3-Joint2:j3"})
      all.push_back("PRM:/" + std::string(leg) + "/" + part);
  all.insert(all.end(), {"PRM:/r6/c1-Joint2:j1", "PRM:/r6/c2-Joint2:j2"});
  return all;
}

/// A file with the structure of Sony's worked example, and our own content: 6 keys of 20 joints, 1164 bytes.
inline std::string example() {
  Bytes out;
  out.bytes = "OMTN";
  out.words({0, 24, 4}).halves({1, 2, 6, 16}).words({0});
  // 8 + 14 + 17 + 8 = 47 bytes, and one zero.
  out.words({1, 48}).text("b_stand#lie_S").text("Makers of Shoal.").text("XYZ-910").zeros(1);
  Bytes names;
  names.halves({20});
  for (const std::string& locator : locators()) names.text(locator);
  const int padding = static_cast<int>((4 - names.bytes.size() % 4) % 4);
  names.zeros(padding);
  out.words({2, static_cast<std::int64_t>(names.bytes.size()) + 8});
  out.bytes += names.bytes;
  out.words({3, 12 + 6 * 23 * 4 + 5 * 4, 0});
  int key = 0;
  for (const int between : {-1, 60, 50, 40, 50, 100}) {
    if (between >= 0) out.words({between});
    out.words({0, 34906 - 1000 * key, 0});
    for (int joint = 0; joint < 20; ++joint)
      out.words({(joint * 37 + key * 101) % 180 * 17453 - 1000003 * (joint % 3)});
    ++key;
  }
  return out.bytes;
}

}  // namespace mtn_format_fixture
