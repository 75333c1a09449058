// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/allan_table.hpp"

#include <spdlog/fmt/fmt.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "bridges/log/event_log.hpp"
#include "experiment/files/gnuplot.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "shoal/message_codec.hpp"

namespace viewer {

namespace {

struct Record {
  std::vector<std::int64_t> utime_us;
  std::vector<std::string> fields;
  std::vector<std::vector<double>> values;  ///< by field
};

/// Adds one message: its elements of double arrays, and the rate error of a clock, in the order of the first message.
void add(Record& record, const shoal::MessageSchema& schema, const bridges::LogEvent& event) {
  std::int64_t utime_us = event.utime;
  const bool first = record.utime_us.empty();
  std::size_t field = 0;
  const auto error =
      shoal::visit_fields(schema, event.payload, [&](std::string_view name, const shoal::FieldValue& value) {
        if (const auto* integer = std::get_if<std::int64_t>(&value); integer && name == "utime") utime_us = *integer;
        const double* number = std::get_if<double>(&value);
        if (number == nullptr || !(name.ends_with(']') || name == "rate_error")) return;
        if (first) {
          record.fields.emplace_back(name);
          record.values.emplace_back();
        }
        if (field < record.values.size()) record.values[field].push_back(*number);
        ++field;
      });
  if (error) throw std::runtime_error(event.channel + ": " + *error);
  if (field != record.fields.size()) throw std::runtime_error(event.channel + ": the number of values changes");
  record.utime_us.push_back(utime_us);
}

/// Returns the interval between messages in s.
double interval_s(const Record& record, const std::string& channel) {
  if (record.utime_us.size() < 9)
    throw std::runtime_error(fmt::format("channel '{}' has {} messages; an Allan deviation needs at least 9", channel,
                                         record.utime_us.size()));
  const auto count = static_cast<double>(record.utime_us.size() - 1);
  const double mean_us = static_cast<double>(record.utime_us.back() - record.utime_us.front()) / count;
  for (std::size_t i = 1; i < record.utime_us.size(); ++i) {
    const auto step_us = static_cast<double>(record.utime_us[i] - record.utime_us[i - 1]);
    if (std::abs(step_us - mean_us) > 0.01 * mean_us)
      throw std::runtime_error(
          fmt::format("channel '{}': messages {} and {} are {} us apart, the mean is {:.1f} us; an "
                      "Allan deviation needs equal intervals",
                      channel, i, i + 1, step_us, mean_us));
  }
  return mean_us * 1e-6;
}

/// Returns `angular_velocity_radps` for `angular_velocity_radps[2]`.
std::string array_of(const std::string& field) {
  return field.substr(0, field.find('['));
}

/// Returns the unit suffix of the names of Shoal's fields; empty when unknown.
std::string unit_of(const std::string& array) {
  for (const auto& [ending, unit] :
       {std::pair{"_radps", "rad/s"}, {"_mps2", "m/s^2"}, {"_mps", "m/s"}, {"_uT", "uT"}, {"_rad", "rad"}, {"_m", "m"}})
    if (array.ends_with(ending)) return fmt::format(" ({})", unit);
  return "";
}

bool drawable(const AllanCurve& curve) {
  for (const sim::AllanPoint& point : curve.points)
    if (point.deviation > 0) return true;
  return false;  // zeros and NaN have no logarithm
}

std::string script(const AllanTable& table, const std::string& csv, const std::string& png) {
  // One panel for each array with drawable curves.
  std::vector<std::string> arrays;
  for (const AllanCurve& curve : table.curves)
    if (drawable(curve) && (arrays.empty() || arrays.back() != array_of(curve.field)))
      arrays.push_back(array_of(curve.field));
  if (arrays.empty()) throw std::runtime_error("nothing to draw: every Allan deviation is zero or NaN");
  // Settings common to all panels.
  std::string text = fmt::format(
      "set datafile separator ','\nset terminal pngcairo size 1000,{}\nset output {}\n"
      "set logscale xy\nset format y '10^{{%T}}'\nset grid\nset key top right\nset xlabel 'averaging time (s)'\n"
      "set multiplot layout {},1 title {} noenhanced\n",
      60 + 440 * arrays.size(), experiment::gnuplot_text(png), arrays.size(),
      experiment::gnuplot_text("Allan deviation of " + table.channel));
  // Curves of each panel.
  for (const std::string& array : arrays) {
    text += fmt::format("set ylabel {} noenhanced\nplot ", experiment::gnuplot_text(array + unit_of(array)));
    std::string separator;
    for (const AllanCurve& curve : table.curves) {
      if (array_of(curve.field) != array || !drawable(curve)) continue;
      text += fmt::format("{}{} every ::1 using 2:(strcol(1) eq {} ? $3 : NaN) with lines lw 2 title {} noenhanced",
                          separator, experiment::gnuplot_text(csv), experiment::gnuplot_text(curve.field),
                          experiment::gnuplot_text(curve.field.substr(array.size())));
      separator = ", ";
    }
    text += "\n";
  }
  return text + "unset multiplot\n";
}

}  // namespace

AllanTable allan_table(const std::string& log, const std::string& channel, const shoal::MessageTypes& types) {
  bridges::EventLogReader reader(log);
  Record record;
  const shoal::MessageSchema* schema = nullptr;
  while (const auto event = reader.next()) {
    if (event->channel != channel) continue;
    const auto* type = types.find(static_cast<std::uint64_t>(shoal::fingerprint(event->payload)));
    if (type == nullptr) throw std::runtime_error(channel + ": unknown type; give its .lcm file with --types");
    // The fields of two types could not be joined into one series.
    if (schema != nullptr && schema != type) throw std::runtime_error(channel + ": messages of several types");
    schema = type;
    add(record, *schema, *event);
  }
  AllanTable table{channel, interval_s(record, channel), {}};
  for (std::size_t i = 0; i < record.fields.size(); ++i)
    table.curves.push_back({record.fields[i], sim::allan_deviation(record.values[i], table.dt_s)});
  if (table.curves.empty())
    throw std::runtime_error(channel + ": " + schema->name + " has no array of doubles and no rate_error");
  return table;
}

std::string to_csv(const AllanTable& table) {
  std::string text = "field,tau_s,deviation,relative_error\n";
  for (const AllanCurve& curve : table.curves)
    for (const sim::AllanPoint& point : curve.points)
      text += fmt::format("{},{:.6g},{:.6e},{:.4f}\n", curve.field, point.tau_s, point.deviation, point.relative_error);
  return text;
}

void plot(const AllanTable& table, const std::string& png) {
  const experiment::ScratchDirectory scratch;
  std::ofstream(scratch.path / "allan.csv") << to_csv(table);
  std::ofstream(scratch.path / "plot.gp") << script(table, "allan.csv", std::filesystem::absolute(png).string());
  if (experiment::run_gnuplot(scratch.path.string(), "plot.gp", std::chrono::seconds(30), [] { return false; })) return;
  std::ifstream reported(scratch.path / "plot.log");
  throw std::runtime_error("gnuplot failed: " + std::string(std::istreambuf_iterator<char>(reported), {}));
}

}  // namespace viewer
