#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/errors.h"
#include "tools/render/color.h"
#include "tools/render/labels.h"
#include "tools/render/video.h"

namespace flowskin::tools {
namespace {

constexpr Color kBackground{255, 255, 255}, kSheetInk{52, 56, 64};

// Which source pixels a target pixel covers, and how much of each.
struct Span {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Span> area_spans(int from, int to) {
  std::vector<Span> spans(static_cast<std::size_t>(to));
  const double ratio = double(from) / to;
  for (int k = 0; k < to; ++k) {
    const double begin = k * ratio, end = (k + 1) * ratio;
    Span& span = spans[std::size_t(k)];
    span.first = std::min(int(begin), from - 1);
    for (int i = span.first; i < from && i < end; ++i) {
      span.weights.push_back(float((std::min(end, i + 1.0) - std::max(begin, double(i))) / ratio));
    }
  }
  return spans;
}

// Scales by averaging the area that each pixel covers, in linear light: nothing flickers, nothing gets darker.
Image scaled(const Image& image, int width, int height) {
  const std::vector<Span> columns = area_spans(image.width, width), rows = area_spans(image.height, height);
  std::vector<Vec3f> narrow(std::size_t(width) * std::size_t(image.height), Vec3f::Zero());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Span& span = columns[std::size_t(x)];
      Vec3f& sum = narrow[std::size_t(y) * std::size_t(width) + std::size_t(x)];
      for (std::size_t i = 0; i < span.weights.size(); ++i) {
        sum += span.weights[i] * to_linear(image.at(span.first + int(i), y));
      }
    }
  }
  Image result{width, height, std::vector<Color>(std::size_t(width) * std::size_t(height))};
  for (int y = 0; y < height; ++y) {
    const Span& span = rows[std::size_t(y)];
    for (int x = 0; x < width; ++x) {
      Vec3f sum = Vec3f::Zero();
      for (std::size_t i = 0; i < span.weights.size(); ++i) {
        sum += span.weights[i] * narrow[(std::size_t(span.first) + i) * std::size_t(width) + std::size_t(x)];
      }
      result.at(x, y) = to_srgb(sum);
    }
  }
  return result;
}

void check(const std::vector<std::vector<Image>>& rows, int picture_width) {
  if (rows.empty() || rows.front().empty() || picture_width < 1) {
    throw InputError("a contact sheet needs at least one picture, at least one pixel wide");
  }
  const Image& first = rows.front().front();
  for (const auto& row : rows) {
    for (const Image& image : row) {
      if (image.width != first.width || image.height != first.height || image.width < 1 || image.height < 1) {
        throw InputError(
            fmt::format("the pictures of a contact sheet must be equally large: {} x {} and {} x {} pixels",
                        first.width, first.height, image.width, image.height));
      }
    }
  }
}

void paste(Image& sheet, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    std::copy_n(&picture.at(0, y), picture.width, &sheet.at(left, top + y));
  }
}

}  // namespace

Image contact_sheet(const std::vector<std::vector<Image>>& rows, const std::vector<std::string>& row_labels,
                    const std::vector<std::string>& column_labels, int picture_width) {
  check(rows, picture_width);
  const Image& first = rows.front().front();
  std::size_t columns = 0;
  for (const auto& row : rows) columns = std::max(columns, row.size());
  const int picture_height = std::max(1, int(std::lround(double(picture_width) * first.height / first.width)));
  const int text = std::max(7, picture_width / 20), gap = std::max(2, picture_width / 80);
  const int left = row_labels.empty() ? gap : 3 * text, top = column_labels.empty() ? gap : 3 * text;

  Image sheet;
  sheet.width = left + int(columns) * (picture_width + gap);
  sheet.height = top + int(rows.size()) * (picture_height + gap);
  sheet.pixels.assign(std::size_t(sheet.width) * std::size_t(sheet.height), kBackground);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int y = top + int(r) * (picture_height + gap);
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      paste(sheet, scaled(rows[r][c], picture_width, picture_height), left + int(c) * (picture_width + gap), y);
    }
    if (r >= row_labels.size()) continue;
    // Along the left edge, read upwards; made smaller where it is longer than the picture is high.
    const double size = std::min(double(text), text * picture_height / std::max(1.0, text_width(row_labels[r], text)));
    draw_text(sheet, 2.0 * text, y + 0.5 * (picture_height + text_width(row_labels[r], size)), size, row_labels[r],
              kSheetInk, TextDirection::up);
  }
  for (std::size_t c = 0; c < std::min(columns, column_labels.size()); ++c) {
    const double size =
        std::min(double(text), text * picture_width / std::max(1.0, text_width(column_labels[c], text)));
    const double middle = left + double(c) * (picture_width + gap) + 0.5 * picture_width;
    draw_text(sheet, middle - 0.5 * text_width(column_labels[c], size), 2.0 * text, size, column_labels[c], kSheetInk);
  }
  return sheet;
}

}  // namespace flowskin::tools
