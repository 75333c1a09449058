// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/client_requests.hpp"

#include <algorithm>
#include <functional>

#include "sim/config/message_text.hpp"

namespace bridges {

namespace {

bool is_repetition(const shoal::sim_control_request_t& one, const shoal::sim_control_request_t& other) {
  return one.id != 0 && one.id == other.id && one.command == other.command && one.value == other.value &&
         one.text == other.text;
}

}  // namespace

bool ClientRequests::add(Waiting request) {
  const std::string client = request.request.client;
  const auto known = waiting_.find(client);
  if (known != waiting_.end() && std::any_of(known->second.begin(), known->second.end(), [&](const Waiting& each) {
        return is_repetition(each.request, request.request);
        // A repetition is not an error: UDP may have lost the answer, which comes when the first copy is executed.
      }))
    return true;
  const std::size_t bytes = request.request.text.size();
  if (known != waiting_.end() && known->second.size() >= max_waiting) return false;
  if (bytes_ + bytes > max_waiting_bytes) return false;
  bytes_ += bytes;
  waiting_[client].push_back(std::move(request));
  ++count_;
  return true;
}

bool ClientRequests::is_leaving(const std::string& client) const {
  const auto known = waiting_.find(client);
  return known != waiting_.end() && std::any_of(known->second.begin(), known->second.end(),
                                                [](const Waiting& each) { return each.request.command == "leave"; });
}

std::optional<ClientRequests::Waiting> ClientRequests::next(const std::vector<std::string>& late) {
  // One request of each client per round, in the order of their names: the order in which they arrived would differ
  // from run to run.
  if (round_.empty()) {
    if (!std::all_of(late.begin(), late.end(), [this](const std::string& client) { return has(client); }))
      return std::nullopt;
    for (const auto& [client, requests] : waiting_) round_.push_back(client);
  }
  if (round_.empty()) return std::nullopt;
  const auto turn = waiting_.find(round_.front());
  round_.pop_front();
  Waiting request = std::move(turn->second.front());
  turn->second.pop_front();
  if (turn->second.empty()) waiting_.erase(turn);
  --count_;
  bytes_ -= request.request.text.size();
  return request;
}

std::vector<ClientRequests::Waiting> ClientRequests::take_all() {
  std::vector<Waiting> all;
  for (auto& [client, requests] : waiting_)
    for (Waiting& request : requests) all.push_back(std::move(request));
  waiting_.clear();
  round_.clear();
  count_ = bytes_ = 0;
  return all;
}

void ClientRequests::discard(const std::string& client) {
  answered_.erase(client);
  const auto known = waiting_.find(client);
  if (known == waiting_.end()) return;
  count_ -= known->second.size();
  for (const Waiting& each : known->second) bytes_ -= each.request.text.size();
  waiting_.erase(known);
  std::erase(round_, client);
}

void ClientRequests::note_answer(const shoal::sim_control_request_t& request, Answer answer) {
  if (request.id == 0) return;
  std::deque<Answered>& answered = answered_[request.client];
  answered.push_back({request.id, sim::shortened(request.command), request.value,
                      std::hash<std::string>()(request.text), request.text.size(), std::move(answer)});
  if (answered.size() > max_answers) answered.pop_front();
}

const ClientRequests::Answer* ClientRequests::answer_to(const shoal::sim_control_request_t& request) const {
  const auto known = answered_.find(request.client);
  if (known == answered_.end()) return nullptr;
  if (request.id == 0) return nullptr;
  const std::size_t hash = std::hash<std::string>()(request.text);
  const auto same = std::find_if(known->second.begin(), known->second.end(), [&](const Answered& each) {
    return each.id == request.id && each.command == sim::shortened(request.command) && each.value == request.value &&
           each.text_hash == hash && each.text_size == request.text.size();
  });
  return same == known->second.end() ? nullptr : &same->answer;
}

}  // namespace bridges
