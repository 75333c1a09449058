// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// A MOOSDB and a client for tests, written from the protocol and not from the code under test: what both understand is
// understood by others.

namespace moos_test {

/// A message, with the bytes of its parts in the order of the wire.
struct Msg {
  char type = 'N', data = 'D';
  std::string key;
  double value = 0;
  std::string text;
  double time = 0;
  std::string source, aux, community;
};

inline void put_int(std::string& out, std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(number >> shift & 0xff);
}
inline void put_text(std::string& out, const std::string& text) {
  put_int(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}
inline void put_double(std::string& out, double number) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, 8);
  put_int(out, static_cast<std::uint32_t>(bits));
  put_int(out, static_cast<std::uint32_t>(bits >> 32));
}

inline std::string message_bytes(const Msg& msg) {
  std::string body;
  put_int(body, 7);  // id
  body += msg.type;
  body += msg.data;
  for (const std::string* text : {&msg.source, &msg.aux, &msg.community, &msg.key}) put_text(body, *text);
  put_double(body, msg.time);
  put_double(body, msg.value);
  put_double(body, -1);
  put_text(body, msg.text);
  std::string out;
  put_int(out, static_cast<std::uint32_t>(body.size() + 4));
  return out + body;
}

inline std::string packet(const std::vector<Msg>& messages) {
  std::string body;
  put_int(body, static_cast<std::uint32_t>(messages.size()));
  body += '\0';
  for (const Msg& msg : messages) body += message_bytes(msg);
  std::string out;
  put_int(out, static_cast<std::uint32_t>(body.size() + 4));
  return out + body;
}

/// The number at a place.
inline std::uint32_t int_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (int i = 0; i < 4; ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i))))
              << 8 * i;
  return number;
}
inline double double_at(const std::string& bytes, std::size_t at) {
  const std::uint64_t bits = int_at(bytes, at) | std::uint64_t{int_at(bytes, at + 4)} << 32;
  double number = 0;
  std::memcpy(&number, &bits, 8);
  return number;
}

/// Takes the first packet off, when it is complete.
inline bool take_packet(std::string& bytes, std::vector<Msg>& messages) {
  if (bytes.size() < 9 || bytes.size() < int_at(bytes, 0)) return false;
  const std::uint32_t length = int_at(bytes, 0), count = int_at(bytes, 4);
  std::size_t at = 9;
  for (std::uint32_t i = 0; i < count; ++i) {
    Msg msg;
    std::size_t in = at + 8;
    msg.type = bytes.at(in++);
    msg.data = bytes.at(in++);
    const auto text = [&] {
      const std::uint32_t size = int_at(bytes, in);
      in += 4 + size;
      return bytes.substr(in - size, size);
    };
    msg.source = text();
    msg.aux = text();
    msg.community = text();
    msg.key = text();
    msg.time = double_at(bytes, in);
    msg.value = double_at(bytes, in + 8);
    in += 24;
    msg.text = text();
    if (in - at != int_at(bytes, at)) throw std::runtime_error("a message is not as long as it says");
    at = in;
    messages.push_back(msg);
  }
  if (at != length) throw std::runtime_error("a packet is not as long as it says");
  bytes.erase(0, length);
  return true;
}

inline double wall_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<in_port_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A MOOSDB of one community, in a thread: handshake, names that are taken once, subscriptions by name and all, the
/// last values for new subscribers, answers to timing, and the end of clients that are silent for 5 s.
class SmallMoosDb {
 public:
  explicit SmallMoosDb(int port, std::string community = "alpha", double silence_s = 5)
      : community_(std::move(community)),
        silence_s_(silence_s),
        listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const sockaddr_in address = loopback(port);
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || listen(listener_, 8) != 0)
      throw std::runtime_error("the MOOSDB of the test cannot listen");
    thread_ = std::thread([this] { run(); });
  }
  ~SmallMoosDb() {
    stop_ = true;
    thread_.join();
    for (const auto& [fd, client] : clients_) close(fd);
    close(listener_);
  }
  SmallMoosDb(const SmallMoosDb&) = delete;

  /// The last value of a variable, and how often it was written.
  std::pair<Msg, int> last(const std::string& key) {
    const std::lock_guard lock(mutex_);
    return values_[key];
  }
  int written(const std::string& key) { return last(key).second; }
  bool has_client(const std::string& name) {
    const std::lock_guard lock(mutex_);
    return names_.contains(name);
  }
  int dropped_for_silence() const { return dropped_; }
  int timings() const { return timings_; }

 private:
  struct Client {
    std::string name, in;
    bool greeted = false;
    bool all = false;
    std::set<std::string> keys;
    double heard = wall_s();
  };

  void run() {
    while (!stop_) {
      std::vector<pollfd> polled{{listener_, POLLIN, 0}};
      for (const auto& [fd, client] : clients_) polled.push_back({fd, POLLIN, 0});
      poll(polled.data(), polled.size(), 20);
      for (const pollfd& one : polled)
        if (one.fd != listener_ && one.revents != 0) read(one.fd);
      if (polled.front().revents != 0) {
        const int fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        const int yes = 1;
        setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        clients_[fd] = {};
      }
      std::vector<int> silent;
      for (const auto& [fd, client] : clients_)
        if (wall_s() - client.heard > silence_s_) silent.push_back(fd);
      for (const int fd : silent) {
        ++dropped_;
        drop(fd);
      }
    }
  }
  void drop(int fd) {
    const std::lock_guard lock(mutex_);
    names_.erase(clients_[fd].name);
    clients_.erase(fd);
    close(fd);
  }
  static void write(int fd, const std::vector<Msg>& messages) {
    const std::string bytes = packet(messages);
    [[maybe_unused]] const auto sent = send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  void read(int fd) {
    char bytes[65536];
    const ssize_t count = recv(fd, bytes, sizeof bytes, 0);
    if (count <= 0) return drop(fd);
    Client& client = clients_[fd];
    client.heard = wall_s();
    client.in.append(bytes, static_cast<std::size_t>(count));
    if (!client.greeted) {
      if (client.in.size() < 32) return;
      if (client.in.compare(0, 24, std::string("ELKS CAN'T DANCE 2/8/10\0", 24)) != 0) return drop(fd);
      client.in.erase(0, 32);
      client.greeted = true;
    }
    std::vector<Msg> messages;
    while (take_packet(client.in, messages)) {
    }
    for (const Msg& msg : messages)
      if (!handle(fd, client, msg)) return drop(fd);
  }
  /// False: the client is to go.
  bool handle(int fd, Client& client, const Msg& msg) {
    if (client.name.empty()) return welcome(fd, client, msg);
    const std::lock_guard lock(mutex_);
    if (msg.type == 'R' || msg.type == '*') {
      if (msg.type == '*') client.all = msg.text.find("VarPattern=*") != std::string::npos;
      if (msg.type == 'R') client.keys.insert(msg.key);
      for (const auto& [key, value] : values_)
        if (value.second > 0 && (client.all || key == msg.key)) write(fd, {value.first});
    } else if (msg.type == 'T') {
      ++timings_;
      Msg answer = msg;
      answer.value = wall_s();
      write(fd, {answer});
    } else if (msg.type == 'N') {
      Msg value = msg;
      value.community = community_;
      values_[msg.key] = {value, values_[msg.key].second + 1};
      for (const auto& [other_fd, other] : clients_)
        if (other.all || other.keys.contains(msg.key)) write(other_fd, {value});
    }
    return true;
  }
  bool welcome(int fd, Client& client, const Msg& msg) {
    if (msg.type != 'i') return false;
    const std::lock_guard lock(mutex_);
    Msg answer;
    if (!names_.insert(msg.text).second) {
      answer.type = 'K';
      answer.data = 'S';
      answer.text = "the name " + msg.text + " is taken";
      write(fd, {answer});
      return false;
    }
    client.name = msg.text;
    answer.type = 'W';
    answer.text = msg.key == "asynchronous" ? "asynchronous" : "";
    answer.community = community_;
    write(fd, {answer});
    return true;
  }

  const std::string community_;
  const double silence_s_;
  int listener_;
  std::mutex mutex_;
  std::map<int, Client> clients_;
  std::set<std::string> names_;
  std::map<std::string, std::pair<Msg, int>> values_;
  std::atomic<int> dropped_ = 0, timings_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

/// A client of a MOOSDB that waits for its messages.
class SmallMoosClient {
 public:
  SmallMoosClient(int port, const std::string& name, const std::vector<std::string>& keys) : name_(name) {
    const sockaddr_in address = loopback(port);
    if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("no MOOSDB for the client of the test");
    const int yes = 1;
    setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    std::string greeting = "ELKS CAN'T DANCE 2/8/10";
    greeting.resize(32, '\0');
    Msg hello{'i', 'S', "asynchronous"};
    hello.text = name;
    hello = stamped(hello);
    write(greeting + packet({hello}));
    std::vector<Msg> orders;
    for (const std::string& key : keys) orders.push_back(stamped({'R', 'D', key}));
    if (!orders.empty()) write(packet(orders));
  }
  ~SmallMoosClient() { close(fd_); }
  SmallMoosClient(const SmallMoosClient&) = delete;

  void notify(const std::string& key, double value) { write(packet({stamped({'N', 'D', key, value})})); }
  void notify(const std::string& key, const std::string& text) { write(packet({stamped({'N', 'S', key, 0, text})})); }
  /// The messages of the next packets; waits for one, at most this long.
  std::vector<Msg> receive(std::chrono::milliseconds wait = std::chrono::seconds(60)) {
    std::vector<Msg> messages;
    while (!take_packet(in_, messages)) {
      pollfd polled{fd_, POLLIN, 0};
      char bytes[65536];
      if (poll(&polled, 1, static_cast<int>(wait.count())) <= 0) return messages;
      const ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
      if (count <= 0) {
        over_ = true;
        return messages;
      }
      in_.append(bytes, static_cast<std::size_t>(count));
    }
    return messages;
  }
  bool over() const { return over_; }

 private:
  Msg stamped(Msg msg) const {
    msg.source = name_;
    msg.time = wall_s();
    return msg;
  }
  void write(const std::string& bytes) const {
    [[maybe_unused]] const auto sent = send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  int fd_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  std::string name_, in_;
  bool over_ = false;
};

}  // namespace moos_test
