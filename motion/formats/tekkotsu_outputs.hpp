// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "experiment/files/line_reader.hpp"
#include "motion/formats/motion_format.hpp"

namespace motion {

/// Value of an output of Tekkotsu, and its weight among other motions: 0 none.
struct TekkotsuValue {
  double value = 0, weight = 1;
};

/// Values of each joint by time in ms.
struct TekkotsuKeys {
  std::vector<std::string> order;  ///< joints, by first mention
  std::map<std::string, std::map<std::int64_t, TekkotsuValue>> by_joint;
  std::size_t size = 0;  ///< values in all

  void set(const std::string& joint, std::int64_t time_ms, const TekkotsuValue& value);
};

/// Names of outputs in a file, as Tekkotsu finds them: `~` at the end is left out, a name may be shortened, and one
/// without L or R means both sides.  Outputs that the vehicle does not have are left out and become losses.
class TekkotsuOutputs {
 public:
  TekkotsuOutputs(const MotionSource& source, Losses& losses) : source_(source), losses_(losses) {}

  /// Returns the joints of the vehicle that a word names.
  std::vector<std::string> joints_of(const experiment::LineReader& lines, const experiment::Word& word);
  /// Adds the losses.
  void list_unknown();

 private:
  std::vector<std::string> matches(const std::string& name) const;

  const MotionSource& source_;
  Losses& losses_;
  std::vector<std::string> unknown_;
};

/// Reads a file of keys or of a posture into `keys`, from `start_ms` on; returns the time from there to its last key.
/// `depth`: of files that name each other.  Throws sim::ConfigError.
std::int64_t read_tekkotsu(const MotionSource& source, std::int64_t start_ms, int depth, TekkotsuOutputs& outputs,
                           TekkotsuKeys& keys, Losses& losses);

constexpr std::size_t max_tekkotsu_word = 31;  ///< values and times
constexpr std::size_t max_tekkotsu_name = 63;

}  // namespace motion
