// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/web/page_output.hpp"

namespace viewer {

/// Recording of what the live page shows of a log, as messages of its protocol (docs/develop/view_protocol.md) with
/// their times: the content of a page that needs no server.
class Recording final : public bridges::PageOutput {
 public:
  /// Kind of an entry; the numbers are those of the file.
  enum class Kind : std::uint32_t { text = 1, state = 2, asset = 3, estimates = 4 };
  struct Entry {
    Kind kind;
    std::int64_t time_us;  ///< simulated time from which it is shown
    std::uint64_t asset;   ///< hash; 0: not an asset
    std::string bytes;
  };
  /// Limits of the memory for what moves: beyond them states are made less often, and sounds are left out.
  struct Limits {
    std::size_t state_bytes = std::size_t{64} << 20;
    std::size_t text_bytes = std::size_t{64} << 20;
  };

  /// Reads a log of `shoal run --record`.  `progress`: receives the share that was read, 0 to 1.  Throws BusError, and
  /// std::runtime_error when the log has nothing to show.
  Recording(const std::string& log, const std::string& version, const Limits& limits,
            const std::function<void(double share)>& progress = {});

  /// Keeps every second state and estimate, and the last state if `keep_last`.  Returns false when there are at most
  /// two.
  bool thin(bool keep_last = true);
  /// Leaves out all sounds and receptions.  Returns false when there are none.
  bool drop_sounds();

  /// Returns the entries in the form that viewer/page/recording.js reads: for each u32 kind, u32 number of bytes, i64
  /// time_us, u64 asset, bytes; little-endian.
  std::string to_bytes() const;
  const std::vector<Entry>& entries() const { return entries_; }
  std::int64_t start_us() const { return start_us_; }
  std::int64_t end_us() const { return end_us_; }
  /// Return the number of states, and of those that the log has.
  std::size_t states() const { return states_; }
  std::size_t states_of_log() const { return states_of_log_; }
  /// Returns the number of sounds and receptions that were left out.
  std::size_t dropped_texts() const { return dropped_texts_; }
  const std::string& world() const { return world_; }
  /// Returns what is wrong with the log.
  const std::vector<std::string>& problems() const { return problems_; }

  int clients() const override { return 1; }
  void send_state(std::span<const std::byte> state) override;
  void send_text(std::string json) override;
  void retain(std::string_view op, std::string json) override;
  void set_asset(std::uint64_t hash, std::span<const std::byte> bytes) override;

 private:
  void read(const std::string& log, const std::function<void(double share)>& progress);
  void add(Kind kind, std::string bytes);
  /// Forgets what is after a time: the run was rewound.
  void rewind(std::int64_t time_us);

  const Limits limits_;
  std::vector<Entry> entries_;
  std::string world_;
  std::vector<std::string> problems_;
  std::int64_t epoch_us_ = 0, start_us_ = 0, end_us_ = 0, now_us_ = 0;
  std::size_t states_ = 0, states_of_log_ = 0, dropped_texts_ = 0, text_bytes_ = 0, last_state_bytes_ = 0;
};

}  // namespace viewer
