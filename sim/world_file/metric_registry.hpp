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

/// One figure that a type of metric gives.
struct FigureKind {
  std::string name;     ///< such as `rms_m`
  std::string unit;     ///< such as `m`, `packets`; `1` for a ratio
  std::string meaning;  ///< one line
  bool is_count = false;
};

/// The parameters of one type of metric: its keys beside `name` and `type`.
class MetricParams {
 public:
  virtual ~MetricParams() = default;
  virtual void read(ParamReader& in) = 0;
  /// Reports what shows only when all vehicles of the world are known.
  virtual void check(const MetricConfig& /*metric*/, const WorldConfig& /*world*/, Diagnostics& /*diagnostics*/) const {
  }

  // Keys shared by several types: a type reads its own, and the others keep their defaults.
  std::string vehicle;  ///< that it looks at: it cannot be removed; empty: none, or all
  std::string channel;  ///< that it reads
  double from_s = 0;    ///< what comes before this time does not count

 protected:
  void read_vehicle(ParamReader& in);
  void read_channel(ParamReader& in);
  void read_from_s(ParamReader& in);
  /// A declared name of `kind`.  An empty one names nothing, which is an error.
  static void read_known_name(ParamReader& in, const char* key, std::string& value, const char* kind,
                              const char* meaning);
};

/// A type of metric by its word in YAML.
struct MetricKind {
  std::string word;                 ///< of `type:`
  std::string meaning;              ///< one line
  std::vector<FigureKind> figures;  ///< the most important one first
  std::function<std::shared_ptr<MetricParams>()> make_params;

  /// Null when it has no figure of this name.
  const FigureKind* find(const std::string& figure) const;
  /// Its keys beside `name` and `type`.
  std::vector<ParamInfo> keys() const;
};

/// All types of metrics, filled before main by SHOAL_METRIC (tools/experiment/score/metric_registry.hpp), as
/// DeviceRegistry is.
class MetricRegistry {
 public:
  static MetricRegistry& instance();
  /// Two types of one word are a mistake of the program.
  void add(MetricKind kind);
  /// Null when there is none.
  const MetricKind* find(const std::string& word) const;
  /// In the order of their words.
  std::vector<const MetricKind*> all() const;
  std::vector<std::string> words() const;
  /// The type that gives just these figures; null: none does.
  const MetricKind* of_figures(const std::set<std::string>& figures) const;

 private:
  std::vector<std::unique_ptr<MetricKind>> kinds_;
};

}  // namespace sim
