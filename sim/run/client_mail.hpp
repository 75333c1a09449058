// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/bus/mail_gate.hpp"
#include "sim/run/lockstep.hpp"

namespace sim {

/// Sorts the mail at a gate, so that it does not depend on how the network delivered it: first what clients say they
/// published, by the name of the client and in their order; then what anybody else sent.
///
/// Who sent a message cannot be seen.  So of mail that nobody names one message is dropped for each message of a client
/// that has the same channel and bytes: within repeat_windows, as the network may have repeated it, and within
/// late_windows when the client's own is still on its way.
class ClientMail {
 public:
  /// `gate` must outlive this.
  explicit ClientMail(MailGate& gate) : gate_(gate) {}

  /// What a client says it published since its answer before.  What nobody reads at the gate is left out.
  void expect(const std::string& client, const std::vector<NamedMessage>& named);
  /// Takes what has come.  Call it before is_complete().
  void collect();
  bool is_complete(const std::string& client) const;
  /// Place, in the list given to expect(), of the first message that has not come; -1: all are there.
  std::int32_t first_missing(const std::string& client) const;
  /// How many of the list are missing, and the first: `2 of the 3 messages that it names have not come, first 'a.cmd'
  /// with CRC-32 1a2b3c4d`.  Empty: none is.
  std::string missing_text(const std::string& client) const;
  /// A message of the list that was sent again.  False when it is not the one that was named.  One that comes after the
  /// list was complete and admitted is left alone.
  bool add(const std::string& client, std::int32_t place, const std::string& channel, const Bytes& payload);
  /// What is wrong with one that add() refuses: `sends again 'a.cmd' with CRC-32 ... at place 2, but named ...`.
  std::string why_not(const std::string& client, std::int32_t place, const std::string& channel,
                      const Bytes& payload) const;
  /// What is missing will not come any more.
  void give_up(const std::string& client);
  /// The mail of the step that begins; for MailGate::set_order.
  void order(std::vector<MailGate::Mail>& mail);
  /// Forgets what has come.  What clients have named and is still on its way is dropped when it comes.
  void clear();
  /// What a client named for a tick that counts no more: dropped, also when it comes later.
  void drop(const std::string& client, const std::vector<NamedMessage>& named);
  /// Drops what has come and nobody named: a client that does not name what it publishes did so for a tick that counts
  /// no more.
  void drop_unnamed();
  /// Begins another window; the caller does so after equal times.
  void next_window();
  /// A message that was dropped as one of this client's that came twice.
  struct Repeated {
    std::string client, channel;
  };
  /// The first since the call before, and how many by client in all.
  std::optional<Repeated> take_repeated();
  const std::map<std::string, std::uint64_t, std::less<>>& repeated() const { return repeated_; }
  /// Messages that had to make room before they were admitted.
  std::uint64_t dropped() const { return dropped_; }

  /// Unnamed messages that wait: of one channel, and bytes of all.
  static constexpr std::size_t most_of_channel = 10'000;
  static constexpr std::size_t most_bytes = 256'000'000;
  static constexpr std::int64_t repeat_windows = 1, late_windows = 10;
  /// Of repeated(); those who come later are not counted.
  static constexpr std::size_t most_names = 2000;

 private:
  static constexpr std::size_t most_twins = 50'000;

  struct Expected {
    NamedMessage named;
    bool wanted = false;  ///< somebody reads the channel
    bool there = false;
    bool sent_again = false;  ///< its first copy may be on its way
    Bytes payload;
  };
  struct Stray {
    MailGate::Mail mail;
    std::uint32_t crc;
  };
  using Key = std::pair<std::string, std::uint32_t>;  // channel and CRC-32
  /// What to drop once, when it comes.
  struct Twin {
    std::string client;
    std::int64_t last_window;
    bool counts;  ///< as repeated; false: its tick was abandoned
  };
  using Strays = std::map<std::uint64_t, Stray>;  // by arrival

  void take(std::vector<MailGate::Mail>& mail);
  void match(std::vector<Expected>& list);
  void expect_twin(const std::string& client, const NamedMessage& named, std::int64_t windows, bool counts);
  bool is_twin(const Stray& stray);
  void forget_strays();
  /// Takes it out.
  Stray take_out(Strays::iterator stray);
  void drop_oldest(std::uint64_t arrival);

  MailGate& gate_;
  std::map<std::string, std::vector<Expected>, std::less<>> expected_;
  Strays strays_;  // came, and nobody named them yet
  std::map<Key, std::set<std::uint64_t>> by_key_;
  std::map<std::string, std::set<std::uint64_t>, std::less<>> by_channel_;
  std::size_t stray_bytes_ = 0;
  std::uint64_t arrivals_ = 0;
  std::multimap<Key, Twin> twins_;
  std::int64_t window_ = 0;
  std::map<std::string, std::uint64_t, std::less<>> repeated_;
  std::optional<Repeated> first_repeated_;
  std::uint64_t dropped_ = 0;
};

}  // namespace sim
