// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "viewer/film/overlay.hpp"

namespace tools {

// Options that snap and film share.

/// Size of an image in pixels.
struct ImageSize {
  int width = 0;
  int height = 0;
};

/// Parses `--size`, such as 1280x720.  Throws CLI::ValidationError.
ImageSize parse_image_size(const std::string& text);

/// Adds `--visibility M`.
void add_visibility_option(CLI::App& command, std::string& text);
/// Parses it: meters, or `none` for invisible water; 60 without it.  Throws CLI::ValidationError.
std::optional<double> parse_visibility(const std::string& text);

/// Adds `--overlay LIST`.
CLI::Option* add_overlay_option(CLI::App& command, std::string& text);
/// Parses it.  Throws CLI::ValidationError.
viewer::OverlayChoice parse_overlay_option(const std::string& text);

/// Adds `--shapes KIND`; `text` must be `drawn` before.
void add_shapes_option(CLI::App& command, std::string& text);
/// Returns the choice of a text that passed the check of the option.
viewer::BodyShapes parse_shapes(const std::string& text);

}  // namespace tools
