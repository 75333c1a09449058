// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/islands.hpp"

#include <algorithm>
#include <utility>

#include "sim/base/free_numbers.hpp"

namespace sim {

void Islands::add_body(int body) {
  slot(joint_parent_, body) = body;
  slot(joint_rows_, body) = 0;
}

void Islands::add_joint(int first, int second, int rows) {
  joint_max_ = std::max(joint_max_, join(joint_parent_, joint_rows_, first, second, rows));
  paths_are_short_ = false;
}

void Islands::remove_bodies(std::span<const int> bodies) {
  for (const int body : bodies) add_body(body);
  joint_max_ = 0;
  for (std::size_t body = 0; body < joint_parent_.size(); ++body)
    if (joint_parent_[body] == static_cast<int>(body)) joint_max_ = std::max(joint_max_, joint_rows_[body]);
}

void Islands::begin_step() {
  // Compress the paths once after joints were added: each step then starts with paths of length one.
  if (!paths_are_short_)
    for (int body = 0; body < static_cast<int>(joint_parent_.size()); ++body) root(joint_parent_, body);
  paths_are_short_ = true;
  parent_ = joint_parent_;
  rows_ = joint_rows_;
}

int Islands::add_contact(int first, int second, int rows) {
  return join(parent_, rows_, first, second, rows);
}

int Islands::root(std::vector<int>& parent, int body) {
  while (parent[body] != body) {
    parent[body] = parent[parent[body]];
    body = parent[body];
  }
  return body;
}

int Islands::join(std::vector<int>& parent, std::vector<int>& rows, int first, int second, int added) {
  // A fixed body does not connect: two stacks on one floor are two islands.
  if (first < 0) std::swap(first, second);
  if (first < 0) return 0;
  int a = root(parent, first);
  if (second >= 0) {
    int b = root(parent, second);
    if (a != b) {
      if (b < a) std::swap(a, b);
      parent[b] = a;
      rows[a] += rows[b];
    }
  }
  return rows[a] += added;
}

}  // namespace sim
