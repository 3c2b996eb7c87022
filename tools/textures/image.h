// Images: reading, writing, and the two textures that the project makes itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/frame_data.h"

namespace flowskin::tools {

/// Rows from top to bottom.
struct Image {
  int width = 0, height = 0;
  std::vector<Color> pixels;
  Color& at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
  const Color& at(int x, int y) const { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

/// @throws InputError where the file is missing or no image (PNG, JPEG, BMP, TGA).
Image read_image(const std::filesystem::path& file);
/// Whole or not at all. @throws RunError
void write_png(const std::filesystem::path& file, const Image& image);

/// A UV grid of coloured squares with numbers: shows stretch, shear and mirroring. Tiles.
Image checker_texture(int size);
/// Grey-white marble with dark veins. Tiles; the same for the same seed.
Image marble_texture(int size, unsigned seed);
/// "checker", "marble", or an image file.
Image make_texture(const std::string& name, const std::filesystem::path& directory);

}  // namespace flowskin::tools
