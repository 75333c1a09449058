// SPDX-License-Identifier: BSD-3-Clause
// What docs/guides/untrusted_worlds.md promises of the files that a world or a peer names.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const std::string stone = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const std::string secret = "hunter2";
const std::string rule = "must lie below the folder of the world";

class StrangersWorld : public testing::Test {
 protected:
  StrangersWorld() {
    fs::create_directories(at("home"));
    write("home/stone.obj", stone);
    write("home/base.yaml", "run: {duration_s: 1}\n");
    write("home/auv.yaml", vehicle());
    write("home/secret.txt", secret + ": " + secret + "\n");
    write("world/stone.obj", stone);
    write("vehicles/sister.yaml", vehicle());
    write("vehicles/stone.obj", stone);
  }
  static std::string vehicle(const std::string& mesh = "stone.obj") {
    return "shoal: 1\nvehicle: auv\nbodies: [{name: hull, parts: [{shape: mesh, mesh: " + mesh + ", mass_kg: 1}]}]\n";
  }
  std::string at(const std::string& name) const { return folder_.file(name); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(at(name)).parent_path());
    std::ofstream(at(name)) << text;
  }
  /// What is said of a world of this text in `world/`; empty: nothing.
  std::string error_of(const std::string& text, std::vector<std::string> allow = {},
                       std::vector<std::string> sets = {}) {
    write("world/w.yaml", "shoal: 1\n" + text);
    sim::LoadOptions options;
    options.only_own_files = true;
    options.allow_paths = std::move(allow);
    options.sets = std::move(sets);
    try {
      loaded_ = sim::load_world(at("world/w.yaml"), options);
      return {};
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }
  static std::string object(const std::string& mesh) {
    return "objects: [{name: o, fixed: true, parts: [{shape: mesh, mesh: " + mesh + "}]}]\n";
  }
  static std::string entry(const std::string& file) { return "vehicles: [{name: a, file: " + file + "}]\n"; }

  test_support::ScratchFolder folder_;
  sim::LoadedWorld loaded_;
};

TEST_F(StrangersWorld, NamesFilesOfItsFolderItsSisterAndTheShippedOnes) {
  EXPECT_EQ(error_of(object("stone.obj")), "");
  EXPECT_THAT(sim::to_yaml(loaded_.resolved), HasSubstr(at("world/stone.obj")));
  EXPECT_EQ(error_of(object(at("world/stone.obj"))), "");
  EXPECT_EQ(error_of(object("../vehicles/stone.obj")), "");
  EXPECT_EQ(error_of(entry("sister.yaml")), "");
  EXPECT_EQ(error_of(entry("rover.yaml")), "");
}

TEST_F(StrangersWorld, NamesNoOtherFiles) {
  fs::create_symlink(at("home/stone.obj"), at("world/link.obj"));
  fs::create_symlink(at("home/auv.yaml"), at("world/link.yaml"));
  for (const std::string& mesh : {std::string("../home/stone.obj"), at("home/stone.obj"), std::string("link.obj")})
    EXPECT_THAT(error_of(object(mesh)), HasSubstr("'mesh' " + rule)) << mesh;
  for (const std::string& file : {std::string("../home/auv.yaml"), at("home/auv.yaml"), std::string("link.yaml")})
    EXPECT_THAT(error_of(entry(file)), HasSubstr("'file' " + rule)) << file;
  EXPECT_THAT(error_of("include: ../home/base.yaml\n"), HasSubstr(rule));
  EXPECT_THAT(error_of("materials: [{name: m, texture: {pattern: image, file: /etc/passwd}}]\n"),
              HasSubstr("'file' " + rule));
  EXPECT_THAT(error_of("medium: {water: {}, current: [{type: grid, file: /etc/passwd}]}\n"),
              HasSubstr("'file' " + rule));
  // By way of a vehicle file, an override and a parameter.
  write("vehicles/thief.yaml", vehicle("../home/stone.obj"));
  write("vehicles/open.yaml", "parameters: {mesh: stone.obj}\n" + vehicle("'${mesh}'"));
  EXPECT_THAT(error_of(entry("thief.yaml")), HasSubstr("'mesh' " + rule));
  EXPECT_THAT(
      error_of("vehicles: [{name: a, file: sister.yaml, overrides: {bodies.hull.parts.1.mesh: /etc/passwd}}]\n"),
      HasSubstr("'mesh' " + rule));
  EXPECT_THAT(error_of("vehicles: [{name: a, file: open.yaml, parameters: {mesh: /etc/passwd}}]\n"),
              HasSubstr("'mesh' " + rule));
}

TEST_F(StrangersWorld, ASettingOfAStudyNamesNoMoreThanTheWorldMay) {
  write("world/w.yaml", "shoal: 1\n" + object("stone.obj"));
  sim::LoadOptions options;
  options.only_own_files = true;
  options.study_sets = {"objects.o.parts.1.mesh=../vehicles/stone.obj"};
  EXPECT_NO_THROW(sim::load_world(at("world/w.yaml"), options));
  options.study_sets = {"objects.o.parts.1.mesh=" + at("home/stone.obj")};
  try {
    sim::load_world(at("world/w.yaml"), options);
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'mesh' " + rule));
  }
}

TEST_F(StrangersWorld, NamesMoreWhenTheCommandLineAllowsIt) {
  EXPECT_EQ(error_of(object("../home/stone.obj"), {at("home")}), "");
  EXPECT_EQ(error_of(object("../home/stone.obj"), {at("home/stone.obj")}), "");
  EXPECT_EQ(error_of(entry("../home/auv.yaml"), {at("home")}), "");
  EXPECT_EQ(error_of("include: ../home/base.yaml\n", {at("home")}), "");
  EXPECT_EQ(error_of(object("stone.obj"), {}, {"objects.o.parts.1.mesh=" + at("home/stone.obj")}), "");
}

TEST_F(StrangersWorld, FilesBehindParametersAndOverridesAreMadeAbsoluteToo) {
  write("vehicles/open.yaml", "parameters: {mesh: stone.obj}\n" + vehicle("'${mesh}'"));
  write("vehicles/other.obj", stone);
  ASSERT_EQ(error_of("vehicles: [{name: a, file: open.yaml, parameters: {mesh: other.obj}}]\n"), "");
  EXPECT_THAT(sim::to_yaml(loaded_.resolved), HasSubstr("mesh: " + at("vehicles/other.obj")));
  ASSERT_EQ(error_of("vehicles: [{name: a, file: sister.yaml, overrides: {bodies.hull.parts.1.mesh: other.obj}}]\n"),
            "");
  EXPECT_THAT(sim::to_yaml(loaded_.resolved), HasSubstr("bodies.hull.parts.1.mesh: " + at("vehicles/other.obj")));
}

TEST_F(StrangersWorld, AFileThatItNamesIsNotQuoted) {
  for (const std::string& text :
       std::vector<std::string>{secret + "\n", secret + ": 1\n", "[" + secret + "]\n",
                                secret + ": 1\n" + secret + ": 2\n", "!" + secret + " x\n", "\"" + secret}) {
    write("world/notes.yaml", text);
    for (const std::string& world : {entry("notes.yaml"), std::string("include: notes.yaml\n")}) {
      const std::string error = error_of(world);
      EXPECT_THAT(error, HasSubstr("notes.yaml:")) << text;
      EXPECT_THAT(error, Not(HasSubstr(secret))) << text;
    }
  }
  write("world/notes.txt", secret + "\n" + secret + " 2\n");
  fs::copy_file(at("world/notes.txt"), at("world/notes.obj"));
  write("world/bad.obj", "v " + secret + "\n");
  write("world/bad.stl", "solid x\n" + secret + std::string(100, ' '));
  const std::string terrain =
      "objects: [{name: o, fixed: true, parts: [{shape: terrain, terrain: {source: ascii, file: notes.txt}}]}]\n";
  const std::string current = "medium: {water: {}, current: [{type: grid, file: notes.txt}]}\n";
  for (const std::string& text :
       std::vector<std::string>{terrain, current, object("notes.obj"), object("bad.obj"), object("bad.stl")}) {
    std::string error = error_of(text);
    if (error.empty()) {
      sim::InProcessBus bus;
      try {
        const sim::World world(loaded_.config, bus);
      } catch (const std::exception& thrown) {
        error = thrown.what();
      }
    }
    EXPECT_NE(error, "") << text;
    EXPECT_THAT(error, Not(HasSubstr(secret))) << text;
  }
}

TEST_F(StrangersWorld, AVehicleFileIsQuotedWhenItIsOne) {
  write("vehicles/syntax.yaml", "shoal: 1\nbodies: [\n");
  EXPECT_THAT(error_of(entry("syntax.yaml")), HasSubstr("not valid YAML: "));
  write("vehicles/broken.yaml", "shoal: 1\nbodies: heavy\n");
  EXPECT_THAT(error_of(entry("broken.yaml")), HasSubstr("'bodies' must be a list of maps, got 'heavy'"));
}

TEST_F(StrangersWorld, MakesSerialPortsBelowTheRunOnly) {
  const auto modem = [](const std::string& path) {
    return "medium: {water: {}}\nvehicles: [{name: a, position_m: [0, 0, -5], model: {shoal: 1, bodies: [{name: hull, "
           "parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}], devices: [{name: modem, type: micromodem, address: "
           "1, serial: {path: \"" +
           path + "\"}}]}}]\n";
  };
  EXPECT_EQ(error_of(modem("{vehicle}.modem")), "");
  for (const std::string& path :
       std::vector<std::string>{std::string("/tmp/x"), std::string("../x"), at("world/x"), std::string("~/../../x")})
    EXPECT_THAT(error_of(modem(path)), HasSubstr("'path' must be relative to the folder of the run")) << path;
  EXPECT_EQ(error_of(modem(at("home/x")), {at("home")}), "");
}

TEST_F(StrangersWorld, ItsBusesStayOnTheMachine) {
  const auto bus = [](const std::string& url) { return "buses: [{name: b, lcm_url: \"" + url + "\"}]\n"; };
  EXPECT_EQ(error_of(bus("udpm://239.255.76.67:7668?ttl=0")), "");
  EXPECT_EQ(error_of(bus("udpm://239.255.76.67:7668")), "");
  for (const std::string& url :
       std::vector<std::string>{"udpm://239.255.76.67:7668?ttl=1", "udpm://239.255.76.67:7668?ttl=01",
                                "tcpq://1.2.3.4:7700", "udpm://239.255.76.67:7668?ttl=0&ttl=2"}) {
    EXPECT_THAT(error_of(bus(url)), HasSubstr("'lcm_url' must stay on this machine")) << url;
    EXPECT_EQ(error_of(bus("udpm://239.255.76.67:7668"), {}, {"buses.b.lcm_url=" + url}), "") << url;
  }
  EXPECT_THAT(error_of(bus("file:///tmp/x?mode=w")), HasSubstr("'lcm_url' must be the URL of a network, got a file"));
}

/// Before: terrain.file and texture.file were opened, and the answer held the first word.
TEST_F(StrangersWorld, APeerNamesNoFiles) {
  write("vehicles/open.yaml", "parameters: {mesh: stone.obj, part: stone}\n" + vehicle("'${part}.obj'"));
  ASSERT_EQ(error_of(""), "");
  const auto refused = [&](const std::string& request) {
    try {
      sim::read_spawn_request(loaded_.config, request);
    } catch (const sim::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto model = [](const std::string& part, const std::string& more = "") {
    return "{name: x, model: {shoal: 1, bodies: [{name: b, parts: [" + part + "]}]" + more + "}}";
  };
  for (const std::string& request :
       {model("{shape: mesh, mesh: stone.obj}"), model("{shape: terrain, terrain: {source: ascii, file: /etc/passwd}}"),
        model("{shape: sphere, mass_kg: 1}", ", materials: [{name: m, texture: {pattern: image, file: /etc/passwd}}]"),
        std::string("{name: x, file: sister.yaml, overrides: {bodies.hull.parts.1.mesh: stone.obj}}"),
        std::string("{name: x, file: sister.yaml, overrides: {bodies.hull.parts.1: {shape: mesh, mesh: stone.obj}}}"),
        std::string("{name: x, file: open.yaml, parameters: {part: stone}}")})
    EXPECT_THAT(refused(request), HasSubstr("cannot be used in a request from the bus: it names a file")) << request;
  EXPECT_THAT(refused("{name: x, file: ../home/auv.yaml}"), HasSubstr("must be a bare file name"));
  fs::create_symlink(at("home/auv.yaml"), at("world/link.yaml"));
  EXPECT_THAT(refused("{name: x, file: link.yaml}"), HasSubstr("'file' " + rule));
  EXPECT_EQ(refused("{name: x, file: sister.yaml}"), "no error");
}

TEST_F(StrangersWorld, APeerReadsNoFileInAnAnswer) {
  ASSERT_EQ(error_of(""), "");
  for (const std::string& text :
       std::vector<std::string>{secret + ": 1\n", secret + "\n", "shoal: 1\nbodies: " + secret + "\n",
                                "shoal: 1\nbodies: [{name: b, parts: " + secret + "}]\n"}) {
    write("world/notes.yaml", text);
    std::vector<std::string> hidden;
    try {
      sim::read_spawn_request(loaded_.config, "{name: x, file: notes.yaml}", &hidden);
      ADD_FAILURE() << text;
    } catch (const sim::ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("notes.yaml:")) << text;
      EXPECT_THAT(error.what(), Not(HasSubstr(secret))) << text;
    }
  }
}

}  // namespace
