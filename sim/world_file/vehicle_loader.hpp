// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/world_file/load_world.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

/// Turns entries of `vehicles:` into vehicle configurations.  Each vehicle file is read once.
class VehicleLoader {
 public:
  VehicleLoader(const WorldConfig& world, Diagnostics& diagnostics) : world_(world), diagnostics_(diagnostics) {}

  /// The instances of an entry, fewer or none after errors.
  std::vector<VehicleInstance> load(const VehicleEntry& entry);
  /// A vehicle from a tree without parameters, such as VehicleConfig::source.
  std::shared_ptr<const VehicleConfig> read(ConfigNode tree, const std::string& who) const;
  /// Fills `file:` entries of the tree with what the files said.
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
  /// By file, parameters and overrides: entries that say the same share one.
  std::map<std::string, std::shared_ptr<const VehicleConfig>> shared_;
};

/// Reads and checks a vehicle file by itself, with its default parameters.  Of the options the rule about files counts.
VehicleConfig load_vehicle(const std::string& path, const LoadOptions& options = {});

/// A vehicle that a client spawns during the run: an entry of `vehicles:`, and its owner.
struct SpawnRequest {
  VehicleInstance vehicle;
  bool with_client = false;    ///< it goes when the client goes
  double alive_timeout_s = 5;  ///< wall time after which a silent client counts as gone
};

/// Reads a spawn request.  The text comes over the network and is not trusted: it can use vehicle files that lie
/// beside the world file, in ../vehicles or among the shipped ones by their bare names, but no other file, and no
/// serial port.  Throws ConfigError, with places such as `spawn:3:7`; for an error in a vehicle file only the place,
/// as the requester may not be entitled to read the file.  `hidden`: gets those errors in full.
SpawnRequest read_spawn_request(const WorldConfig& world, const std::string& text,
                                std::vector<std::string>* hidden = nullptr);
/// The same for what self_contained_spawn() made of a request that was checked then.
SpawnRequest read_journalled_spawn(const WorldConfig& world, const std::string& text);
/// The request with its vehicle file in it, so that it can be carried out where that file is not.  As it is when the
/// file cannot be read or the request is wrong.
std::string self_contained_spawn(const WorldConfig& world, const std::string& text);

/// A stranger may not reach for ports and included files: reports the keys `serial` and `include`.  Keys of files are
/// refused by their kind (ParamReader::read_path).
void check_untrusted(const ConfigNode& node, const std::string& who, Diagnostics& diagnostics);
/// YAML that comes over the bus, at most 1 MiB.  Throws ConfigError, with places such as `spawn:3:7`.
ConfigNode parse_untrusted(const std::string& text, const std::string& from);

}  // namespace sim
