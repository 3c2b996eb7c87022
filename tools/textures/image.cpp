#include "tools/textures/image.h"

#include <climits>
#include <cstdint>
#include <memory>

// Static, so that another program part may have its own copy of stb.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#include <stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include "common/errors.h"
#include "scenes/io/atomic_file.h"
#include "scenes/io/read_bytes.h"

namespace flowskin::tools {
namespace {

constexpr int kLargestEdge = 16384;  ///< pixels; the largest that graphics hardware takes
/// Deflate packs 1032 bytes into one, and a byte holds eight pixels at most; no format that is read packs better. More
/// are asked for by damaged files only, which would fill the memory.
constexpr std::uint64_t kMostPixelsPerByte = 8 * 1032;
constexpr int kDefaultTextureSize = 1024;

void append(void* text, void* data, int size) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string bytes = scenes::read_bytes(file);
  if (bytes.size() > INT_MAX) throw InputError(name + ": too large for an image");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0)
    throw InputError(name + ": no image that can be read (expected PNG, JPEG, BMP or TGA)");
  if (width < 1 || height < 1 || width > kLargestEdge || height > kLargestEdge)
    throw InputError(name + ": " + std::to_string(width) + " x " + std::to_string(height) + " pixels; at most " +
                     std::to_string(kLargestEdge) + " are possible in each direction");
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > kMostPixelsPerByte * bytes.size())
    throw InputError(name + ": the image is damaged (" + std::to_string(bytes.size()) + " bytes cannot hold " +
                     std::to_string(width) + " x " + std::to_string(height) + " pixels)");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
  if (!pixels) throw InputError(name + ": the image is damaged (" + stbi_failure_reason() + ")");

  Image image{width, height, std::vector<Color>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    // What is transparent shows white: what colour lies beneath is anyone's guess.
    const int alpha = pixels.get()[4 * i + 3];
    for (std::size_t k = 0; k < 3; ++k)
      image.pixels[i][k] =
          static_cast<std::uint8_t>((pixels.get()[4 * i + k] * alpha + 255 * (255 - alpha) + 127) / 255);
  }
  return image;
}

void write_png(const std::filesystem::path& file, const Image& image) {
  static_assert(sizeof(Color) == 3, "pixels are handed over as packed bytes");
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw RunError("cannot write " + file.string() + ": the image has " + std::to_string(image.pixels.size()) +
                   " pixels instead of " + std::to_string(image.width) + " x " + std::to_string(image.height));
  std::string png;
  if (stbi_write_png_to_func(&append, &png, image.width, image.height, 3, image.pixels.data(), 3 * image.width) == 0)
    throw RunError("cannot write " + file.string() + ": the image could not be compressed (out of memory)");
  scenes::write_file(file, png);
}

Image make_texture(const std::string& name, const std::filesystem::path& directory) {
  if (name == "checker") return checker_texture(kDefaultTextureSize);
  if (name == "marble") return marble_texture(kDefaultTextureSize, 1);
  try {
    return read_image(directory / name);
  } catch (const InputError& error) {
    throw InputError("texture \"" + name + "\": " + error.what() +
                     "; expected \"checker\", \"marble\" or an image file");
  }
}

}  // namespace flowskin::tools
