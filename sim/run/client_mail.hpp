#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/bus/mail_gate.hpp"
#include "sim/run/lockstep.hpp"

namespace sim {

/// Sorts the mail at a gate, so that it does not depend on how the network delivered it: first what clients say they
/// published, by the name of the client and in their order; then what anybody else sent.  What came a second time is
/// dropped.
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
  /// A message of the list that was sent again.  False when it is not the one that was named.
  bool add(const std::string& client, std::int32_t place, const std::string& channel, const Bytes& payload);
  /// What is missing will not come any more.
  void give_up(const std::string& client);
  /// The mail of the step that begins; for MailGate::set_order.
  void order(std::vector<MailGate::Mail>& mail);
  /// Forgets what has come.  What clients have named and is still on its way is dropped when it comes.
  void clear();
  /// What a client named for a tick that counts no more: dropped, also when it comes later.
  void drop(const std::vector<NamedMessage>& named);
  /// Until release() nobody's mail is admitted that no client has named: it may be this client's, of a tick that counts
  /// no more.
  void hold(const std::string& client) { held_.insert(client); }
  void release(const std::string& client) { held_.erase(client); }
  /// Messages that came twice.  Nothing is lost with them.
  std::uint64_t repeated() const { return repeated_; }
  /// Messages that had to make room before they were admitted.
  std::uint64_t dropped() const { return dropped_; }

  /// Unnamed messages that wait: of one channel, and bytes of all.
  static constexpr std::size_t most_of_channel = 10'000;
  static constexpr std::size_t most_bytes = 256'000'000;
  /// So long what was admitted from a client is known, to drop what the network repeats.
  static constexpr std::int64_t recent_steps = 200;

 private:
  static constexpr std::size_t most_recent = 20'000;

  struct Expected {
    NamedMessage named;
    bool wanted = false;  ///< somebody reads the channel
    bool there = false;
    Bytes payload;
  };
  struct Stray {
    MailGate::Mail mail;
    std::uint32_t crc;
  };
  using Key = std::pair<std::string, std::uint32_t>;  // channel and CRC-32
  struct Recent {
    Key key;
    std::int64_t step;
  };
  using Strays = std::map<std::uint64_t, Stray>;  // by arrival

  void take(std::vector<MailGate::Mail>& mail);
  void match(std::vector<Expected>& list);
  void remember(const NamedMessage& named);
  void forget_old();
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
  std::multiset<Key> recent_;  // admitted from clients a short time ago
  std::deque<Recent> recent_order_;
  std::set<std::string> held_;
  std::int64_t step_ = 0;  // counts what order() has sorted
  std::uint64_t repeated_ = 0, dropped_ = 0;
};

}  // namespace sim
