// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace sim {

struct MetricConfig;
struct WorldConfig;

/// Figure of a type of metric.
struct FigureKind {
  std::string name;     ///< such as `rms_m`
  std::string unit;     ///< such as `m`, `packets`; `1` for a ratio
  std::string meaning;  ///< one line
  bool is_count = false;
};

/// Parameters of one type of metric: its keys except `name` and `type`.
class MetricParams {
 public:
  virtual ~MetricParams() = default;
  virtual void read(ParamReader& in) = 0;
  /// Reports errors that can be found only when all vehicles of the world are loaded.
  virtual void check(const MetricConfig& /*metric*/, const WorldConfig& /*world*/, Diagnostics& /*diagnostics*/) const {
  }

  // Keys shared by several types: a type reads its own, and the others keep their defaults.
  std::string vehicle;  ///< vehicle that is scored, which cannot be removed; empty: none, or all
  std::string channel;  ///< channel that is read
  double from_s = 0;    ///< start time; earlier data are ignored

 protected:
  void read_vehicle(ParamReader& in);
  void read_channel(ParamReader& in);
  void read_from_s(ParamReader& in);
  /// Reads a declared name of `kind`.  An empty name is an error.
  static void read_known_name(ParamReader& in, const char* key, std::string& value, const char* kind,
                              const char* meaning);
};

/// Type of metric, identified by its word in YAML.
struct MetricKind {
  std::string word;                 ///< value of `type:`
  std::string meaning;              ///< one line
  std::vector<FigureKind> figures;  ///< the most important one first
  std::function<std::shared_ptr<MetricParams>()> make_params;

  /// Returns a figure by name; null when there is none.
  const FigureKind* find(const std::string& figure) const;
  /// Returns the keys of the type except `name` and `type`.
  std::vector<ParamInfo> keys() const;
};

/// Registry of all types of metrics, filled before main by SHOAL_METRIC (experiment/score/metric_registry.hpp),
/// as DeviceRegistry is.
class MetricRegistry {
 public:
  static MetricRegistry& instance();
  /// Registers a type.  Two types with the same word are a programming error.
  void add(MetricKind kind);
  /// Returns the type with this word; null when there is none.
  const MetricKind* find(const std::string& word) const;
  /// Returns all types, sorted by word.
  std::vector<const MetricKind*> all() const;
  std::vector<std::string> words() const;
  /// Returns the type with exactly these figures; null when there is none.
  const MetricKind* of_figures(const std::set<std::string>& figures) const;

 private:
  std::vector<std::unique_ptr<MetricKind>> kinds_;
};

}  // namespace sim
