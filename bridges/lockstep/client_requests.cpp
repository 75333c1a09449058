// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/client_requests.hpp"

#include <algorithm>

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
      }))
    return true;
  if (count_ >= max_waiting) return false;
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
  return request;
}

std::vector<ClientRequests::Waiting> ClientRequests::take_all() {
  std::vector<Waiting> all;
  for (auto& [client, requests] : waiting_)
    for (Waiting& request : requests) all.push_back(std::move(request));
  waiting_.clear();
  round_.clear();
  count_ = 0;
  return all;
}

void ClientRequests::note_answer(const shoal::sim_control_request_t& request, Answer answer) {
  if (request.id == 0) return;
  std::deque<Answered>& answered = answered_[request.client];
  answered.emplace_back(request, std::move(answer));
  if (answered.size() > max_answers) answered.pop_front();
}

const ClientRequests::Answer* ClientRequests::answer_to(const shoal::sim_control_request_t& request) const {
  const auto known = answered_.find(request.client);
  if (known == answered_.end()) return nullptr;
  const auto same = std::find_if(known->second.begin(), known->second.end(),
                                 [&](const Answered& each) { return is_repetition(each.first, request); });
  return same == known->second.end() ? nullptr : &same->second;
}

}  // namespace bridges
