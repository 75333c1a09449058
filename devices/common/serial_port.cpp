// SPDX-License-Identifier: BSD-3-Clause
#include "devices/common/serial_port.hpp"

#include <stdexcept>

#include "sim/world/world.hpp"

namespace devices {

namespace {

struct SerialLosses {
  std::uint64_t dropped_bytes = 0;
};

const sim::SharedKind<SerialLosses> serial_losses;

}  // namespace

std::uint64_t serial_dropped_bytes(const sim::World& world) {
  return world.shared().of(serial_losses).dropped_bytes;
}

void SerialParams::read(sim::ParamReader& in) {
  in.read_choice("kind", kind, {{"pty", sim::PortKind::pty}, {"fifo", sim::PortKind::fifo}},
                 "pseudo-terminal, or a pair of FIFOs PATH.in and PATH.out");
  in.require("path");
  in.read_path("path", path, sim::PathUse::made,
               "path relative to the folder of the run; {vehicle}, {device} and {run} are replaced");
  if (in.has("path") && path.empty()) in.error("path", "'path' must not be empty");
}

void SerialMessageParams::read(sim::ParamReader& in) {
  SerialParams::read(in);
  in.read_choice("framing", framing, {{"line", Framing::line}, {"raw", Framing::raw}},
                 "line: one message per line; raw: one message with all bytes received within a step");
}

SerialPort::SerialPort(const SerialParams& params, const sim::DeviceContext& context)
    : host_(context.host),
      who_("vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'"),
      path_(sim::channel_name(params.path, context.vehicle.name(), context.config.name)) {
  if (!context.host.open_port) return;
  try {
    port_ = context.host.open_port(params.kind, path_);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(who_ + ": " + error.what());
  }
}

sim::Bytes SerialPort::read() {
  return port_ ? port_->read() : sim::Bytes{};
}

void SerialPort::write(std::span<const std::byte> bytes) {
  if (!port_) return;
  port_->write(bytes);
  const std::uint64_t dropped_bytes = port_->dropped_bytes();
  if (dropped_bytes == dropped_bytes_) return;
  host_.shared.of(serial_losses).dropped_bytes += dropped_bytes - dropped_bytes_;
  const bool reported = dropped_bytes_ > 0;
  dropped_bytes_ = dropped_bytes;
  if (!reported) host_.warnings.bad_message(who_, "no program reads '" + path_ + "': the oldest bytes are dropped");
}

void SerialPort::write(const std::string& text) {
  write(std::as_bytes(std::span(text.data(), text.size())));
}

void warn_of_length(sim::WorldWarnings& warnings, const std::string& device, std::size_t max_bytes) {
  warnings.bad_message("device '" + device + "'",
                       "the data received on its serial port exceeds " + std::to_string(max_bytes) + " bytes");
}

SerialMessages::SerialMessages(const SerialMessageParams& params, const sim::DeviceContext& context)
    : port_(params, context), lines_(params.framing == SerialMessageParams::Framing::line) {}

std::vector<sim::Bytes> SerialMessages::take(std::size_t max_bytes) {
  sim::Bytes bytes = port_.read();
  std::vector<sim::Bytes> messages;
  // Raw framing: one message per step.
  if (!lines_) {
    if (bytes.size() > max_bytes) bytes.resize(max_bytes + 1);
    if (!bytes.empty()) messages.push_back(std::move(bytes));
    return messages;
  }
  // Line framing: one message per line.
  for (const std::byte b : bytes) {
    if (b == std::byte{'\n'}) {
      // Keep one byte more than allowed, to mark the line as too long.
      if (cut_) line_.resize(max_bytes + 1);
      if (!line_.empty()) messages.push_back(std::move(line_));
      line_.clear();
      cut_ = false;
    } else if (b != std::byte{'\r'}) {
      if (line_.size() < max_bytes)
        line_.push_back(b);
      else
        cut_ = true;
    }
  }
  return messages;
}

void SerialMessages::write(sim::Bytes data) {
  if (lines_) data.push_back(std::byte{'\n'});
  port_.write(data);
}

}  // namespace devices
