// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/camera_path.hpp"

#include <algorithm>
#include <cstddef>

namespace viewer {

void CameraKey::read(sim::ParamReader& in) {
  in.require("at_s");
  in.read("at_s", at_s, sim::between(0, 1e9), "simulated time");
  in.require("eye_m");
  in.read("eye_m", eye_m, sim::between(-1e7, 1e7), "position of the camera");
  in.require("look_m");
  in.read("look_m", look_m, sim::between(-1e7, 1e7), "point that the camera looks at");
  in.read_deg("fov_deg", fov_rad, sim::between(1, 170), "horizontal field of view");
  if (!in.describing() && (look_m - eye_m).norm() < 1e-3) in.error("look_m", "must not be the point of 'eye_m'");
}

void CameraPath::read(sim::ParamReader& in) {
  in.read("follow", follow, "vehicle to whose position the keys are relative; without it the origin of the world");
  in.require("keys");
  in.read_list("keys", keys, "key", "poses of the camera, at increasing times");
  if (in.describing()) return;
  if (in.has("keys") && keys.empty()) in.error("keys", "must have at least one key");
  if (keys.size() > 10'000) in.error("keys", "must have at most 10000 keys");
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (!(keys[i].at_s > keys[i - 1].at_s)) return in.error("keys", "'at_s' must increase from key to key");
}

CameraKey CameraPath::at(double time_s) const {
  if (time_s <= keys.front().at_s) return keys.front();
  if (time_s >= keys.back().at_s) return keys.back();
  // The keys around the time, and those before and after them.
  const auto after = std::upper_bound(keys.begin(), keys.end(), time_s,
                                      [](double at_s, const CameraKey& key) { return at_s < key.at_s; });
  const auto i = static_cast<std::size_t>(after - keys.begin());
  const CameraKey &from = keys[i - 1], &to = keys[i];
  const CameraKey &before = keys[i > 1 ? i - 2 : 0], &behind = keys[std::min(i + 1, keys.size() - 1)];
  const double span_s = to.at_s - from.at_s, u = (time_s - from.at_s) / span_s;
  // Cubic Hermite curve whose slope at a key is that between its neighbors.
  const double h0 = (1 + 2 * u) * (1 - u) * (1 - u), h1 = u * u * (3 - 2 * u);
  const double g0 = u * (1 - u) * (1 - u) * span_s / (to.at_s - before.at_s);
  const double g1 = u * u * (u - 1) * span_s / (behind.at_s - from.at_s);
  CameraKey key;
  key.at_s = time_s;
  key.eye_m = h0 * from.eye_m + h1 * to.eye_m + g0 * (to.eye_m - before.eye_m) + g1 * (behind.eye_m - from.eye_m);
  key.look_m =
      h0 * from.look_m + h1 * to.look_m + g0 * (to.look_m - before.look_m) + g1 * (behind.look_m - from.look_m);
  key.fov_rad = from.fov_rad + u * (to.fov_rad - from.fov_rad);
  if ((key.look_m - key.eye_m).norm() < 1e-3) key.look_m = key.eye_m + (to.look_m - to.eye_m);
  return key;
}

CameraPath read_camera_path(const std::string& file) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode tree = sim::load_config_file(file, diagnostics);
  diagnostics.throw_if_any();
  CameraPath path;
  sim::ParamReader in(tree, "camera path", diagnostics);
  path.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return path;
}

}  // namespace viewer
