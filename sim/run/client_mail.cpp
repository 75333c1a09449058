#include "sim/run/client_mail.hpp"

#include <algorithm>

#include "sim/bus/crc32.hpp"

namespace sim {

void ClientMail::expect(const std::string& client, const std::vector<NamedMessage>& named) {
  std::vector<Expected>& list = expected_[client];
  list.clear();
  for (const NamedMessage& each : named) list.push_back({each, gate_.reads(each.channel), false, {}});
  match(list);
}

void ClientMail::collect() {
  gate_.collect();
  take(gate_.waiting());
  for (auto& [client, list] : expected_) match(list);
}

void ClientMail::take(std::vector<MailGate::Mail>& mail) {
  for (MailGate::Mail& each : mail) {
    const std::uint32_t crc = crc32(each.payload);
    strays_.push_back({std::move(each), crc});
    if (strays_.size() > most_strangers) strays_.pop_front();
  }
  mail.clear();
}

void ClientMail::match(std::vector<Expected>& list) {
  if (strays_.empty()) return;
  for (Expected& expected : list) {
    if (!expected.wanted || expected.there) continue;
    const auto found = std::find_if(strays_.begin(), strays_.end(), [&](const Stray& stray) {
      return stray.crc == expected.named.crc && stray.mail.channel == expected.named.channel;
    });
    if (found == strays_.end()) continue;
    expected.payload = std::move(found->mail.payload);
    expected.there = true;
    strays_.erase(found);
  }
}

bool ClientMail::is_complete(const std::string& client) const {
  return first_missing(client) < 0;
}

std::int32_t ClientMail::first_missing(const std::string& client) const {
  const auto found = expected_.find(client);
  if (found == expected_.end()) return -1;
  for (std::size_t i = 0; i < found->second.size(); ++i)
    if (found->second[i].wanted && !found->second[i].there) return static_cast<std::int32_t>(i);
  return -1;
}

bool ClientMail::add(const std::string& client, std::int32_t place, const std::string& channel, const Bytes& payload) {
  const auto found = expected_.find(client);
  if (found == expected_.end() || place < 0 || static_cast<std::size_t>(place) >= found->second.size()) return false;
  Expected& expected = found->second[static_cast<std::size_t>(place)];
  if (expected.named.channel != channel || expected.named.crc != crc32(payload)) return false;
  if (!expected.wanted || expected.there) return true;
  expected.payload = payload;
  expected.there = true;
  return true;
}

void ClientMail::give_up(const std::string& client) {
  const auto found = expected_.find(client);
  if (found == expected_.end()) return;
  for (Expected& expected : found->second) expected.wanted = expected.there;
}

void ClientMail::clear() {
  expected_.clear();
  strays_.clear();
  gate_.waiting().clear();
}

void ClientMail::remember(const NamedMessage& named) {
  recent_order_.emplace_back(named.channel, named.crc);
  recent_.insert(recent_order_.back());
  if (recent_order_.size() <= most_recent) return;
  recent_.erase(recent_.find(recent_order_.front()));
  recent_order_.pop_front();
}

void ClientMail::order(std::vector<MailGate::Mail>& mail) {
  if (expected_.empty() && strays_.empty() && recent_order_.empty()) return;  // nobody lists what it publishes
  take(mail);
  for (auto& [client, list] : expected_) {
    match(list);
    for (Expected& expected : list) {
      if (!expected.there) continue;
      remember(expected.named);
      mail.push_back({std::move(expected.named.channel), std::move(expected.payload)});
    }
  }
  expected_.clear();
  for (Stray& stray : strays_) {
    if (recent_.contains({stray.mail.channel, stray.crc}))
      ++repeated_;
    else
      mail.push_back(std::move(stray.mail));
  }
  strays_.clear();
}

}  // namespace sim
