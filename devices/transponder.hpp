#pragma once

#include <string>

#include "devices/acoustic_positioning.hpp"
#include "sim/device/device_registry.hpp"

namespace devices {

/// Acoustic transponder: answers the USBL devices of other vehicles in its network, after `turnaround_s`, while it is
/// under water, has power and is not silent by a fault.
class Transponder final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Acoustic transponder: answers USBL devices of its network.";
  static constexpr double default_rate_hz = 1;
  struct Params {
    std::string network = "usbl";
    double turnaround_s = 0.02;
    void read(sim::ParamReader& in);
  };

  Transponder(const Params& params, const sim::DeviceContext& context);
  ~Transponder() override;
  Transponder(const Transponder&) = delete;
  Transponder& operator=(const Transponder&) = delete;

  void measure(const sim::SenseContext&) override {}
  void disturb(double, sim::Random&) override {}
  void hash_state(sim::StateHash& hash) const override;

  /// It can answer a vehicle now.
  bool hears(const sim::Vehicle& vehicle, const std::string& network) const;
  void answer(const std::string& asked_by);
  sim::Vector3d p_WS() const { return body_.X_WB() * p_BS_; }
  int group() const { return vehicle_.group(); }
  const Params& params() const { return params_; }
  const std::string& full_name() const { return full_name_; }
  std::int64_t answers() const { return answers_; }
  const std::string& asked_by() const { return asked_by_; }

 private:
  Params params_;
  TransponderNetwork& network_;
  const sim::Medium& medium_;
  const sim::Vehicle& vehicle_;
  const sim::Body& body_;
  sim::Vector3d p_BS_;
  std::string full_name_;
  const sim::DeviceFaults& faults_;
  std::int64_t answers_ = 0;
  std::string asked_by_;
};

/// Publishes shoal.transponder_t.
class TransponderReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.transponder_t";
  explicit TransponderReporter(const Transponder& transponder) : transponder_(transponder) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Transponder& transponder_;
};

}  // namespace devices
