// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

/// Error of a request of a page: what is wrong, for a person.
class PageRequestError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Channel that a page wants to see.
struct Subscription {
  std::string channel;  ///< 1 to 63 bytes
  double rate_hz = 10;  ///< largest rate of wall time, above 0, at most 30

  bool operator==(const Subscription&) const = default;
};

/// Values of a field over a range of time, which a page wants to plot.
struct SeriesRequest {
  std::string id;                       ///< JSON of the key `id`, for the answer
  std::string channel;                  ///< 1 to 63 bytes
  std::string field;                    ///< name as a column of `shoal log csv`, at most 256 bytes
  std::int64_t from_us = 0, to_us = 0;  ///< simulated time; from_us <= to_us
  std::size_t points = 1000;            ///< largest number of points, 2 to 4000
};

/// Maximum number of channels of one page.
constexpr std::size_t max_subscriptions = 256;
/// Maximum rate of a subscription.
constexpr double max_subscription_rate_hz = 30;
/// Maximum number of points of a series.
constexpr std::size_t max_series_points = 4000;

/// Reads a request `subscribe`, a JSON object.  The last of several entries of one channel counts.  Throws
/// PageRequestError.
std::vector<Subscription> parse_subscribe(std::string_view text);
/// Reads a request `series`, a JSON object.  Throws PageRequestError.
SeriesRequest parse_series(std::string_view text);
/// Returns the key `id` of a request as JSON: a number, or a text of at most 64 bytes; else `null`.
std::string request_id(std::string_view text);

/// Request `look` of a page: the poses at a time.
struct LookRequest {
  std::optional<std::int64_t> time_us;  ///< unset: the page shows the present again
  std::optional<std::int32_t> branch;   ///< unset: the present one
};

/// Reads a request.  Throws std::runtime_error with the key, the rule and the value.
LookRequest parse_look(std::string_view text);

}  // namespace viewer
