// The state of devices by itself, as it is in a snapshot: half read lines, and bytes that are no state.
#include "sim/world/mounted_device.hpp"
#include "tests/devices/modem_fixture.hpp"
#include "tests/devices/port_fixture.hpp"

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
  const std::string radio = "{name: radio, type: modem, rate_hz: 100, serial: {path: port_{vehicle}}}";
  const std::string yaml = test::modem_sea({{"a", "[0, 0, 5]", radio}, {"b", "[30, 0, 5]", radio}});
  test::WorldWithPorts first(yaml), second(yaml);
  first.ends.at("port_a")->to_world = "the first ha";
  first.run_for(0.1);
  second.run_for(0.1);
  restore(sensor_of(second.world, "a/radio"), saved(sensor_of(first.world, "a/radio")));
  second.ends.at("port_a")->to_world = "lf\n";
  second.run_for(1);
  EXPECT_EQ(second.ends.at("port_b")->from_world, "the first half\n");
}

/// The state of each sensor of a world, cut off or with one bit turned over.
class DamagedState : public testing::TestWithParam<std::string> {};

TEST_P(DamagedState, IsRefusedOrDoesNoHarm) {
  test::LoadedTestWorld original(SHOAL_SOURCE_DIR "/worlds/" + GetParam());
  original.run_for(4);
  sim::Random random(1, GetParam());
  random.begin_step(0);
  int refused = 0;
  for (const auto& mounted : original.world.devices()) {
    if (!mounted->senses()) continue;
    auto& device = const_cast<sim::Sensor&>(*mounted->sensor());
    const sim::Bytes good = saved(device);
    for (int i = 0; i < 50; ++i) {
      sim::Bytes bad = good;
      if (i % 2 == 0)
        bad.resize(random.integer_below(static_cast<std::uint32_t>(good.size())));
      else
        bad[random.integer_below(static_cast<std::uint32_t>(good.size()))] ^=
            static_cast<std::byte>(1 << random.integer_below(8));
      try {
        restore(device, bad);
        EXPECT_NE(i % 2, 0) << mounted->full_name() << " takes " << bad.size() << " of " << good.size() << " bytes";
      } catch (const sim::SnapshotError&) {
        ++refused;
      }
    }
    restore(device, good);
    EXPECT_EQ(saved(device), good) << mounted->full_name();
  }
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, DamagedState, testing::Values("proving_ground.yaml", "proving_sea.yaml"),
                         [](const auto& info) { return info.param.substr(0, info.param.find('.')); });

}  // namespace
