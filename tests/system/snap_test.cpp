// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "sim/image/image_file.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;

Ended snap(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "snap");
  return run_shoal(arguments);
}

TEST(Snap, MakesTheImageItMadeBefore) {
  const ScratchFolder folder;
  const Ended ended = snap({source("tests/golden/yard.yaml"), "--eye=-4,-5,3", "--look", "0.5,0,0.4", "--size",
                            "320x240", "--out", folder.file("yard.png")});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const sim::Image8 golden = sim::read_image(source("tests/golden/yard.png"));
  const sim::Image8 now = sim::read_image(folder.file("yard.png"));
  ASSERT_EQ(now.width, golden.width);
  ASSERT_EQ(now.height, golden.height);
  double sum = 0;
  int other = 0;
  for (std::size_t i = 0; i < now.data.size(); ++i) {
    const int difference = std::abs(now.data[i] - golden.data[i]);
    sum += difference;
    other += difference > 16;
  }
  // Another library of rays moves edges by less than a pixel, another C library turns the last bit of a level.
  EXPECT_LT(sum / static_cast<double>(now.data.size()), 0.5) << "see tests/golden/yard.yaml";
  EXPECT_LT(other / static_cast<double>(now.data.size()), 0.01) << "see tests/golden/yard.yaml";
}

TEST(Snap, TakesImagesOfEveryKind) {
  const ScratchFolder folder;
  const std::string world = source("worlds/proving_ground.yaml");
  for (const char* image : {"rgb", "grey", "depth", "segmentation_parts", "segmentation_vehicles"}) {
    const Ended ended = snap({world, "--image", image, "--size", "80x60", "--out", folder.file("a.png")});
    EXPECT_EQ(ended.exit_code, 0) << image << ended.errors;
    EXPECT_EQ(sim::read_image(folder.file("a.png")).width, 80) << image;
  }
  for (const char* shapes : {"drawn", "collision", "wire"}) {
    const Ended ended = snap({world, "--shapes", shapes, "--overlay", "rays", "--at", "0.3", "--size", "80x60", "--out",
                              folder.file("s.png")});
    EXPECT_EQ(ended.exit_code, 0) << shapes << ended.errors;
  }
  const Ended from = snap({world, "--from", "turntable.camera", "--at", "0.5", "--out", folder.file("b.jpg")});
  EXPECT_THAT(from.output, HasSubstr("64x48"));
  EXPECT_THAT(from.output, HasSubstr("at 0.500 s from turntable.camera"));
  const Ended down =
      snap({world, "--eye", "0,0,9", "--look", "0,0,0", "--size", "40x30", "--out", folder.file("c.png")});
  EXPECT_EQ(down.exit_code, 0) << down.errors;
}

TEST(Snap, TakesOneImageAfterTheOther) {
  const ScratchFolder folder;
  const Ended ended = snap({source("worlds/minimal.yaml"), "--at", "0.1", "--every", "0.1", "--until", "0.3", "--size",
                            "40x30", "--out", folder.file("film.png")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  for (const char* name : {"film_0000.png", "film_0001.png", "film_0002.png"})
    EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
  EXPECT_FALSE(std::filesystem::exists(folder.file("film_0003.png")));
}

TEST(Snap, SaysWhatIsWrong) {
  const ScratchFolder folder;
  const std::string world = source("worlds/proving_ground.yaml"), out = folder.file("a.png");
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{world}, "--out is required"},
      {{world, "--out", folder.file("a.gif")}, "must end in .png, .jpg or .jpeg"},
      {{world, "--out", out, "--from", "p1.eye"}, "there is no camera 'p1.eye'; there are: turntable.camera"},
      {{source("worlds/minimal.yaml"), "--out", out, "--from", "p1.eye"}, "this world has none, see --eye"},
      {{world, "--out", out, "--at", "-1"}, "--at: must be from 0"},
      {{world, "--out", out, "--at", "nan"}, "--at: must be from 0"},
      {{world, "--out", out, "--eye", "1,2,3"}, "--look"},
      {{world, "--out", out, "--eye", "1,2,3", "--look", "1,2,3"}, "must not be the point of --eye"},
      {{world, "--out", out, "--eye", "1,2", "--look", "1,2,3"}, "--eye: must be three numbers"},
      {{world, "--out", out, "--eye", "1,2,inf", "--look", "1,2,3"}, "--eye: must be three numbers"},
      {{world, "--out", out, "--eye", "1,2,3x", "--look", "1,2,3"}, "--eye: must be three numbers"},
      {{world, "--out", out, "--size", "0x10"}, "--size: must be 1 to 8192 pixels a side, got '0x10'"},
      {{world, "--out", out, "--size", "8000x8000"}, "more than 64000000 rays"},
      {{world, "--out", out, "--fov", "180"}, "--fov: must be from 1 to 170"},
      {{world, "--out", out, "--every", "1"}, "--until"},
      {{world, "--out", out, "--at", "3", "--every", "1", "--until", "2"}, "--until: must not be before --at"},
      {{world, "--out", out, "--image", "heat"}, "--image"},
      {{world, "--out", out, "--overlay", "beams"}, "must be trails, paths, ellipses, pings, rays, labels and clock"},
      {{world, "--out", out, "--shapes", "round"}, "--shapes"},
      {{world, "--out", out, "--shapes", "wire", "--image", "depth"}, "--shapes: must be drawn for an image without"},
      {{"nothing.yaml", "--out", out}, "nothing.yaml"}};
  for (const auto& [arguments, error] : wrong) {
    const Ended ended = snap(arguments);
    EXPECT_EQ(ended.exit_code, 2) << error;
    EXPECT_THAT(ended.errors, HasSubstr(error));
  }
  const Ended unwritable = snap({world, "--size", "40x30", "--out", folder.file("no/such/folder.png")});
  EXPECT_EQ(unwritable.exit_code, 4);
  EXPECT_THAT(unwritable.errors, HasSubstr("folder.png: cannot be written"));
}

TEST(Check, FindsATextureThatIsNoImage) {
  const ScratchFolder folder;
  write_file(folder.file("t.png"), "no image");
  write_file(folder.file("w.yaml"),
             "shoal: 1\nmaterials:\n  - {name: poster, texture: {pattern: image, file: t.png}}\n");
  const Ended ended = run_shoal({"check", folder.file("w.yaml")});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("w.yaml:3:29: material 'poster': texture '"));
  EXPECT_THAT(ended.errors, HasSubstr("neither PNG nor JPEG"));
}

}  // namespace
