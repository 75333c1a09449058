// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/world_file/load_world.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

/// Loader that converts entries of `vehicles:` to vehicle configurations.  Each vehicle file is read once.
class VehicleLoader {
 public:
  VehicleLoader(const WorldConfig& world, Diagnostics& diagnostics) : world_(world), diagnostics_(diagnostics) {}

  /// Returns the instances of an entry, fewer or none after errors.
  std::vector<VehicleInstance> load(const VehicleEntry& entry);
  /// Reads a vehicle from a tree without parameters, such as VehicleConfig::source.
  std::shared_ptr<const VehicleConfig> read(ConfigNode tree, const std::string& who) const;
  /// Replaces the `file:` entries of the tree by the contents of the files.
  void resolve(ConfigNode& world_node) const;

 private:
  const ConfigNode* model_of(const VehicleEntry& entry, const std::string& who);
  bool may_read(const VehicleEntry& entry, const std::string& path, const std::string& who);
  const ConfigNode* model_of_node(const ConfigNode& model, const std::string& who);
  std::shared_ptr<const VehicleConfig> instance(const VehicleEntry& entry, const ConfigNode& model,
                                                const std::string& name, int index);
  void declare_names(ParamReader& in, const ConfigNode& tree) const;
  std::vector<std::pair<std::string, ConfigNode>> parameters_of(const VehicleEntry& entry, const ConfigNode& model,
                                                                const std::string& who, int index);

  const WorldConfig& world_;
  Diagnostics& diagnostics_;
  std::map<std::string, ConfigNode> files_;
  /// Configurations by file, parameters and overrides; equal entries share one.
  std::map<std::string, std::shared_ptr<const VehicleConfig>> shared_;
};

/// Reads and checks a vehicle file by itself, with its default parameters.  Of the options, only the rules for files
/// apply.
VehicleConfig load_vehicle(const std::string& path, const LoadOptions& options = {});

/// Request of a client to spawn a vehicle during the run: an entry of `vehicles:` and its owner.
struct SpawnRequest {
  VehicleInstance vehicle;
  bool with_client = false;    ///< remove the vehicle when its client has disconnected
  double alive_timeout_s = 5;  ///< wall time after which a silent client counts as disconnected
};

/// Reads a spawn request.  The text comes over the network and is untrusted: it may use vehicle files beside the world
/// file, in ../vehicles or among the shipped ones by their bare names, but no other file and no serial port.  Throws
/// ConfigError, with places such as `spawn:3:7`; for an error in a vehicle file only the place, because the requester
/// may not be entitled to read the file.  `hidden`: receives those errors in full.
SpawnRequest read_spawn_request(const WorldConfig& world, const std::string& text,
                                std::vector<std::string>* hidden = nullptr);
/// Reads the result of self_contained_spawn() for a request that was checked before.
SpawnRequest read_journalled_spawn(const WorldConfig& world, const std::string& text);
/// Returns the request with the contents of its vehicle file, so that it can be executed where the file does not exist.
/// Returns it unchanged when the file cannot be read or the request is invalid.
std::string self_contained_spawn(const WorldConfig& world, const std::string& text);

/// Reports the keys `serial` and `include`, which untrusted input may not use.  Keys of files are refused by their kind
/// (ParamReader::read_path).
void check_untrusted(const ConfigNode& node, const std::string& who, Diagnostics& diagnostics);
/// Parses YAML received over the bus, at most 1 MiB.  Throws ConfigError, with places such as `spawn:3:7`.
ConfigNode parse_untrusted(const std::string& text, const std::string& from);

}  // namespace sim
