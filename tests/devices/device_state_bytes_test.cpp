// SPDX-License-Identifier: BSD-3-Clause
// The state of devices by itself, as it is in a snapshot: half read lines, and bytes that are not state.
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

/// As in the file of a snapshot.
sim::Bytes saved(sim::Sensor& device) {
  auto archive = sim::StateArchive::saver();
  archive.section("device");
  archive(device);
  archive.end();
  return archive.take_bytes();
}

void restore(sim::Sensor& device, const sim::Bytes& bytes) {
  auto archive = sim::StateArchive::restorer(bytes);
  archive.section("device");
  archive(device);
  archive.end();
}

sim::Sensor& sensor_of(sim::World& world, const std::string& full_name) {
  return const_cast<sim::Sensor&>(*world.find_device(full_name)->sensor());
}

TEST(DeviceState, HalfALineOfASerialPortIsKept) {
  const std::string radio = "{name: radio, type: modem, rate_hz: 100, serial: {path: '{vehicle}'}}";
  const std::string yaml = test::modem_sea({{"a", "[0, 0, 5]", radio}, {"b", "[30, 0, 5]", radio}});
  test::WorldWithPorts first(yaml), second(yaml);
  first.ends.at("a")->to_world = "the first ha";
  first.run_for(0.1);
  second.run_for(0.1);
  restore(sensor_of(second.world, "a/radio"), saved(sensor_of(first.world, "a/radio")));
  second.ends.at("a")->to_world = "lf\n";
  second.run_for(1);
  EXPECT_EQ(second.ends.at("b")->from_world, "the first half\n");
}

/// The states of the sensors of a world, damaged.
class DamagedState : public testing::TestWithParam<std::string> {
 protected:
  DamagedState() {
    test.run_for(4);
    random.begin_step(0);
    for (const auto& mounted : test.world.devices()) {
      if (!mounted->senses()) continue;
      sensors.push_back(const_cast<sim::Sensor*>(mounted->sensor()));
      names.push_back(mounted->full_name());
      good.push_back(saved(*sensors.back()));
    }
  }
  std::size_t below(std::size_t size) { return random.integer_below(static_cast<std::uint32_t>(size)); }

  test::LoadedTestWorld test{test_support::source_path("worlds/") + GetParam()};
  sim::Random random{1, GetParam()};
  std::vector<sim::Sensor*> sensors;
  std::vector<std::string> names;
  std::vector<sim::Bytes> good;
};

TEST_P(DamagedState, IsRefusedWhenItIsCutOff) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    for (int cut = 0; cut < 25; ++cut) {
      sim::Bytes bad = good[i];
      bad.resize(below(bad.size()));
      EXPECT_THROW(restore(*sensors[i], bad), sim::SnapshotError) << names[i] << " takes " << bad.size() << " bytes";
    }
    restore(*sensors[i], good[i]);
    EXPECT_EQ(saved(*sensors[i]), good[i]) << names[i];
  }
}

TEST_P(DamagedState, IsRefusedOrTheWorldContinues) {
  int refused = 0, taken = 0;
  for (int round = 0; round < 25; ++round) {
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      sim::Bytes bad = good[i];
      bad[below(bad.size())] ^= static_cast<std::byte>(1 << below(8));
      try {
        restore(*sensors[i], bad);
        ++taken;
      } catch (const sim::SnapshotError&) {
        restore(*sensors[i], good[i]);
        ++refused;
      }
    }
    const sim::Time before = test.world.now();
    test.run_for(0.2);
    EXPECT_GT(test.world.now(), before);
    for (std::size_t i = 0; i < sensors.size(); ++i) restore(*sensors[i], good[i]);
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(taken, 0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, DamagedState, testing::Values("proving_ground.yaml", "proving_sea.yaml"),
                         [](const auto& world) { return world.param.substr(0, world.param.find('.')); });

}  // namespace
