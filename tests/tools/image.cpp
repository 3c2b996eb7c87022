#include "tools/textures/image.h"

#include "common/errors.h"
#include "tests/tools/io_fixture.h"
#include "tools/textures/perceptual_color.h"
#include "tools/textures/stroke_font.h"

namespace flowskin::tools::image_test {
namespace {

class ImageTest : public IoTest {};

Image sample_image(int width, int height) {
  Image image{width, height, std::vector<Color>(static_cast<std::size_t>(width * height))};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(11 * y),
                        static_cast<std::uint8_t>(x * y)};
  return image;
}

TEST_F(ImageTest, PngComesBack) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(37, 19), std::pair(256, 3)}) {
    const Image image = sample_image(width, height);
    write_png(path("a.png"), image);
    const Image read = read_image(path("a.png"));
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, height);
    EXPECT_EQ(read.pixels, image.pixels);
  }
}

TEST_F(ImageTest, PngIsWellFormed) {
  write_png(path("a.png"), sample_image(37, 19));
  const std::string png = read_text(path("a.png"));
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(12, 4), "IHDR");
  EXPECT_EQ(static_cast<int>(png[19]), 37);
  EXPECT_EQ(static_cast<int>(png[23]), 19);
  EXPECT_EQ(png.substr(24, 2), "\x08\x02") << "8 bits per channel, RGB";
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
}

TEST_F(ImageTest, TransparentPixelsShowWhite) {
  // A TGA by hand: 2 by 1 pixels of 32 bits (blue, green, red, alpha), top row first.
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = 2;
  tga[14] = 1;
  tga[16] = 32;
  tga[17] = 0x28;
  tga += std::string("\x00\x00\xff\x00\x00\x00\xff\xff", 8);
  const Image image = read_image(write_text("a.tga", tga));
  EXPECT_EQ(image.at(0, 0), (Color{255, 255, 255}));
  EXPECT_EQ(image.at(1, 0), (Color{255, 0, 0}));
}

TEST_F(ImageTest, SaysWhatIsWrongWithAFile) {
  EXPECT_NE(message_of<InputError>([&] { read_image(path("none.png")); }).find("no such file"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_image(folder_); }).find("folder"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_image(write_text("e.png", "")); }).find("no image"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_image(write_text("t.png", "P6 text")); }).find("expected PNG"),
            std::string::npos);
  write_png(path("a.png"), sample_image(37, 19));
  const std::string png = read_text(path("a.png"));
  message_of<InputError>([&] { read_image(write_text("cut.png", png.substr(0, png.size() / 2))); });
  std::string huge = png;  // promises 2^24 pixels per row
  huge[16] = 1;
  EXPECT_THROW(read_image(write_text("huge.png", huge)), InputError);
  message_of<RunError>([&] { write_png(path("b.png"), Image{3, 3, std::vector<Color>(8)}); });
  message_of<RunError>([&] { write_png(path("b.png"), Image()); });
  EXPECT_FALSE(std::filesystem::exists(path("b.png")));
}

TEST_F(ImageTest, AHeadAloneTakesNoMemory) {
  std::string tga(18, '\0');
  tga[2] = 10;  // runs of pixels
  tga[13] = tga[15] = 0x40;
  tga[16] = 24;
  const std::string message = message_of<InputError>([&] { read_image(write_text("a.tga", tga + "1234")); });
  EXPECT_NE(message.find("22 bytes cannot hold 16384 x 16384 pixels"), std::string::npos) << message;
  // The densest that there is: all white, a byte for up to 1032 pixels.
  write_png(path("white.png"), Image{2048, 2048, std::vector<Color>(2048 * 2048, Color{255, 255, 255})});
  EXPECT_EQ(read_image(path("white.png")).at(2047, 2047), (Color{255, 255, 255}));
}

TEST_F(ImageTest, TexturesByName) {
  EXPECT_EQ(make_texture("checker", folder_).pixels, checker_texture(1024).pixels);
  EXPECT_EQ(make_texture("marble", folder_).pixels, marble_texture(1024, 1).pixels);
  write_png(path("mine.png"), sample_image(5, 4));
  EXPECT_EQ(make_texture("mine.png", folder_).pixels, sample_image(5, 4).pixels);
  EXPECT_EQ(make_texture(path("mine.png").string(), "/elsewhere").pixels, sample_image(5, 4).pixels);
  const std::string message = message_of<InputError>([&] { make_texture("cheker", folder_); });
  EXPECT_NE(message.find("\"checker\", \"marble\" or an image file"), std::string::npos) << message;
}

/// Largest difference of a channel between neighbours along the lines given, across the tile's edge or inside.
int largest_step(const Image& image, bool across_edge) {
  int largest = 0;
  const auto compare = [&largest](const Color& a, const Color& b) {
    for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  };
  const int n = image.width;
  for (int i = 0; i < n; ++i) {
    if (across_edge) {
      compare(image.at(n - 1, i), image.at(0, i));
      compare(image.at(i, n - 1), image.at(i, 0));
    } else {
      for (int k = 1; k < n; ++k) {
        compare(image.at(k - 1, i), image.at(k, i));
        compare(image.at(i, k - 1), image.at(i, k));
      }
    }
  }
  return largest;
}

TEST(MarbleTexture, GoesOnAcrossItsEdges) {
  for (const unsigned seed : {1U, 2U, 77U}) {
    const Image marble = marble_texture(256, seed);
    EXPECT_LE(largest_step(marble, true), largest_step(marble, false)) << seed;
  }
}

TEST(MarbleTexture, IsLightWithDarkVeinsAndFollowsItsSeed) {
  const Image marble = marble_texture(256, 1);
  EXPECT_EQ(marble.pixels, marble_texture(256, 1).pixels);
  EXPECT_NE(marble.pixels, marble_texture(256, 2).pixels);
  double sum = 0;
  int darkest = 255;
  for (const Color& color : marble.pixels) {
    sum += color[1];
    darkest = std::min<int>(darkest, color[1]);
  }
  EXPECT_GT(sum / static_cast<double>(marble.pixels.size()), 200);
  EXPECT_LT(darkest, 110);
}

TEST(CheckerTexture, TilesWithWhiteLinesOfOneWidth) {
  const Image checker = checker_texture(512);
  // The line between two tiles is as wide as the line between two cells inside.
  for (int y = 0; y < 512; ++y) {
    EXPECT_EQ(checker.at(0, y)[1] > 200, checker.at(64, y)[1] > 200) << y;
    EXPECT_EQ(checker.at(511, y)[1] > 200, checker.at(447, y)[1] > 200) << y;
  }
}

TEST(CheckerTexture, NoTwoCellsAreAlikeAndNeighboursAlternate) {
  const Image checker = checker_texture(512);
  std::map<Color, int> fills;
  const auto fill = [&checker](int column, int row) { return checker.at(64 * column + 6, 511 - (64 * row + 6)); };
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column) {
      ++fills[fill(column, row)];
      const auto brightness = [&](int c, int r) {
        return 0.3 * fill(c, r)[0] + 0.6 * fill(c, r)[1] + 0.1 * fill(c, r)[2];
      };
      const double here = brightness(column, row), right = brightness((column + 1) % 8, row),
                   above = brightness(column, (row + 1) % 8);
      const bool is_light = (column + row) % 2 == 0;
      EXPECT_GT(is_light ? here - right : right - here, 25) << column << ' ' << row;
      EXPECT_GT(is_light ? here - above : above - here, 25) << column << ' ' << row;
    }
  EXPECT_GE(fills.size(), 56U);
}

/// Share of the pixels in a rectangle of cell (column, row) that differ from the cell's fill; the rectangle is given in
/// cells, y up.
double ink(const Image& image, int column, int row, double left, double right, double bottom, double top) {
  const double cell = image.width / 8.0;
  const Color fill =
      image.at(static_cast<int>(cell * (column + 0.06)), image.height - 1 - static_cast<int>(cell * (row + 0.06)));
  int total = 0, inked = 0;
  for (double y = bottom; y < top; y += 1 / cell)
    for (double x = left; x < right; x += 1 / cell, ++total) {
      const Color& pixel =
          image.at(static_cast<int>(cell * (column + x)), image.height - 1 - static_cast<int>(cell * (row + y)));
      inked += std::abs(pixel[1] - fill[1]) > 30 ? 1 : 0;
    }
  return static_cast<double>(inked) / total;
}

TEST(CheckerTexture, LabelsStandUprightAndUnmirrored) {
  const Image checker = checker_texture(1024);
  // E (row 4) has its stem on the left: the letter's left edge is full, its right side open. F (row 5) is dark above
  // only.
  EXPECT_GT(ink(checker, 0, 4, 0.17, 0.24, 0.32, 0.68), 0.6);
  EXPECT_LT(ink(checker, 0, 4, 0.30, 0.36, 0.35, 0.45), 0.3);
  EXPECT_GT(ink(checker, 0, 5, 0.28, 0.40, 0.65, 0.74), 3 * ink(checker, 0, 5, 0.28, 0.40, 0.26, 0.35));
  // 7 (column 6): a bar above, open below on the right.
  EXPECT_GT(ink(checker, 6, 0, 0.58, 0.80, 0.65, 0.74), 3 * ink(checker, 6, 0, 0.78, 0.88, 0.26, 0.40));
}

TEST(StrokeFont, HasTheGlyphsOfTheGridOnly) {
  for (const char character : std::string("ABCDEFGH12345678")) {
    const StrokeGlyph glyph = stroke_glyph(character);
    ASSERT_FALSE(glyph.segments.empty()) << character;
    for (const auto& segment : glyph.segments)
      for (const Vec2f& point : {segment.from, segment.to}) {
        EXPECT_GE(point.minCoeff(), -0.02F) << character;
        EXPECT_LE(point.x(), glyph.width + 0.02F) << character;
        EXPECT_LE(point.y(), 1.02F) << character;
        EXPECT_LT(glyph.distance(point), 1e-6F);
      }
  }
  EXPECT_TRUE(stroke_glyph('Z').segments.empty());
  EXPECT_TRUE(stroke_glyph('9').segments.empty());
}

TEST(PerceptualColor, KnownColours) {
  EXPECT_EQ(encode_srgb(linear_from_oklch(1, 0, 0)), (Color{255, 255, 255}));
  EXPECT_EQ(encode_srgb(linear_from_oklch(0, 0, 0)), (Color{0, 0, 0}));
  // sRGB red in OKLCh: 0.62796, 0.25768, 29.234 degrees.
  const Color red = encode_srgb(linear_from_oklch(0.62796, 0.25768, 29.234 / 360));
  EXPECT_GE(red[0], 254);
  EXPECT_LE(red[1], 2);
  EXPECT_LE(red[2], 2);
  EXPECT_EQ(encode_srgb(Vec3(0.21404, 0.5, 7)), (Color{127, 188, 255}));
}

}  // namespace
}  // namespace flowskin::tools::image_test
