// Contact sheets and their labels.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/errors.h"
#include "tools/render/labels.h"
#include "tools/render/video.h"

namespace flowskin::tools::contact_sheet_test {
namespace {

constexpr Color white{255, 255, 255}, black{0, 0, 0};

Image flat(int width, int height, const Color& color) {
  return {width, height, std::vector<Color>(std::size_t(width) * std::size_t(height), color)};
}

// Number of pixels that are not white within [x0, x1) x [y0, y1).
int inked(const Image& image, int x0, int y0, int x1, int y1) {
  int count = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) count += image.at(x, y) != white;
  }
  return count;
}

TEST(ContactSheet, PicturesStandInOrderWithGaps) {
  // Six flat colours: the sheet's pixels that have each colour must form the expected rectangles.
  const std::vector<Color> colors{{200, 0, 0}, {0, 200, 0}, {0, 0, 200}, {200, 200, 0}, {0, 200, 200}, {200, 0, 200}};
  std::vector<std::vector<Image>> rows(2);
  for (std::size_t k = 0; k < 6; ++k) rows[k / 3].push_back(flat(320, 180, colors[k]));
  const Image sheet = contact_sheet(rows, {"surface", "particles"}, {"0 s", "1 s", "2 s"}, 160);
  std::array<std::array<int, 4>, 6> boxes;  // x0 y0 x1 y1
  for (std::size_t k = 0; k < 6; ++k) {
    boxes[k] = {sheet.width, sheet.height, -1, -1};
    int count = 0;
    for (int y = 0; y < sheet.height; ++y) {
      for (int x = 0; x < sheet.width; ++x) {
        if (sheet.at(x, y) != colors[k]) continue;
        ++count;
        boxes[k] = {std::min(boxes[k][0], x), std::min(boxes[k][1], y), std::max(boxes[k][2], x),
                    std::max(boxes[k][3], y)};
      }
    }
    EXPECT_EQ(count, 160 * 90);
    EXPECT_EQ(boxes[k][2] - boxes[k][0], 159);
    EXPECT_EQ(boxes[k][3] - boxes[k][1], 89);
  }
  const int gap = boxes[1][0] - boxes[0][2] - 1;
  EXPECT_GE(gap, 1);
  EXPECT_LE(gap, 8);
  EXPECT_EQ(boxes[2][0] - boxes[1][2] - 1, gap);
  EXPECT_EQ(boxes[3][1] - boxes[0][3] - 1, gap);
  EXPECT_EQ(boxes[3][0], boxes[0][0]);
  EXPECT_EQ(sheet.width, boxes[2][2] + 1 + gap);
  EXPECT_EQ(sheet.height, boxes[3][3] + 1 + gap);
  // Labels: above each column, left of each row, nothing in the corner.
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(inked(sheet, boxes[k][0], 0, boxes[k][2], boxes[k][1]), 20);
  for (const std::size_t k : {0u, 3u}) EXPECT_GT(inked(sheet, 0, boxes[k][1], boxes[k][0], boxes[k][3]), 20);
  EXPECT_EQ(inked(sheet, 0, 0, boxes[0][0], boxes[0][1]), 0);
}

TEST(ContactSheet, ScalesInLinearLight) {
  // One black and white pixel in turn: half the light, which is code 188 and not 128.
  Image stripes = flat(64, 64, black);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; x += 2) stripes.at(x, y) = white;
  }
  const Image sheet = contact_sheet({{stripes}}, {}, {}, 32);
  EXPECT_EQ(sheet.at(sheet.width / 2, sheet.height / 2), (Color{188, 188, 188}));
  // A size that does not divide, and a larger one.
  EXPECT_EQ(contact_sheet({{flat(64, 48, {9, 8, 7})}}, {}, {}, 27).at(15, 12), (Color{9, 8, 7}));
  EXPECT_EQ(contact_sheet({{flat(64, 48, {9, 8, 7})}}, {}, {}, 100).at(50, 40), (Color{9, 8, 7}));
}

TEST(ContactSheet, RowsMayBeShorter) {
  const Image picture = flat(16, 16, black);
  const Image sheet = contact_sheet({{picture, picture}, {picture}}, {}, {}, 16);
  EXPECT_EQ(inked(sheet, 0, 0, sheet.width, sheet.height), 3 * 256);
}

TEST(ContactSheet, UnequalOrNoPicturesAreRefused) {
  EXPECT_THROW(contact_sheet({}, {}, {}, 100), InputError);
  EXPECT_THROW(contact_sheet({{}}, {}, {}, 100), InputError);
  EXPECT_THROW(contact_sheet({{flat(4, 4, black), flat(5, 4, black)}}, {}, {}, 100), InputError);
  EXPECT_THROW(contact_sheet({{flat(4, 4, black)}}, {}, {}, 0), InputError);
}

TEST(Labels, StayWithinTheirMeasure) {
  const std::string text = "rigid-global 0.25 s";
  const double height = 14, width = text_width(text, height);
  EXPECT_NEAR(text_width(text, 2 * height), 2 * width, 1e-9);
  Image image = flat(400, 60, white);
  draw_text(image, 20, 40, height, text, black);
  const int right = int(20 + width) + 3;
  EXPECT_GT(inked(image, 18, 24, right, 47), 200);
  EXPECT_EQ(inked(image, 0, 0, 400, 60), inked(image, 18, 24, right, 47));
}

TEST(Labels, UpwardsIsTheSameTurned) {
  Image across = flat(100, 100, white), up = across;
  draw_text(across, 10, 60, 20, "Fig", black);
  draw_text(up, 60, 90, 20, "Fig", black, TextDirection::up);
  // (x, y) turns counter-clockwise to (y, 100 - x).
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) ASSERT_EQ(across.at(x, y), up.at(y, 99 - x)) << x << " " << y;
  }
}

TEST(Labels, TakeAnyBytesAndPlaces) {
  Image image = flat(30, 30, white);
  std::string all;
  for (int c = 1; c < 256; ++c) all.push_back(char(c));
  draw_text(image, -100, 20, 12, all, black);
  draw_text(image, 1e6, -1e6, 12, all, black);
  EXPECT_EQ(text_width("", 10), 0);
  EXPECT_NEAR(text_width("\u00e9", 10), text_width("@", 10), 1e-9);  // one box for a character of two bytes
}

TEST(Labels, LettersDiffer) {
  const std::string letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:;-_+=/()%#'\"!?<>*[]|~^\\{}";
  std::vector<std::vector<Color>> seen;
  for (const char letter : letters) {
    Image image = flat(40, 50, white);
    draw_text(image, 8, 36, 28, std::string(1, letter), black);
    for (const auto& other : seen) {
      // l, I and | differ in height or depth only; all others in more.
      EXPECT_NE(image.pixels, other) << letter;
    }
    if (letter != 'l' && letter != 'I' && letter != 'O') seen.push_back(image.pixels);
  }
}

}  // namespace
}  // namespace flowskin::tools::contact_sheet_test
