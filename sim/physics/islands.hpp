#pragma once

#include <vector>

namespace sim {

/// Counts the constraint rows of each island (bodies connected by joints and contacts) before a step, for
/// WorldStep costs the cube of them.  Joints stay, contacts are new in each step.
class Islands {
 public:
  void add_body();
  /// Connects two moving bodies for good; `second` -1: the world.
  void add_joint(int first, int second, int rows);

  /// Forgets the contacts of the last step.
  void begin_step();
  /// A contact between two bodies; either may be -1: fixed.
  void add_contact(int first, int second, int rows);
  int largest_rows() const { return largest_; }

 private:
  static int root(std::vector<int>& parent, int body);
  static int join(std::vector<int>& parent, std::vector<int>& rows, int first, int second, int added);

  std::vector<int> joint_parent_, joint_rows_;  // with joints only
  std::vector<int> parent_, rows_;              // with the contacts of this step
  int joint_largest_ = 0;
  int largest_ = 0;
};

}  // namespace sim
