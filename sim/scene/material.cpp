// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/material.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace sim {

namespace {

constexpr ChoiceWords<TextureConfig::Pattern> pattern_words{{"none", TextureConfig::Pattern::none},
                                                            {"checker", TextureConfig::Pattern::checker},
                                                            {"stripes", TextureConfig::Pattern::stripes},
                                                            {"image", TextureConfig::Pattern::image}};

const std::pair<const char*, RayKind> ray_kinds[] = {
    {"light", RayKind::light}, {"laser", RayKind::laser}, {"sound", RayKind::sound}};

void check_color(ParamReader& in, const char* key, const std::string& color) {
  if (!parse_color(color)) in.error(key, std::string("'") + key + "' must look like #rrggbb, got '" + color + "'");
}

}  // namespace

void TextureConfig::read(ParamReader& in) {
  if (!in.describing()) {
    place = in.node()->place;
    if (place.file) directory = std::filesystem::path(*place.file).parent_path().string();
  }
  // Keys of the texture.
  in.read_choice("pattern", pattern, pattern_words, "pattern on the surface");
  in.read("colors", colors, "checker, stripes: two colors, #rrggbb");
  in.read("size_m", size_m, above(0), "length of a field, width of a stripe or of the image");
  const bool allowed = in.read_path("file", file, PathUse::read, "image: a PNG or JPEG file, relative to this file");
  if (in.describing()) return;
  // Check colors and the keys required by the pattern.
  for (const std::string& color : colors) check_color(in, "colors", color);
  std::error_code error;
  const auto path = std::filesystem::path(directory) / file;
  switch (pattern) {
    case Pattern::none:
      return;
    case Pattern::checker:
    case Pattern::stripes:
      if (colors.size() != 2)
        in.error("colors", "a " + std::string(word_of(pattern_words, pattern)) + " texture needs two 'colors', got " +
                               std::to_string(colors.size()));
      return;
    case Pattern::image:
      if (file.empty()) in.error("a texture of pattern image needs the key 'file'");
      if (allowed && !file.empty() && !std::filesystem::is_regular_file(path, error))
        in.error("file", "there is no file '" + path.string() + "'");
  }
}

void LaserSurface::read(ParamReader& in) {
  in.read("reflectivity", reflectivity, between(0, 1), "share of a laser's power that is reflected diffusely");
  in.read("gloss", gloss, between(0, 1), "specular share of it, which returns at normal incidence only");
}

void SoundSurface::read(ParamReader& in) {
  in.read("backscatter_dB", backscatter_dB, between(-80, 10), "backscatter at normal incidence (Lambert), dB");
}

void MaterialConfig::read(ParamReader& in) {
  in.require("name");
  in.read("name", name, "name of the material");
  // In contacts 'any' stands for every material.
  if (name == "any") in.error("name", "'any' stands for every material and cannot be a name");
  in.read("color", color, "color in images and viewers, #rrggbb; a part's own color has precedence");
  if (!in.describing() && !color.empty()) check_color(in, "color", color);
  in.read("gloss", gloss, between(0, 1), "strength of the sun's highlight in images");
  in.read("texture", texture, "pattern in images");
  in.read("laser", laser, "reflection of laser beams");
  in.read("sound", sound, "reflection of sound");
  in.read("transparent_to", transparent_to, "what passes through it: light, laser, sound");
  for (const std::string& word : transparent_to)
    if (!in.describing() &&
        std::none_of(std::begin(ray_kinds), std::end(ray_kinds), [&](const auto& kind) { return word == kind.first; }))
      in.error("transparent_to", "'transparent_to' must name light, laser or sound, got '" + word + "'");
}

std::uint8_t MaterialConfig::transmits() const {
  std::uint8_t bits = 0;
  for (const auto& [word, kind] : ray_kinds)
    if (std::find(transparent_to.begin(), transparent_to.end(), word) != transparent_to.end())
      bits |= static_cast<std::uint8_t>(kind);
  return bits;
}

}  // namespace sim
