// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converters/surfaces.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;
using test::CdrReader;
using test::converted;
using testing::ElementsAre;
using testing::SizeIs;

Marker marker(MarkerType type, const sim::Vector3d& scale) {
  Marker made;
  made.type = type;
  made.scale = scale;
  made.rgba = {1, 0.5F, 0, 1};
  return made;
}

std::vector<Eigen::Vector3d> positions_of(const Marker& on, std::size_t count) {
  std::vector<SurfacePoint> points;
  add_surface_points(on, count, points);
  std::vector<Eigen::Vector3d> positions;
  for (const SurfacePoint& point : points)
    positions.emplace_back(point.position_m[0], point.position_m[1], point.position_m[2]);
  return positions;
}

TEST(Surfaces, OfAShapeHaveItsArea) {
  using std::numbers::pi;
  EXPECT_DOUBLE_EQ(surface_area_m2(marker(MarkerType::cube, {1, 2, 3})), 22);
  EXPECT_DOUBLE_EQ(surface_area_m2(marker(MarkerType::sphere, {2, 2, 2})), 4 * pi);
  EXPECT_DOUBLE_EQ(surface_area_m2(marker(MarkerType::cylinder, {2, 2, 3})), 2 * pi * 3 + 2 * pi);
  Marker triangle = marker(MarkerType::triangle_list, {1, 1, 1});
  triangle.points_m = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  EXPECT_DOUBLE_EQ(surface_area_m2(triangle), 6);
  EXPECT_EQ(surface_area_m2(marker(MarkerType::line_strip, {1, 1, 1})), 0);
}

// Even points have the mean of the surface; of 1000, the sequence is off by far less than the 1 in 32 of random ones.
TEST(Surfaces, PointsAreOnTheShapeAndEven) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : positions_of(marker(MarkerType::sphere, {4, 4, 4}), 1000)) {
    EXPECT_NEAR(p.norm(), 2, 1e-6);
    mean += p / 1000;
  }
  EXPECT_LT(mean.norm(), 0.02);
  int on_top = 0;
  for (const Eigen::Vector3d& p : positions_of(marker(MarkerType::cube, {1, 2, 4}), 1000)) {
    EXPECT_NEAR((2 * p.cwiseAbs() - Eigen::Vector3d(1, 2, 4)).maxCoeff(), 0, 1e-6);
    on_top += p.z() > 2 - 1e-6;
  }
  EXPECT_NEAR(on_top, 1000 * 2.0 / 28, 1);  // the share of its area
  for (const Eigen::Vector3d& p : positions_of(marker(MarkerType::cylinder, {2, 2, 3}), 300)) {
    const double radius = p.head<2>().norm();
    EXPECT_TRUE(std::abs(radius - 1) < 1e-6 || (radius < 1 && std::abs(std::abs(p.z()) - 1.5) < 1e-6)) << p;
  }
  Marker triangles = marker(MarkerType::triangle_list, {1, 1, 1});
  triangles.points_m = {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}};  // the second has no area
  for (const Eigen::Vector3d& p : positions_of(triangles, 100)) {
    EXPECT_EQ(p.z(), 5);
    EXPECT_TRUE(p.x() >= 0 && p.y() >= 0 && p.x() + p.y() <= 1 + 1e-6) << p;
  }
  EXPECT_THAT(positions_of(marker(MarkerType::line_strip, {1, 1, 1}), 10), SizeIs(0));
}

struct Cloud {
  std::string frame;
  std::vector<std::array<float, 3>> points_m;
  std::vector<std::uint32_t> colors;
};

std::optional<Cloud> cloud_of(std::optional<CdrReader> in) {
  if (!in) return std::nullopt;
  Cloud cloud;
  in->skip<std::int32_t>(1);
  in->skip<std::uint32_t>(1);
  cloud.frame = in->text();
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);  // row
  const auto width = in->number<std::uint32_t>();
  const auto fields = in->number<std::uint32_t>();
  std::string names;
  for (std::uint32_t i = 0; i < fields; ++i) {
    names += in->text() + " ";
    in->skip<std::uint32_t>(1);
    in->skip<std::uint8_t>(1);
    in->skip<std::uint32_t>(1);
  }
  EXPECT_EQ(names, "x y z rgb ");
  in->skip<std::uint8_t>(1);
  in->skip<std::uint32_t>(3);
  for (std::uint32_t i = 0; i < width; ++i) {
    cloud.points_m.push_back({});
    for (float& each : cloud.points_m.back()) each = in->number<float>();
    cloud.colors.push_back(in->number<std::uint32_t>());
  }
  in->skip<std::uint8_t>(1);
  EXPECT_TRUE(in->at_end());
  return cloud;
}

/// A ball of 1 m that moves, and a fixed box of the size of the message of an asset.
struct Surfaced : testing::Test {
  Surfaced() {
    scene.revision = 3;
    scene.scene = R"({"bodies":[
      {"id":7,"name":"ball","owner":"","fixed":false,"pose":[0,0,0,1,0,0,0],"parts":[
        {"shape":"sphere","radius_m":1,"pose":[0,0,2,1,0,0,0],"color":"#ff8000"}]},
      {"id":1,"name":"wall","owner":"","fixed":true,"pose":[5,0,0,1,0,0,0],"parts":[
        {"shape":"box","size_m":[0.5,0.5,0.5],"pose":[1,0,0,1,0,0,0],"color":"#204060"},
        {"shape":"mesh","asset":"abc","pose":[0,0,0,1,0,0,0]}]}]})";
    EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));
  }
  std::optional<Cloud> at(double time_s, const std::string& topic = "/surfaces", double x_m = 10) {
    shoal::sim_bodies_t bodies{};
    bodies.utime = static_cast<std::int64_t>(1e6 * time_s);
    bodies.revision = 3;
    bodies.count = 1;
    bodies.body = {7};
    bodies.position_m = {{x_m, 0, 0}};
    const float half = std::sqrt(0.5F);
    bodies.orientation = {{half, half, 0, 0}};  // turned by 90 degrees about x: z is -y
    return cloud_of(converted(bodies, topic, "sim.bodies", &context));
  }
  shoal::sim_scene_t scene{};
  ConverterContext context;
};

TEST_F(Surfaced, OfBodiesThatMoveAreWhereTheBodiesAre) {
  const auto cloud = at(1);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->frame, "world");
  EXPECT_THAT(cloud->points_m, SizeIs(150));
  // Each number is rounded to 1/256 m.
  for (const auto& p : cloud->points_m) EXPECT_NEAR(std::hypot(p[0] - 10, p[1] + 2, p[2]), 1, std::sqrt(3.0) / 512);
  EXPECT_THAT(cloud->colors, testing::Each(0xff8000u));
}

TEST_F(Surfaced, OfBodiesThatMoveComeOnceASecondAlsoAfterARewind) {
  EXPECT_TRUE(at(1));
  EXPECT_FALSE(at(1.9));
  EXPECT_TRUE(at(2));
  EXPECT_TRUE(at(0.5));
  EXPECT_FALSE(at(1.4));
}

TEST_F(Surfaced, OfFixedBodiesComeOnceAndAgainWithAnAsset) {
  const auto cloud = at(1, "/surfaces_fixed");
  ASSERT_TRUE(cloud);
  EXPECT_THAT(cloud->points_m, SizeIs(20'000));
  for (const auto& p : cloud->points_m) EXPECT_NEAR(p[0], 6, 0.2501);
  EXPECT_THAT(cloud->colors, testing::Each(0x204060u));
  EXPECT_FALSE(converted(scene, "/tf", "sim.scene", &context));  // repeated for those who come late
  EXPECT_FALSE(at(2, "/surfaces_fixed"));

  shoal::sim_asset_t asset{};
  asset.hash = "abc";
  const std::array<std::uint32_t, 3> head{1, 3, 1}, triangle{0, 1, 2};
  const std::array<float, 9> corners{0, 0, 50, 1, 0, 50, 0, 1, 50};
  const auto append = [&](const auto& values) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    asset.data.insert(asset.data.end(), bytes, bytes + sizeof values);
  };
  append(head);
  append(corners);
  append(triangle);
  asset.size = static_cast<std::int32_t>(asset.data.size());
  EXPECT_FALSE(converted(asset, "/tf", "sim.asset", &context));
  const auto more = at(3, "/surfaces_fixed");
  ASSERT_TRUE(more);
  EXPECT_THAT(more->points_m, testing::Contains(testing::ElementsAre(testing::_, testing::_, 50)));
}

}  // namespace
