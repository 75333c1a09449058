// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/front_seat.hpp"
#include "bridges/moos/moos_file.hpp"
#include "bridges/moos/moos_session.hpp"
#include "bridges/moos/moos_variables.hpp"
#include "sim/config/diagnostics.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// What peers of MOOS write: first byte which of them.  0: bytes of a MOOSDB, from its welcome on; 1: a .moos file; 2: a
// variable, its name and text; others: lines of a back seat.

namespace {

void read_session(fuzz::Input input) {
  bridges::MoosSession session({"fuzz", {"DESIRED_SPEED"}, 1}, 0);
  bridges::MoosCommands commands({bridges::MoosCommands::Control::helm, "a", "d", "m", {}});
  double wall_s = 0;
  try {
    for (fuzz::Reader reader(input); !reader.ended();) {
      const std::vector<std::byte> bytes = [&] {
        const fuzz::Input piece = reader.bytes(1 + reader.below(255));
        return std::vector<std::byte>(piece.begin(), piece.end());
      }();
      session.receive(bytes, wall_s);
      for (const bridges::MoosMessage& message : session.take_received()) {
        fuzz::require(session.is_open(), "messages come after the welcome");
        commands.take(message);
      }
      session.keep_alive(wall_s += 0.01);
      fuzz::require(commands.take_commands(0).size() <= bridges::MoosCommands::max_modem_messages + 1,
                    "commands are bounded");
    }
  } catch (const bridges::MoosError&) {
  }
}

void read_lines(const std::string& text) {
  bridges::GobyFrontSeat goby("a");
  bridges::HeronFrontSeat heron({"p", "s", 1});
  bridges::LineReader lines;
  for (const std::string& line : lines.add(text)) {
    fuzz::require(line.size() <= bridges::LineReader::longest, "lines are bounded");
    fuzz::require(goby.take(line, 0).commands.size() <= 1, "a line is one command");
    heron.take(line, 0);
  }
}

}  // namespace

SHOAL_FUZZ_TARGET(moos) {
  fuzz::Reader reader(input);
  switch (reader.below(4)) {
    case 0:
      return read_session(reader.rest());
    case 1:
      try {
        const bridges::MoosFile file = bridges::read_moos_text(std::string(fuzz::text_of(reader.rest())), "fuzz.moos");
        fuzz::require(file.port > 0 && file.port < 65536 && file.time_warp > 0, "values are within their bounds");
      } catch (const sim::ConfigError&) {
      }
      return;
    case 2: {
      bridges::MoosCommands commands({bridges::MoosCommands::Control::actuators, "a", "d", "m", {}});
      bridges::MoosMessage message;
      message.key = reader.text();
      message.value_type = 'S';
      message.text = std::string(fuzz::text_of(reader.rest()));
      commands.take(message);
      commands.take_commands(0);
      return;
    }
    default:
      return read_lines(std::string(fuzz::text_of(reader.rest())));
  }
}
