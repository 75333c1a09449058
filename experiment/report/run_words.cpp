// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "experiment/report/report_page.hpp"

namespace experiment {

namespace {

using Metrics = std::vector<const RunMetric*>;

/// More vehicles than this are described together.
constexpr std::size_t max_vehicles_by_name = 4;
constexpr std::size_t max_contacts_by_name = 5;

/// Formats three digits, without an exponent.
std::string rounded(double value) {
  const double size = std::abs(value);
  if (size >= 100) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}f}", value, size >= 10 ? 1 : 2);
}

std::string bytes_text(double bytes) {
  return bytes < 1000 ? fmt::format("{:.0f} bytes", bytes) : fmt::format("{} kB", rounded(bytes / 1000));
}

std::string counted(double count, const std::string& one, const std::string& many) {
  return fmt::format("{:.0f} {}", count, count == 1 ? one : many);
}

std::string percent_text(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

Metrics of_type(const std::vector<RunMetric>& metrics, std::string_view type) {
  Metrics found;
  for (const RunMetric& metric : metrics)
    if (metric.kind != nullptr && metric.kind->word == type) found.push_back(&metric);
  return found;
}

double rms_of(const RunMetric& metric) {
  return metric.value("rms_m").value_or(std::numeric_limits<double>::infinity());
}

/// Returns the distance that the vehicle traveled until its last estimate; empty: unknown.
std::string after_distance(const RunMetric& metric) {
  const auto final_m = metric.value("final_m");
  const auto percent = metric.value("per_distance_percent");
  if (!final_m || !percent || !(*percent > 0)) return "";
  return ", after " + length_text(100 * *final_m / *percent);
}

/// Describes the position errors of a vehicle, the smallest first.
std::string position_sentence(const std::string& vehicle, Metrics metrics) {
  // Best estimate first.
  std::stable_sort(metrics.begin(), metrics.end(),
                   [](const RunMetric* a, const RunMetric* b) { return rms_of(*a) < rms_of(*b); });
  const RunMetric& best = *metrics.front();
  if (!best.value("rms_m"))
    return (vehicle.empty() ? best.name : vehicle) + ": no estimate of its position was compared with the truth.";
  std::string text;
  if (vehicle.empty())
    text = best.name + ": " + length_text(rms_of(best)) + " rms";
  else if (best.channel.starts_with(vehicle + "."))
    text = fmt::format("{} localizes itself to {} rms ({})", vehicle, length_text(rms_of(best)), best.name);
  else
    text = fmt::format("{} is located to {} rms ({})", vehicle, length_text(rms_of(best)), best.name);
  // Final error of a single estimate.
  if (metrics.size() == 1 && best.value("final_m"))
    text += fmt::format(", {} at the end", length_text(*best.value("final_m"))) + after_distance(best);
  // Other estimates.
  for (std::size_t i = 1; i < metrics.size(); ++i) {
    const RunMetric& other = *metrics[i];
    text += "; " + other.name + ": ";
    text += other.value("rms_m") ? length_text(rms_of(other)) + " rms" : "no estimate";
    if (const auto final_m = other.value("final_m"))
      text += fmt::format(", {} at the end", length_text(*final_m)) + after_distance(other);
  }
  return text + ".";
}

/// Describes the best result of each of many vehicles.
std::string many_vehicles_sentence(const std::vector<std::pair<std::string, Metrics>>& by_vehicle) {
  double min_m = std::numeric_limits<double>::infinity(), max_m = 0;
  std::size_t located = 0;
  std::string worst;
  for (const auto& [vehicle, metrics] : by_vehicle) {
    double best_m = std::numeric_limits<double>::infinity();
    for (const RunMetric* metric : metrics) best_m = std::min(best_m, rms_of(*metric));
    if (!std::isfinite(best_m)) continue;
    ++located;
    min_m = std::min(min_m, best_m);
    if (best_m >= max_m) worst = vehicle;
    max_m = std::max(max_m, best_m);
  }
  if (located == 0) return fmt::format("None of {} vehicles published a position.", by_vehicle.size());
  return fmt::format("{} of {} vehicles localize themselves to {} to {} rms, {} worst.", located, by_vehicle.size(),
                     length_text(min_m), length_text(max_m), worst);
}

std::vector<std::string> position_sentences(const std::vector<RunMetric>& metrics) {
  std::vector<std::pair<std::string, Metrics>> by_vehicle;
  for (const RunMetric* metric : of_type(metrics, "position_error")) {
    const auto known = std::find_if(by_vehicle.begin(), by_vehicle.end(),
                                    [&](const auto& each) { return each.first == metric->vehicle; });
    if (known == by_vehicle.end())
      by_vehicle.push_back({metric->vehicle, {metric}});
    else
      known->second.push_back(metric);
  }
  // Sentences for each of many vehicles would not be read.
  if (by_vehicle.size() > max_vehicles_by_name) return {many_vehicles_sentence(by_vehicle)};
  std::vector<std::string> sentences;
  for (const auto& [vehicle, of_vehicle] : by_vehicle) sentences.push_back(position_sentence(vehicle, of_vehicle));
  return sentences;
}

std::string consistency_sentence(const RunMetric& metric) {
  const auto share = metric.value("inside_95_share"), nees = metric.value("nees_mean");
  if (!share || !nees) return metric.name + ": no estimate with a covariance was received.";
  std::string text = fmt::format("{}: {} of the errors lie within their own 95 % bound, mean NEES {}", metric.name,
                                 percent_text(*share), rounded(*nees));
  if (metric.dimensions > 0) text += fmt::format(" ({} when consistent)", metric.dimensions);
  return text + ".";
}

std::string bound_sentence(const RunMetric& metric) {
  const auto rms_m = metric.value("rms_m");
  if (!rms_m) return metric.name + ": no time was scored.";
  return fmt::format("{}: the reference for the error of {} is {} rms, with {} and {}.", metric.name,
                     metric.vehicle.empty() ? "the position" : metric.vehicle, length_text(*rms_m),
                     counted(metric.value("ranges").value_or(0), "range", "ranges"),
                     counted(metric.value("fixes").value_or(0), "fix", "fixes"));
}

std::string ratio_sentence(const RunMetric& metric) {
  const auto ratio = metric.value("ratio");
  return metric.name + ": " + (ratio ? rounded(*ratio) + " times the bound" : "no error to compare with the bound") +
         ".";
}

std::string distance_sentence(const RunMetric& metric) {
  if (!metric.value("travelled_m")) return metric.name + ": nothing was measured.";
  return (metric.vehicle.empty() ? metric.name + ": " : metric.vehicle + " traveled ") +
         length_text(metric.value("travelled_m").value_or(0)) + ".";
}

std::string delivery_sentence(const RunMetric& metric) {
  const double received = metric.value("received").value_or(0), lost = metric.value("lost").value_or(0);
  const std::string sent = counted(metric.value("sent").value_or(0), "packet", "packets");
  const std::string whose = metric.vehicle.empty() ? "all modems" : metric.vehicle;
  const std::string text = fmt::format("{}: {} sent by {}; ", metric.name, sent, whose);
  if (received + lost == 0) return text + "none was addressed to " + whose + ".";
  return text + fmt::format("{} of {:.0f} addressed to {} arrived.", percent_text(received / (received + lost)),
                            received + lost, whose);
}

std::string cost_sentence(const RunMetric& metric) {
  const std::string bytes = bytes_text(metric.value("bytes_sent").value_or(0));
  const auto reduction_m = metric.value("reduction_m");
  if (!reduction_m) return fmt::format("{}: {} were sent; there are no errors to compare.", metric.name, bytes);
  if (!(*reduction_m > 0))
    return fmt::format("{}: {} were sent, and the error did not become smaller.", metric.name, bytes);
  return fmt::format("{}: {} of messages made the rms error {} smaller, {} bytes for each meter.", metric.name, bytes,
                     length_text(*reduction_m), rounded(metric.value("bytes_per_metre").value_or(0)));
}

/// Returns `at 12.3 s` for an event.
std::string at_time(const std::optional<double>& time_s) {
  return time_s ? fmt::format("at {:.1f} s", *time_s) : "";
}

std::string time_sentence(const RunMetric& metric) {
  const auto time_s = metric.value("time_s");
  return metric.name + ": " + (time_s ? "reached " + at_time(time_s) : "not reached") + ".";
}

std::string contact_sentence(const RunMetric& metric) {
  const double count = metric.value("count").value_or(0);
  if (count == 0) return metric.name + ": no contact.";
  return fmt::format("{}: {}, the first {}.", metric.name, counted(count, "contact", "contacts"),
                     at_time(metric.value("first_s")));
}

std::string message_sentence(const RunMetric& metric) {
  const double count = metric.value("count").value_or(0);
  const std::string where = metric.channel.empty() ? "" : " on " + metric.channel;
  if (count == 0) return fmt::format("{}: no message{}.", metric.name, where);
  return fmt::format("{}: {}{} ({}), the first {}.", metric.name, counted(count, "message", "messages"), where,
                     bytes_text(metric.value("bytes").value_or(0)), at_time(metric.value("first_s")));
}

std::string tilt_sentence(const RunMetric& metric) {
  const auto max_deg = metric.value("max_deg"), fell_s = metric.value("fell_s");
  const std::string who = metric.vehicle.empty() ? metric.name : metric.vehicle;
  if (!max_deg) return who + ": its tilt was not measured.";
  const std::string text = fmt::format("{} tilts by at most {} degrees", who, rounded(*max_deg));
  return text + (fell_s ? " and falls " + at_time(fell_s) : " and does not fall") + ".";
}

/// Returns whether a metric has no figures, because the run ended before it started to count.
bool has_nothing(const RunMetric& metric) {
  return std::none_of(metric.figures.begin(), metric.figures.end(),
                      [](const RunMetric::Figure& figure) { return figure.value.has_value(); });
}

/// Empty: described elsewhere, or by its figures only.
std::string sentence_of(const RunMetric& metric) {
  using Sentence = std::string (*)(const RunMetric&);
  static const std::map<std::string, Sentence> sentences = {
      {"bound", bound_sentence},        {"bound_ratio", ratio_sentence},    {"consistency", consistency_sentence},
      {"delivery", delivery_sentence},  {"bytes_per_metre", cost_sentence}, {"mission_time", time_sentence},
      {"collisions", contact_sentence}, {"messages", message_sentence},     {"tilt", tilt_sentence}};
  const bool counts = metric.kind->figures.front().is_count || metric.kind->word == "bytes_per_metre";
  if (counts && has_nothing(metric)) return metric.name + ": nothing was measured.";
  const auto found = sentences.find(metric.kind->word);
  return found == sentences.end() ? "" : found->second(metric);
}

}  // namespace

std::string length_text(double length_m) {
  if (std::abs(length_m) >= 1000) return rounded(length_m / 1000) + " km";
  if (length_m != 0 && std::abs(length_m) < 0.01) return fmt::format("{:.2g} mm", 1000 * length_m);
  return rounded(length_m) + " m";
}

std::string rules_in_words(const std::vector<RunRecord::Rule>& rules) {
  if (rules.empty()) return "";
  const auto count = rules.size();
  const auto failed = static_cast<std::size_t>(
      std::count_if(rules.begin(), rules.end(), [](const RunRecord::Rule& rule) { return !rule.passed; }));
  if (failed == 0) return count == 1 ? "The one rule holds." : fmt::format("All {} rules hold.", count);
  return fmt::format("{} of {} {} {}, {} failed.", count - failed, count, count == 1 ? "rule" : "rules",
                     count - failed == 1 ? "holds" : "hold", failed);
}

std::vector<std::string> findings_in_words(const std::vector<RunMetric>& metrics) {
  std::vector<std::string> sentences = position_sentences(metrics);
  std::set<std::string> reported;
  for (const RunMetric* metric : of_type(metrics, "position_error"))
    if (!after_distance(*metric).empty()) reported.insert(metric->vehicle);
  Metrics distances;
  // A sentence about the position already has the distance.
  for (const RunMetric* metric : of_type(metrics, "distance"))
    if (metric->vehicle.empty() || !reported.contains(metric->vehicle)) distances.push_back(metric);
  for (const RunMetric* metric : distances) sentences.push_back(distance_sentence(*metric));
  for (const RunMetric& metric : metrics) {
    if (metric.kind == nullptr) continue;
    std::string sentence = sentence_of(metric);
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  }
  return sentences;
}

std::vector<std::string> contacts_in_words(const RunRecord& run) {
  std::vector<std::string> sentences;
  for (const RunRecord::Contact& contact : run.contacts) {
    if (sentences.size() == max_contacts_by_name) {
      sentences.push_back(fmt::format("{} more pairs touch.", run.contacts.size() - max_contacts_by_name));
      break;
    }
    sentences.push_back(fmt::format("{} hits {} {}{}.", contact.vehicle, contact.with, at_time(contact.first_s),
                                    contact.count > 1 ? fmt::format(", {} times in all", contact.count) : ""));
  }
  return sentences;
}

}  // namespace experiment
