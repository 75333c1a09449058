// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/python/python_host.hpp"

namespace navigation {

namespace {

using nlohmann::json;

std::string hex_of(std::span<const std::uint8_t> bytes) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

Bytes bytes_of_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return bytes;
}

json json_of(const DeviceErrors& errors) {
  return {{"heading_bias_rad", errors.heading_bias_rad},
          {"heading_walk_radprts", errors.heading_walk_radprts},
          {"slow_heading_rad", errors.slow_heading_rad},
          {"slow_heading_time_s", errors.slow_heading_time_s},
          {"speed_scale", errors.speed_scale},
          {"clock_s", errors.clock_s},
          {"clock_drift", errors.clock_drift},
          {"clock_walk_srts", errors.clock_walk_srts},
          {"slow_fix_m", errors.slow_fix_m},
          {"slow_fix_time_s", errors.slow_fix_time_s}};
}

/// Estimator whose object is in a PythonHost; the driver goes back by copies there.
class PythonEstimator final : public Estimator {
 public:
  explicit PythonEstimator(std::shared_ptr<PythonHost> host) : host_(std::move(host)), number_(host_->new_number()) {
    host_->send({{"do", "new"}, {"id", number_}});
  }
  PythonEstimator(const PythonEstimator& other) : host_(other.host_), number_(host_->new_number()), v_W_(other.v_W_) {
    host_->send({{"do", "copy"}, {"id", number_}, {"of", other.number_}});
  }
  PythonEstimator& operator=(const PythonEstimator&) = delete;
  ~PythonEstimator() override {
    try {
      host_->send({{"do", "drop"}, {"id", number_}});
    } catch (const std::invalid_argument&) {
      // The interpreter has ended, which the next call reports.
    }
  }

  void start(const Setup& setup) override {
    json team = json::array(), team_errors = json::array();
    for (const Member& member : setup.team) {
      team.push_back(member.name);
      team_errors.push_back(json_of(member.errors));
    }
    request("start", {{"team", team},
                      {"team_errors", team_errors},
                      {"own", setup.own},
                      {"time", seconds(setup.time)},
                      {"position", {setup.position_W.x(), setup.position_W.y()}},
                      {"position_std", setup.position_std_m},
                      {"sound_speed", setup.sound_speed_mps},
                      {"payload_bytes", setup.payload_bytes},
                      {"gate", setup.gate},
                      {"seed", setup.seed}});
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    v_W_ = v_W;
    send("predict", {{"t", seconds(time)}, {"v", {v_W.x(), v_W.y()}}, {"q", {q(0, 0), q(0, 1), q(1, 0), q(1, 1)}}});
  }
  void fix(Time time, const Vector2& p_W, double std_m) override {
    send("fix", {{"t", seconds(time)}, {"p", {p_W.x(), p_W.y()}}, {"std", std_m}});
  }
  void on_range(const ReceivedRange& received) override {
    send("on_range", {{"toa", seconds(received.toa)},
                      {"tol", seconds(received.tol)},
                      {"sender", received.sender},
                      {"range", received.range_m},
                      {"std", received.std_m},
                      {"own_z", received.own_z_m},
                      {"z", received.sender_z_m},
                      {"payload_time", seconds(received.payload_time)},
                      {"payload", hex_of(received.payload)}});
  }
  void on_bearing(const Relative& seen) override {
    send("on_bearing", {{"t", seconds(seen.time)},
                        {"other", seen.other},
                        {"range", seen.range_m},
                        {"bearing", seen.bearing_rad},
                        {"by_other", seen.by_other},
                        {"range_std", seen.range_std_m},
                        {"bearing_std", seen.bearing_std_rad},
                        {"payload_time", seconds(seen.payload_time)},
                        {"payload", hex_of(seen.payload)}});
  }
  Bytes make_payload(Time time, std::size_t max_bytes) override {
    return bytes_of_hex(
        request("make_payload", {{"t", seconds(time)}, {"most", max_bytes}})["payload"].get<std::string>());
  }
  Estimate now(Time time) const override {
    const auto numbers = request("now", {{"t", seconds(time)}})["numbers"].get<std::vector<double>>();
    Estimate estimate;
    estimate.p_W << numbers[0], numbers[1];
    estimate.P << numbers[2], numbers[3], numbers[4], numbers[5];
    estimate.v_W = v_W_;
    return estimate;
  }
  std::unique_ptr<Estimator> clone() const override { return std::make_unique<PythonEstimator>(*this); }

 private:
  void send(const char* what, json given) const {
    host_->send({{"do", what}, {"id", number_}, {"given", std::move(given)}});
  }
  json request(const char* what, json given) const {
    return host_->request({{"do", what}, {"id", number_}, {"given", std::move(given)}});
  }

  std::shared_ptr<PythonHost> host_;
  int number_;
  Vector2 v_W_ = Vector2::Zero();
};

/// Makes the algorithm of `FILE.Class`, where FILE.py is a path.
Algorithm python_algorithm(const std::string& rest) {
  const std::size_t dot = rest.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == rest.size())
    throw std::invalid_argument("an algorithm in Python is python:FILE.Class, got 'python:" + rest + "'");
  const auto host = std::make_shared<PythonHost>(rest.substr(0, dot), rest.substr(dot + 1));
  return {"python:" + rest,
          "an algorithm in Python",
          [host] { return std::make_unique<PythonEstimator>(host); },
          {},
          host->has_on_bearing(),
          true,
          [host] { return host->cpu_s(); }};
}

[[maybe_unused]] const bool registered_python = detail::add_family("python:", python_algorithm);

}  // namespace

}  // namespace navigation
