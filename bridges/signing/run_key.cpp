// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/signing/run_key.hpp"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"

namespace bridges {

namespace {

constexpr std::string_view white_space = " \t\r\n";

/// Returns the value of a hexadecimal digit; -1 for another character.
int digit_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(white_space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(white_space) - begin + 1);
}

}  // namespace

RunKey RunKey::random() {
  RunKey key;
  if (RAND_bytes(key.bytes_.data(), static_cast<int>(size)) != 1)
    throw BusError("the system provides no random numbers for the key of the run");
  return key;
}

RunKey RunKey::from_text(std::string_view text, const std::string& where) {
  const std::string_view digits = trimmed(text);
  RunKey key;
  bool good = digits.size() == 2 * size;
  for (std::size_t i = 0; good && i < size; ++i) {
    const int high = digit_value(digits[2 * i]), low = digit_value(digits[2 * i + 1]);
    good = high >= 0 && low >= 0;
    key.bytes_[i] = static_cast<std::uint8_t>(good ? high * 16 + low : 0);
  }
  if (!good)
    throw BusError(where + ": must be the key of a run, " + std::to_string(2 * size) +
                   " hexadecimal digits, got a text of " + std::to_string(digits.size()) + " characters");
  return key;
}

std::string RunKey::text() const {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes_) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

Mac RunKey::mac(std::string_view channel, std::span<const std::byte> bytes) const {
  // A zero between channel and content, so that no two pairs give the same bytes.
  std::vector<unsigned char> data(channel.size() + 1 + bytes.size());
  std::memcpy(data.data(), channel.data(), channel.size());
  data[channel.size()] = 0;
  if (!bytes.empty()) std::memcpy(data.data() + channel.size() + 1, bytes.data(), bytes.size());
  Mac mac{};
  unsigned int length = 0;
  if (HMAC(EVP_sha256(), bytes_.data(), static_cast<int>(size), data.data(), data.size(), mac.data(), &length) ==
          nullptr ||
      length != mac.size())
    throw BusError("HMAC-SHA-256 does not work on this system");
  return mac;
}

bool equal_in_constant_time(const Mac& a, const Mac& b) {
  return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::optional<RunKey> run_key_from_environment() {
  const char* text = std::getenv(run_key_variable);
  if (text == nullptr || *text == '\0') return std::nullopt;
  return RunKey::from_text(text, run_key_variable);
}

RunKey read_run_key(const std::string& folder) {
  const std::string path = folder + "/" + run_key_file;
  // O_NONBLOCK: do not block on a FIFO of that name.
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0)
    throw BusError(path + ": " + std::strerror(errno) +
                   (errno == ENOENT ? "; the run has ended, does not need a key, or uses another folder" : ""));
  struct stat status {};
  if (fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) throw BusError(path + ": is not a regular file");
  std::array<char, 256> text{};
  const auto got = read(file.number(), text.data(), text.size());
  if (got < 0) throw BusError(path + ": " + std::strerror(errno));
  return RunKey::from_text({text.data(), static_cast<std::size_t>(got)}, path);
}

}  // namespace bridges
