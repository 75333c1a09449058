// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/log_image.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bridges/log/event_log.hpp"
#include "devices/ranging/camera.hpp"
#include "shoal/image_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/image/image_file.hpp"

namespace viewer {
namespace {

/// Messages of one channel: all of them where all are drawn, else the selected one.
class Chosen {
 public:
  Chosen(const std::string& channel, const ImageChoice& choice) : channel_(channel), choice_(choice) {}

  void take(const bridges::LogEvent& event) {
    // Start of simulated time.
    if (event.channel == "sim.info" && !start_known_) learn_start(event);
    if (!first_utime_) first_utime_ = event.utime;
    if (event.channel != channel_) return;
    // Type and time of the message.
    const std::int64_t type = shoal::fingerprint(event.payload);
    if (count_ == 0) type_ = type;
    if (type != type_) throw std::runtime_error("messages of several types");
    const int number = count_++;
    if (first_s_ > last_s_) first_s_ = time_s(event);
    last_s_ = time_s(event);
    if (are_all_drawn(type)) {
      payloads_.emplace_back(event.payload);
      return;
    }
    // Keep the message nearest to the choice.
    const double away_s = choice_.at_s ? std::abs(last_s_ - *choice_.at_s) : 0;
    const bool desired = choice_.number ? number == *choice_.number
                         : choice_.at_s ? payloads_.empty() || away_s < away_s_
                                        : true;
    if (is_drawn_with_those_before(type)) keep(since_, event.payload);
    if (!desired) return;
    if (is_drawn_with_those_before(type)) {
      for (sim::Bytes& payload : since_) keep(payloads_, std::move(payload));
      since_.clear();
    } else {
      payloads_.assign(1, event.payload);
    }
    number_ = number;
    chosen_s_ = last_s_;
    away_s_ = away_s;
  }

  /// Returns the chosen message, the last one of those that are drawn with it.  Throws when there is no such message.
  const std::vector<sim::Bytes>& payloads(const std::vector<std::string>& problems) const {
    if (count_ == 0)
      throw std::runtime_error("no event on channel '" + channel_ + "'; " +
                               (problems.empty() ? "see shoal log info" : problems.back()));
    if (are_all_drawn(type_)) {
      if (choice_.number || choice_.at_s)
        throw std::runtime_error("all its messages are drawn; --number and --at choose among images, clouds and scans");
      return payloads_;
    }
    if (payloads_.empty())
      throw std::runtime_error(fmt::format("there is no message {}; there are {}, from 0", *choice_.number, count_));
    if (choice_.at_s && (*choice_.at_s < first_s_ - slack_s() || *choice_.at_s > last_s_ + slack_s()))
      throw std::runtime_error(fmt::format("there is no message at {:g} s; they are from {:.3f} to {:.3f} s",
                                           *choice_.at_s, first_s_, last_s_));
    return payloads_;
  }

  std::int64_t type() const { return type_; }

  std::string text() const {
    if (are_all_drawn(type_)) return fmt::format("{} messages from {:.3f} to {:.3f} s", count_, first_s_, last_s_);
    return fmt::format("message {} of 0 to {}, at {:.3f} s", number_, count_ - 1, chosen_s_);
  }

 private:
  /// Appends a message to those that are drawn together, of which the last 64 MB are kept.
  static void keep(std::vector<sim::Bytes>& kept, sim::Bytes payload) {
    constexpr std::size_t max_bytes = 64'000'000;
    kept.push_back(std::move(payload));
    auto first = kept.end();
    std::size_t bytes = 0;
    while (first != kept.begin() && (bytes += std::prev(first)->size()) <= max_bytes) --first;
    kept.erase(kept.begin(), first == kept.end() ? std::prev(first) : first);
  }

  void learn_start(const bridges::LogEvent& event) {
    try {
      first_utime_ = shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any).epoch_utime;
      start_known_ = true;
    } catch (const shoal::MessageError&) {
      // The channel belongs to another program that uses the name.
    }
  }

  double time_s(const bridges::LogEvent& event) const {
    return static_cast<double>(event.utime - *first_utime_) * 1e-6;
  }

  /// Permits a time up to one period before the first and after the last message, or one second for a single message.
  double slack_s() const { return count_ > 1 ? (last_s_ - first_s_) / (count_ - 1) : 1; }

  const std::string& channel_;
  const ImageChoice& choice_;
  bool start_known_ = false;
  std::optional<std::int64_t> first_utime_;
  int count_ = 0, number_ = 0;
  std::int64_t type_ = 0;
  double first_s_ = 1, last_s_ = 0, chosen_s_ = 0, away_s_ = 0;
  std::vector<sim::Bytes> payloads_;
  std::vector<sim::Bytes> since_;  ///< after the last of payloads_, where those before the chosen one are drawn, too
};

}  // namespace

LogImage draw_log(const std::string& log, const std::string& channel, const std::string& png,
                  const ImageChoice& choice) {
  bridges::EventLogReader reader(log);
  Chosen chosen(channel, choice);
  while (const auto event = reader.next()) chosen.take(*event);
  const std::vector<sim::Bytes>& payloads = chosen.payloads(reader.problems());
  if (chosen.type() == shoal::image_t::getHash())
    sim::write_image(png, displayable(shoal::decode<shoal::image_t>(payloads.front(), shoal::Finite::any)));
  else
    draw_ranging(payloads, channel, png);
  return {chosen.text(), reader.problems()};
}

namespace {

std::string metadata_of(const shoal::image_t& message, const std::string& key) {
  for (const shoal::image_metadata_t& entry : message.metadata)
    if (entry.key == key) return {entry.value.begin(), entry.value.end()};
  return {};
}

/// Copies rows of `row_stride` bytes, without their padding.
template <typename T>
sim::Image<T> raw_image(const shoal::image_t& message, int channels) {
  sim::Image<T> image(message.width, message.height, channels);
  const std::size_t row = sizeof(T) * static_cast<std::size_t>(message.width) * static_cast<std::size_t>(channels);
  const auto stride = static_cast<std::size_t>(std::max(0, message.row_stride));
  const auto height = static_cast<std::size_t>(message.height);
  if (stride < row || message.data.size() < stride * (height - 1) + row)
    throw std::runtime_error(fmt::format("the image of {} x {} pixels has {} bytes in rows of {}", message.width,
                                         message.height, message.data.size(), message.row_stride));
  for (std::size_t i = 0; i < height; ++i)
    std::memcpy(image.at(0, static_cast<int>(i)), message.data.data() + i * stride, row);
  return image;
}

sim::Image8 displayable_16_bits(const shoal::image_t& message, const sim::Image16& image) {
  if (!metadata_of(message, "labels").empty()) return sim::label_image(image);
  sim::FloatImage depth_m(image.width, image.height, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) depth_m.data[i] = 1e-3F * static_cast<float>(image.data[i]);
  return sim::depth_image(depth_m);
}

}  // namespace

sim::Image8 displayable(const shoal::image_t& message) {
  using namespace devices;
  // Check the size.
  const bool sides = message.width >= 1 && message.height >= 1 && message.width <= sim::max_image_side_px &&
                     message.height <= sim::max_image_side_px;
  if (!sides || std::int64_t{message.width} * message.height > sim::max_image_pixels)
    throw std::runtime_error(fmt::format("the image has an invalid size: {} x {}", message.width, message.height));
  const auto bytes = std::as_bytes(std::span(message.data));
  // Convert by pixel format.
  switch (message.pixelformat) {
    case pixel_format_grey:
      return raw_image<std::uint8_t>(message, 1);
    case pixel_format_rgb:
      return raw_image<std::uint8_t>(message, 3);
    case pixel_format_le_grey16:
      return displayable_16_bits(message, raw_image<std::uint16_t>(message, 1));
    case pixel_format_float_grey32:
      return sim::depth_image(raw_image<float>(message, 1));
    case pixel_format_mjpeg:
      return sim::decode_image(bytes);
    case pixel_format_png:
      if (!metadata_of(message, "labels").empty() || metadata_of(message, "unit") == "mm")
        return displayable_16_bits(message, sim::decode_png16(bytes));
      return sim::decode_image(bytes);
    default:
      throw std::runtime_error(
          fmt::format("pixel format {} cannot be drawn; grey, RGB, 16-bit grey, float grey, JPEG and PNG can",
                      message.pixelformat));
  }
}

}  // namespace viewer
