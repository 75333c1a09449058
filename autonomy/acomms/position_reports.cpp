// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/position_reports.hpp"

#include <cmath>

#include "shoal/message_codec.hpp"

namespace autonomy {

namespace {

/// Change of speed during the travel of a report, by which a rover deviates from its reported motion.
constexpr double speed_change_std_mps = 0.3;

}  // namespace

shoal::modem_send_t broadcast(const shoal::position_report_t& report) {
  const std::vector<std::byte> bytes = shoal::encode(report);
  shoal::modem_send_t message{};
  message.utime = report.utime;
  message.size = static_cast<std::int32_t>(bytes.size());
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  message.data.assign(data, data + bytes.size());
  return message;
}

void PositionReports::receive(const shoal::modem_received_t& packet) {
  const auto* data = reinterpret_cast<const std::byte*>(packet.data.data());
  auto report = shoal::decode<shoal::position_report_t>({data, packet.data.size()}, shoal::Finite::required);
  if (report.vehicle != packet.source)
    throw shoal::MessageError("'" + packet.source + "' sent a position report in the name of '" + report.vehicle + "'");
  if (!(report.position_std_m > 0)) throw shoal::MessageError("a position report must have position_std_m > 0");
  if (std::hypot(report.velocity_mps[0], report.velocity_mps[1]) > max_speed_mps)
    throw shoal::MessageError("a position report has an implausible speed");
  // Both by the clock of the sender.
  if (report.utime > packet.sent_utime) throw shoal::MessageError("a position report has a time stamp in the future");
  unused_[report.vehicle] = std::move(report);
}

std::optional<PositionReports::Neighbor> PositionReports::take(const std::string& vehicle, std::int64_t utime) {
  const auto found = unused_.find(vehicle);
  if (found == unused_.end()) return std::nullopt;
  const shoal::position_report_t report = found->second;
  const double age_s = static_cast<double>(utime - report.utime) * 1e-6;
  if (age_s < 0) return std::nullopt;  // detected before it was written: it is for the next detection
  unused_.erase(found);
  if (age_s > oldest_s) return std::nullopt;
  const Vector2d p_W(report.position_m[0], report.position_m[1]);
  const Vector2d v_W(report.velocity_mps[0], report.velocity_mps[1]);
  return Neighbor{p_W + v_W * age_s, std::hypot(report.position_std_m, speed_change_std_mps * age_s)};
}

}  // namespace autonomy
