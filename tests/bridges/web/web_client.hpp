// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace web_test {

using Json = nlohmann::json;

/// Answer to an HTTP request; the names of headers in lower case.
struct Answer {
  int status = 0;
  std::map<std::string, std::string> headers;
  std::string body;
};

/// WebSocket message.
struct Frame {
  int opcode = 0;
  std::string payload;
  bool is_text() const { return opcode == 1; }
  Json json() const { return Json::parse(payload); }
  /// Code of a close frame.
  int close_code() const {
    return payload.size() < 2 ? 0
                              : static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
  }
};

/// Waits for a condition that another thread brings about; false after a minute.
template <typename Condition>
bool await(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// Client of the web server with a plain socket, which can also send what no browser would.
class Client {
 public:
  explicit Client(std::uint16_t port, bool ipv6 = false, int receive_bytes = 0)
      : socket_(::socket(ipv6 ? AF_INET6 : AF_INET, SOCK_STREAM, 0)) {
    if (receive_bytes > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port);
    v4.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(port);
    v6.sin6_addr = in6addr_loopback;
    const auto* address = ipv6 ? reinterpret_cast<sockaddr*>(&v6) : reinterpret_cast<sockaddr*>(&v4);
    if (connect(socket_, address, ipv6 ? sizeof v6 : sizeof v4) != 0) {
      ::close(socket_);
      throw std::runtime_error("cannot connect");
    }
  }
  ~Client() {
    if (socket_ >= 0) ::close(socket_);
  }
  Client(Client&& other) noexcept : socket_(std::exchange(other.socket_, -1)), read_(std::move(other.read_)) {}
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Ends the connection without a word, as a crashed browser does.
  void reset() {
    const linger now{1, 0};
    setsockopt(socket_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    ::close(std::exchange(socket_, -1));
  }

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;  // closed by the server: the test reads it
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }

  /// Sends a request and reads its answer.
  Answer request(const std::string& head, bool has_body = true) {
    write(head);
    return read_answer(has_body);
  }
  Answer get(const std::string& target, const std::string& more = "", const std::string& host = "localhost") {
    return request("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n");
  }

  /// Asks for a WebSocket.
  Answer upgrade(const std::string& more = "Sec-WebSocket-Protocol: shoal.view.v1\r\n",
                 const std::string& host = "localhost") {
    return get("/",
               "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   more,
               host);
  }

  Answer read_answer(bool has_body = true) {
    const std::size_t end = read_until("\r\n\r\n");
    Answer answer;
    if (end == std::string::npos) return answer;
    const std::string head = take(end + 4);
    answer.status = std::stoi(head.substr(9, 3));
    for (std::size_t line = head.find("\r\n") + 2; line + 2 < head.size();) {
      const std::size_t next = head.find("\r\n", line), colon = head.find(": ", line);
      std::string name = head.substr(line, colon - line);
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
      answer.headers[name] = head.substr(colon + 2, next - colon - 2);
      line = next + 2;
    }
    const auto length = answer.headers.find("content-length");
    if (has_body && length != answer.headers.end()) answer.body = read_bytes(std::stoul(length->second));
    return answer;
  }

  /// Sends a frame with a mask of zeros.
  void send_frame(int opcode, std::string_view payload, bool masked = true, bool last = true) const {
    std::string head;
    head += static_cast<char>((last ? 0x80 : 0) | opcode);
    const int mask_bit = masked ? 0x80 : 0;
    if (payload.size() < 126) {
      head += static_cast<char>(mask_bit | static_cast<int>(payload.size()));
    } else {
      const int bytes = payload.size() < 65536 ? 2 : 8;
      head += static_cast<char>(mask_bit | (bytes == 2 ? 126 : 127));
      for (int i = bytes; i-- > 0;) head += static_cast<char>(payload.size() >> (8 * i) & 255);
    }
    if (masked) head += std::string(4, '\0');
    write(head + std::string(payload));
  }
  void send_json(const Json& message) const { send_frame(1, message.dump()); }

  /// Reads the next frame; answers pings.  Nothing when the connection ends, or after a minute.
  std::optional<Frame> read_frame() {
    for (;;) {
      const std::string head = read_bytes(2);
      if (head.size() < 2) return std::nullopt;
      std::uint64_t size = static_cast<unsigned char>(head[1]) & 127;
      if (size >= 126) {
        std::uint64_t value = 0;
        for (const char c : read_bytes(size == 126 ? 2 : 8)) value = value << 8 | static_cast<unsigned char>(c);
        size = value;
      }
      Frame frame{head[0] & 15, read_bytes(size)};
      if (frame.opcode == 9)
        send_frame(10, frame.payload);
      else
        return frame;
    }
  }
  Json read_json() {
    const auto frame = read_frame();
    if (!frame || !frame->is_text())
      throw std::runtime_error("no text, but opcode " + std::to_string(frame ? frame->opcode : -1));
    return frame->json();
  }
  /// Reads until the connection ends; false after a minute.
  bool is_closed() {
    while (receive()) {
    }
    return ended_;
  }

 private:
  bool receive() {
    pollfd waiting{socket_, POLLIN, 0};
    if (poll(&waiting, 1, 60'000) != 1) return false;
    char chunk[65536];
    const ssize_t got = recv(socket_, chunk, sizeof chunk, 0);
    ended_ = got <= 0;
    if (got > 0) read_.append(chunk, static_cast<std::size_t>(got));
    return got > 0;
  }
  std::size_t read_until(std::string_view end) {
    std::size_t found;
    while ((found = read_.find(end)) == std::string::npos)
      if (!receive()) break;
    return found;
  }
  std::string read_bytes(std::size_t size) {
    while (read_.size() < size && receive()) {
    }
    return take(std::min(size, read_.size()));
  }
  std::string take(std::size_t size) {
    std::string bytes = read_.substr(0, size);
    read_.erase(0, size);
    return bytes;
  }

  int socket_;
  std::string read_;
  bool ended_ = false;
};

}  // namespace web_test
