// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/cooperative/driver/navigator.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace navigator_fixture {

using namespace navigation;

inline NavEvent moved_at(Time time, const Vector2& v_W) {
  NavEvent event;
  event.time = time;
  event.v_W = v_W;
  event.q = 0.01 * Matrix2::Identity();
  return event;
}

inline NavEvent heard_at(Time time, double range_m) {
  static const Bytes payload = test::started("naive", test::nav_setup(2, 1, {-300, 0}, 1))->make_payload(0, 100);
  NavEvent event;
  event.kind = NavEvent::Kind::received;
  event.time = time;
  event.received = test::received_from(1, {}, range_m, 1, time);
  event.payload = payload;
  return event;
}

}  // namespace navigator_fixture
