// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shoal/sim_control_request_t.hpp"

namespace bridges {

/// Orders the requests of lockstep clients that change the world independently of the network, as sim::ClientMessages
/// orders their other messages: in rounds of one request of each client, by client name.  A round begins when every
/// client that the world waits for has a request here, for it may wait for the reply before it answers its tick.
///
/// A request that is equal to an earlier one of the client, with the same `id` other than 0, is a repetition.
class ClientRequests {
 public:
  struct Waiting {
    int link = 0;  ///< index of the bus on which it arrived
    shoal::sim_control_request_t request{};
    std::string signer;  ///< verified sender; empty: none
  };
  struct Answer {
    bool ok = false;
    std::string text;
  };
  /// Limits of the waiting requests of a client, and of the texts of all clients.
  static constexpr std::size_t max_waiting = 100, max_waiting_bytes = 64 << 20;
  /// Number of answers kept for repetitions, of each client.
  static constexpr std::size_t max_answers = 20;

  /// Adds a request; does nothing when it repeats one that waits.  Returns false when too many wait.
  bool add(Waiting request);
  bool empty() const { return count_ == 0; }
  /// Returns whether a request of the client waits.
  bool has(const std::string& client) const { return waiting_.contains(client); }
  /// Returns whether a request of the client to leave waits.
  bool is_leaving(const std::string& client) const;
  /// Removes and returns the next request; none while one of the `late` clients, which have a tick that they have not
  /// answered, has no request here.
  std::optional<Waiting> next(const std::vector<std::string>& late);
  /// Removes and returns all requests, by client name.
  std::vector<Waiting> take_all();

  /// Stores the answer to a request, for its repetitions.
  void note_answer(const shoal::sim_control_request_t& request, Answer answer);
  /// Returns the answer to the request that this one repeats; null: it repeats none.
  const Answer* answer_to(const shoal::sim_control_request_t& request) const;
  /// Discards the requests of a client, whose session is over, and the answers to it.
  void discard(const std::string& client);
  /// Discards the answers to all clients: what was done in a branch that was left is not done.
  void discard_answers() { answered_.clear(); }

 private:
  /// An answered request, without its text, which may be long.
  struct Answered {
    std::int32_t id;
    std::string command;
    double value;
    std::size_t text_hash, text_size;
    Answer answer;
  };

  std::map<std::string, std::deque<Waiting>, std::less<>> waiting_;  // by client; none is empty
  std::size_t count_ = 0, bytes_ = 0;
  std::deque<std::string> round_;  // clients whose turn comes in the present round
  std::map<std::string, std::deque<Answered>, std::less<>> answered_;
};

}  // namespace bridges
