// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_record.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/terminal/terminal_parser.hpp"
#include "shoal/message_schema.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/scratch_file.hpp"

// Results that are read again (summary.json, errors.csv), pieces of a snapshot in a log, keys of a terminal.

namespace {

void add_pieces(fuzz::Reader& reader) {
  experiment::SnapshotPieces pieces;
  while (!reader.ended()) {
    shoal::sim_snapshot_t piece{};
    piece.step = reader.byte();
    piece.piece = static_cast<std::int32_t>(reader.byte()) - 1;
    piece.pieces = static_cast<std::int32_t>(reader.byte()) - 1;
    piece.bytes = reader.number<std::int64_t>();
    const fuzz::Input data = reader.bytes(reader.byte());
    piece.size = static_cast<std::int32_t>(data.size());
    for (const std::byte byte : data) piece.data.push_back(static_cast<std::uint8_t>(byte));
    fuzz::allow<shoal::MessageError>([&] {
      if (const auto whole = pieces.add(piece))
        fuzz::require(static_cast<std::int64_t>(whole->size()) == piece.bytes, "a snapshot is as long as it said");
    });
    pieces.missing();
  }
}

}  // namespace

SHOAL_FUZZ_TARGET(results) {
  fuzz::Reader reader(input);
  switch (reader.below(4)) {
    case 0:
      fuzz::write_scratch("summary.json", reader.rest());
      fuzz::allow<std::runtime_error>([] { experiment::read_run(fuzz::scratch_folder().string()); });
      break;
    case 1: {
      const std::string path = fuzz::write_scratch("errors.csv", reader.rest());
      experiment::bands_of({experiment::read_error_curve(path, "m", "time_s")});
      break;
    }
    case 2: {
      experiment::KeySequences keys;
      experiment::KeySequences::Clock::time_point now{};
      while (!reader.ended()) keys.next(static_cast<char>(reader.byte()), now += std::chrono::milliseconds(7));
      keys.alone(now);
      break;
    }
    default:
      add_pieces(reader);
  }
}
