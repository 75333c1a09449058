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
  /// Forgets what has come.
  void clear();
  std::uint64_t repeated() const { return repeated_; }

 private:
  static constexpr std::size_t most_strangers = 20'000;
  static constexpr std::size_t most_recent = 8192;

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

  void take(std::vector<MailGate::Mail>& mail);
  void match(std::vector<Expected>& list);
  void remember(const NamedMessage& named);

  MailGate& gate_;
  std::map<std::string, std::vector<Expected>, std::less<>> expected_;
  std::deque<Stray> strays_;                                     // came, and nobody named them yet
  std::multiset<std::pair<std::string, std::uint32_t>> recent_;  // admitted from clients a short time ago
  std::deque<std::pair<std::string, std::uint32_t>> recent_order_;
  std::uint64_t repeated_ = 0;
};

}  // namespace sim
