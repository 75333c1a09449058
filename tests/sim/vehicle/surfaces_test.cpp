// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/surfaces.hpp"

#include <gmock/gmock.h>

#include "sim/config/diagnostics.hpp"
#include "sim/world_file/vehicle_config.hpp"
#include "sim/world_file/world_config.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

/// The surfaces of a world with the materials default and ice, and a contact of ice.
struct IcyWorld {
  IcyWorld() { surfaces.start(config); }
  static sim::WorldConfig icy() {
    sim::MaterialConfig ice;
    ice.name = "ice";
    sim::WorldConfig config;
    config.materials = {ice};
    config.contacts = {contact("ice", "any", 0.1)};
    return config;
  }
  static sim::ContactConfig contact(const std::string& one, const std::string& other, double friction) {
    sim::ContactConfig made;
    made.between = {one, other};
    made.friction = friction;
    return made;
  }
  std::string error_of(const sim::VehicleConfig& vehicle) const {
    sim::VehicleInstance instance;
    instance.name = "r1";
    instance.config = std::make_shared<const sim::VehicleConfig>(vehicle);
    try {
      surfaces.check_new(instance);
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
    return "none";
  }

  sim::WorldConfig config = icy();
  sim::PhysicsWorld physics{sim::PhysicsConfig(), config.materials, config.contacts, {}, 1};
  sim::Surfaces surfaces{physics};
};

TEST(Surfaces, KnowWhatAVehicleBringsThatIsNew) {
  IcyWorld world;
  sim::VehicleConfig vehicle;
  EXPECT_FALSE(world.surfaces.has_new(vehicle));
  vehicle.contacts = world.config.contacts;
  vehicle.materials = world.config.materials;
  EXPECT_FALSE(world.surfaces.has_new(vehicle));
  vehicle.contacts = {IcyWorld::contact("ice", "any", 0.2)};
  EXPECT_TRUE(world.surfaces.has_new(vehicle));
  vehicle.contacts.clear();
  vehicle.categories = {"glass"};
  EXPECT_TRUE(world.surfaces.has_new(vehicle));
}

TEST(Surfaces, AVehicleChangesOnlyItsOwn) {
  IcyWorld world;
  sim::VehicleConfig vehicle;
  sim::MaterialConfig rubber;
  rubber.name = "rubber";
  vehicle.materials = {rubber};
  vehicle.contacts = {IcyWorld::contact("rubber", "ice", 0.3), IcyWorld::contact("ice", "any", 0.1)};
  EXPECT_EQ(world.error_of(vehicle), "none");
  vehicle.contacts = {IcyWorld::contact("default", "any", 0.3)};
  EXPECT_THAT(world.error_of(vehicle),
              testing::EndsWith("vehicle 'r1': its contact between 'default' and 'any' would change the surfaces of "
                                "others: it must name a new material"));
}

TEST(Surfaces, AreLimitedInNumber) {
  IcyWorld world;
  sim::VehicleConfig vehicle;
  for (int i = 0; i < 198; ++i) {
    sim::MaterialConfig material;
    material.name = "m" + std::to_string(i);
    vehicle.materials.push_back(material);
  }
  EXPECT_EQ(world.error_of(vehicle), "none");  // 200 with default and ice
  vehicle.materials.push_back(vehicle.materials.back());
  vehicle.materials.back().name = "one_more";
  EXPECT_THAT(world.error_of(vehicle), testing::HasSubstr("200"));
}

TEST(Surfaces, WhatWasAddedIsNoLongerNew) {
  IcyWorld world;
  sim::VehicleConfig vehicle;
  sim::MaterialConfig rubber;
  rubber.name = "rubber";
  vehicle.materials = {rubber};
  vehicle.contacts = {IcyWorld::contact("rubber", "any", 0.9)};
  vehicle.categories = {"glass"};
  ASSERT_TRUE(world.surfaces.has_new(vehicle));
  world.surfaces.add(vehicle);
  EXPECT_FALSE(world.surfaces.has_new(vehicle));
}

}  // namespace
