// SPDX-License-Identifier: BSD-3-Clause
// Installs the build tree into a prefix, builds the example plugin against it as a user would, and runs it.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/project_paths.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

namespace fs = std::filesystem;
using system_test::Ended;
using system_test::source;
using system_test::write_file;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Ended run(std::vector<std::string> arguments) {
  system_test::Program program(std::move(arguments));
  const int exit_code = program.wait(std::chrono::seconds(240));
  return {exit_code, program.output(), program.errors()};
}

/// One installation for all tests of the program.
class Plugin : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new system_test::ScratchFolder;
    const Ended installed = run({"cmake", "--install", test_support::built_path(""), "--prefix", path("prefix")});
    ASSERT_EQ(installed.exit_code, 0) << installed.errors;
    fs::copy(source("examples/plugin"), path("example"), fs::copy_options::recursive);
    fs::remove_all(path("example/build"));
    build(path("example"));
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::string path(const std::string& name) { return folder_->file(name); }
  static std::string example() { return path("example/build/thermometer.so"); }

  static void build(const std::string& directory, const std::string& flags = "") {
    const Ended configured = run({"cmake", "-S", directory, "-B", directory + "/build",
                                  "-DCMAKE_PREFIX_PATH=" + path("prefix"), "-DCMAKE_CXX_FLAGS=" + flags});
    ASSERT_EQ(configured.exit_code, 0) << configured.output << configured.errors;
    const Ended built = run({"cmake", "--build", directory + "/build"});
    ASSERT_EQ(built.exit_code, 0) << built.output << built.errors;
  }

  /// NAME/build/NAME.so out of one source and perhaps a message type.
  static void build_plugin(const std::string& name, const std::string& source_text, const std::string& more = "",
                           const std::string& lcm = "") {
    fs::create_directories(path(name));
    write_file(path(name + "/" + name + ".cpp"), source_text);
    write_file(path(name + "/scan_t.lcm"), lcm);
    write_file(path(name + "/CMakeLists.txt"),
               "cmake_minimum_required(VERSION 3.25)\nproject(own LANGUAGES CXX)\nfind_package(Shoal REQUIRED)\n"
               "shoal_add_device(" +
                   name + " SOURCES " + name + ".cpp " + more + ")\n");
    build(path(name));
  }

  static Ended shoal(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), path("prefix/bin/shoal"));
    return run(std::move(arguments));
  }

  /// A folder for the compiler's path whose ode/ode.h ends a compilation.
  static std::string folder_without_ode() {
    fs::create_directories(path("without_ode/ode"));
    write_file(path("without_ode/ode/ode.h"), "#error a plugin reads the headers of ODE\n");
    return path("without_ode");
  }

  /// A library of this text, compiled without anything of Shoal.
  static std::string library(const std::string& name, const std::string& text) {
    write_file(path(name + ".cpp"), text);
    const Ended compiled = run({"c++", "-shared", "-fPIC", path(name + ".cpp"), "-o", path(name + ".so")});
    EXPECT_EQ(compiled.exit_code, 0) << compiled.errors;
    return path(name + ".so");
  }

  /// The text of SHOAL_PLUGIN in the example: what the program accepts.
  static std::string good_info() {
    const std::string bytes = system_test::text_of_file(example());
    return bytes.c_str() + bytes.find("shoal-plugin|");
  }
  static std::string info_symbol(const std::string& info) {
    return "extern \"C\" const char shoal_plugin_info[];\nconst char shoal_plugin_info[] = \"" + info + "\";\n";
  }

  /// Exit code 2, and exactly this line.
  static void expect_refused(const std::string& plugin, const std::string& reason) {
    const Ended ended = shoal({"list", "devices", "--plugin", plugin});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.errors, StartsWith("--plugin " + plugin + ": " + reason));
    EXPECT_EQ(std::count(ended.errors.begin(), ended.errors.end(), '\n'), 1) << ended.errors;
    EXPECT_EQ(ended.output, "");
  }

 private:
  static system_test::ScratchFolder* folder_;
};

system_test::ScratchFolder* Plugin::folder_ = nullptr;

TEST_F(Plugin, BuiltOutsideOfTheTreeReports) {
  const std::string record = path("air.lcm");
  const Ended ended = shoal({"run", path("example/thermometer.yaml"), "--plugin", example(), "--bus", "none",
                             "--record", record, "--overwrite"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const Ended info = shoal({"log", "info", record, "--plugin", example()});
  EXPECT_THAT(info.output, HasSubstr("probe.air"));
  EXPECT_THAT(info.output, HasSubstr("thermometer.temperature_t"));
  const Ended csv = shoal({"log", "csv", record, "probe.air", "--plugin", example()});
  EXPECT_THAT(csv.output, HasSubstr("temperature_degc"));
  // 20 degrees at the ground, a hundredth less per meter, from 100 m.
  EXPECT_THAT(csv.output, testing::ContainsRegex(",19\\.0[0-9]*\n"));
}

TEST_F(Plugin, IsDescribedAndListedLikeAnyOtherDevice) {
  const Ended described = shoal({"describe", "thermometer", "--plugin", example()});
  EXPECT_EQ(described.exit_code, 0);
  EXPECT_THAT(described.output, HasSubstr("slope_degcpm"));
  EXPECT_THAT(shoal({"list", "devices", "--plugin", example()}).output, HasSubstr("\n  thermometer "));
  EXPECT_THAT(shoal({"list", "messages", "--plugin", example()}).output, HasSubstr("thermometer.temperature_t"));
  EXPECT_THAT(shoal({"describe", "--schema", "world", "--plugin", example()}).output,
              HasSubstr("\"device_thermometer\""));
  EXPECT_EQ(shoal({"describe", "thermometer"}).exit_code, 2);
}

TEST_F(Plugin, IsBuiltWithoutTheHeadersOfOde) {
  fs::copy(path("example"), path("ode_free"), fs::copy_options::recursive);
  fs::remove_all(path("ode_free/build"));
  write_file(path("ode_free/thermometer.cpp"),
             "#include \"sim/physics/physics_world.hpp\"\n#include \"sim/world/world.hpp\"\n" +
                 system_test::text_of_file(path("ode_free/thermometer.cpp")));
  build(path("ode_free"), "-I" + folder_without_ode());
  EXPECT_EQ(shoal({"describe", "thermometer", "--plugin", path("ode_free/build/thermometer.so")}).exit_code, 0);
  EXPECT_THAT(system_test::text_of_file(path("prefix/lib/cmake/Shoal/ShoalConfig.cmake")), Not(HasSubstr("ODE")));
}

TEST_F(Plugin, BringsAnActionOfEvents) {
  build_plugin("leaving", R"(#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/device/plugin.hpp"
#include "sim/vehicle/end_of_run.hpp"

namespace {

class AbandonAction final : public sim::Action {
 public:
  static constexpr const char* meaning = "the crew leaves";
  static constexpr const char* main_key = "crew";
  static constexpr bool main_alone = true;
  void read(sim::ParamReader& in, const char* main) override { in.read(main, crew_, sim::at_least(1), "how many"); }
  void carry_out(const sim::ActionRun& run) const override {
    run.stage.end({std::to_string(crew_) + " left", false});
  }

 private:
  int crew_ = 0;
};

SHOAL_ACTION("abandon", AbandonAction);

}  // namespace

SHOAL_PLUGIN("leaving", "1.0");
)");
  const std::string plugin = path("leaving/build/leaving.so"), world = path("leaving.yaml");
  const auto world_with = [&](const std::string& crew) {
    write_file(world, "shoal: 1\nrun: {duration_s: 2, speed: max}\nevents: [{name: e, at: 1, do: [{abandon: " + crew +
                          "}]}]\n");
  };
  world_with("3");
  EXPECT_THAT(shoal({"check", world}).errors, HasSubstr("'abandon'"));
  const Ended ended = shoal({"run", world, "--plugin", plugin, "--bus", "none"});
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("3 left"));
  EXPECT_THAT(shoal({"describe", "--schema", "world", "--plugin", plugin}).output, HasSubstr("the crew leaves"));
  world_with("0");
  EXPECT_THAT(shoal({"check", world, "--plugin", plugin}).errors, HasSubstr(world + ":3:"));
}

TEST_F(Plugin, MayBeNamedTwice) {
  EXPECT_EQ(shoal({"list", "devices", "--plugin", example(), "--plugin", example()}).exit_code, 0);
}

TEST_F(Plugin, OfAWorldNeedsAWordFromTheUser) {
  const std::string world = path("example/thermometer.yaml");
  const Ended ended = shoal({"check", world});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.errors, world +
                              ":6:11: plugin 'build/thermometer.so': a world file may run code only with --launch, "
                              "or name the plugin with --plugin " +
                              example() + "\n");
  EXPECT_EQ(shoal({"check", world, "--plugin", example()}).exit_code, 0);
}

TEST_F(Plugin, OfAWorldIsLoadedWithLaunch) {
  // Launching needs the bus; what is looked at is that the world itself is accepted.
  const Ended ended = shoal({"run", path("example/thermometer.yaml"), "--launch", "--bus", "none"});
  EXPECT_THAT(ended.errors, HasSubstr("--launch needs the LCM bus"));
}

TEST_F(Plugin, IsFoundAmongTheInstalledOnes) {
  fs::create_directories(path("prefix/lib/shoal/plugins"));
  fs::copy_file(example(), path("prefix/lib/shoal/plugins/installed.so"), fs::copy_options::overwrite_existing);
  EXPECT_THAT(shoal({"list", "devices", "--plugin", "installed.so"}).output, HasSubstr("\n  thermometer "));
}

TEST_F(Plugin, IsFoundByAPathOfTheEnvironment) {
  const Ended ended = run({"env", "SHOAL_PLUGIN_PATH=/nowhere:" + path("example/build"), path("prefix/bin/shoal"),
                           "list", "devices", "--plugin", "thermometer.so"});
  EXPECT_THAT(ended.output, HasSubstr("\n  thermometer "));
}

TEST_F(Plugin, MayHaveMessagesThatHoldArraysAndShoalsOwn) {
  const std::string initializer =
      "#include <stdexcept>\n#include \"arrays/array_lengths.hpp\"\n#include \"shoal/message_codec.hpp\"\n"
      "#include \"sim/device/plugin.hpp\"\n"
      "static bool refuses_a_wrong_length() {\n"
      "  arrays::scan_t message;\n  message.count = 1;\n  std::vector<std::byte> out;\n"
      "  try { shoal::encode_into(message, out); } catch (const shoal::MessageError&) {\n"
      "    message.values.resize(1);\n    message.poses.resize(1);\n"
      "    shoal::encode_into(message, out);\n    return true;\n  }\n"
      "  throw std::runtime_error(\"not refused\");\n}\n"
      "static const bool refused = refuses_a_wrong_length();\n"
      "SHOAL_PLUGIN(\"arrays\", \"1.0\");\n";
  build_plugin("arrays", initializer, "LCM scan_t.lcm",
               "package arrays;\nstruct scan_t { int32_t count; double values[count]; shoal.pose_t poses[count]; }\n");
  const Ended ended = shoal({"describe", "arrays.scan_t", "--plugin", path("arrays/build/arrays.so")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("shoal.pose_t"));
}

TEST_F(Plugin, ThatIsNoneSaysWhy) {
  expect_refused(path("missing.so"), "there is no such file\n");
  write_file(path("text.so"), "hello\n");
  expect_refused(path("text.so"), "is not a library\n");
  expect_refused(library("plain", "int nothing;\n"), "is not a Shoal plugin: it lacks SHOAL_PLUGIN");
}

TEST_F(Plugin, OfAnotherShoalIsNotEvenInitialized) {
  const std::string other = library("other", info_symbol("shoal-plugin|other|1.0|shoal 0.0.1") +
                                                 "#include <cstdlib>\nstatic int ended = (std::abort(), 0);\n");
  expect_refused(other, "was built for another version of Shoal and must be rebuilt; it has 'shoal 0.0.1'");
}

TEST_F(Plugin, ThatLacksAFunctionSaysWhich) {
  expect_refused(
      library("lacking", info_symbol(good_info()) + "void nowhere_defined();\nvoid call() { nowhere_defined(); }\n"),
      "cannot be loaded: undefined symbol: ");
}

TEST_F(Plugin, WhoseInitializerThrowsSaysWhat) {
  expect_refused(
      library("throwing", info_symbol(good_info()) + "#include <stdexcept>\n"
                                                     "static int f() { throw std::runtime_error(\"no thermistor\"); }\n"
                                                     "static int thrown = f();\n"),
      "an initializer threw: no thermistor\n");
}

TEST_F(Plugin, WithATypeThatExistsIsRefused) {
  const std::string text =
      "#include \"sim/device/device_registry.hpp\"\n#include \"sim/device/plugin.hpp\"\n"
      "static const bool added = (sim::DeviceRegistry::instance().add({.name = \"lidar\"}), true);\n"
      "SHOAL_PLUGIN(\"copy\", \"1.0\");\n";
  build_plugin("clash", text);
  expect_refused(path("clash/build/clash.so"), "device type 'lidar' exists twice\n");
}

TEST_F(Plugin, InstallationHasTheClientLibrary) {
  fs::copy(source("examples/client"), path("client"), fs::copy_options::recursive);
  fs::remove_all(path("client/build"));
  build(path("client"));
  const std::string url = system_test::own_url(2);
  system_test::Program pilot({"env", "LCM_DEFAULT_URL=" + url, path("client/build/pilot")});
  const Ended ended = shoal({"run", path("prefix/share/shoal/worlds/minimal.yaml"), "--duration", "15", "--speed",
                             "max", "--await", "pilot", "--lcm-url", url});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_EQ(pilot.wait(), 0) << pilot.errors();
  // It sees each 0.1 s how far the wall is, at 0.5 m/s, and then has to brake.
  EXPECT_THAT(pilot.output(), testing::ContainsRegex("the run is over, 0\\.[89][0-9]* m before the wall"));
}

TEST_F(Plugin, AClientNeedsTheComponentClientAlone) {
  const Ended installed = run(
      {"cmake", "--install", test_support::built_path(""), "--prefix", path("client_prefix"), "--component", "client"});
  ASSERT_EQ(installed.exit_code, 0) << installed.errors;
  EXPECT_FALSE(fs::exists(path("client_prefix/bin")));
  EXPECT_FALSE(fs::exists(path("client_prefix/include/shoal/sim")));
  const std::vector<std::string> configure = {"cmake", "-DCMAKE_PREFIX_PATH=" + path("client_prefix"), "-S"};
  const auto configured = [&](const std::string& sources, const std::string& build_folder) {
    std::vector<std::string> command = configure;
    command.insert(command.end(), {sources, "-B", path(build_folder)});
    return run(command);
  };
  const Ended client = configured(source("examples/client"), "small_client");
  ASSERT_EQ(client.exit_code, 0) << client.errors;
  EXPECT_EQ(run({"cmake", "--build", path("small_client")}).exit_code, 0);
  const Ended device = configured(source("examples/plugin"), "small_device");
  EXPECT_NE(device.exit_code, 0);
  EXPECT_THAT(device.errors, HasSubstr("its component 'device' is not installed"));
}

TEST_F(Plugin, ClientExampleIsThatOfThePage) {
  const std::string page = system_test::text_of_file(source("docs/guides/client_library.md"));
  for (const char* file : {"examples/client/pilot.cpp", "examples/client/CMakeLists.txt"}) {
    const std::string text = system_test::text_of_file(source(file));
    EXPECT_THAT(page, HasSubstr(text.substr(text.find('\n') + 1))) << "after the license line";
  }
}

TEST_F(Plugin, AProgramOutsideOfTheTreeIsDescribedWhenItIsBuilt) {
  fs::create_directories(path("own"));
  write_file(path("own/pilot.cpp"),
             "#include <cstdio>\nint main() { std::puts(\"shoal_args: 1\\nprogram: pilot\\nargs: [{name: speed_mps, "
             "type: number, max: 2}]\"); }\n");
  write_file(path("own/CMakeLists.txt"),
             "cmake_minimum_required(VERSION 3.25)\nproject(own LANGUAGES CXX)\n"
             "find_package(Shoal REQUIRED COMPONENTS client)\nadd_executable(pilot pilot.cpp)\n"
             "shoal_describe_program(pilot DESTINATION bin)\n");
  build(path("own"));
  const Ended installed = run({"cmake", "--install", path("own/build"), "--prefix", path("prefix")});
  ASSERT_EQ(installed.exit_code, 0) << installed.errors;
  write_file(path("own.yaml"), "shoal: 1\nprocesses: [{name: p, program: pilot, args: {speed_mps: 3}}]\n");
  const Ended wrong = shoal({"check", path("own.yaml")});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.errors, HasSubstr(":2:57: process 'p': program 'pilot': 'speed_mps' must be <= 2, got 3"));
  EXPECT_EQ(shoal({"check", path("own.yaml"), "--set", "processes.p.args.speed_mps=2"}).exit_code, 0);
}

TEST_F(Plugin, InstallationRunsItsOwnWorlds) {
  const Ended ended = shoal({"check", path("prefix/share/shoal/worlds/coop_land.yaml")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_TRUE(fs::exists(path("prefix/share/shoal/docs/reference/schema/world.schema.json")));
  const Ended by_name = shoal({"run", "minimal", "--bus", "none", "--duration", "1", "--speed", "max"});
  EXPECT_EQ(by_name.exit_code, 0) << by_name.errors;
  EXPECT_THAT(shoal({"list"}).output, HasSubstr("\nThe files are in " + path("prefix/share/shoal") + "\n"));
}

}  // namespace
