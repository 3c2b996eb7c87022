// Labels on pictures: a small font of strokes with round ends, smooth at any size.
#pragma once

#include <string>

#include "tools/textures/image.h"

namespace flowskin::tools {

enum class TextDirection { right, up };

/// Length of a line of text (pixels) in capitals `height` pixels tall. Characters outside of ASCII are drawn as a box.
double text_width(const std::string& text, double height);

/// Draws a line of text that starts at (x, y), its base line's left end, in pixels from the top left corner. What lies
/// outside of the image is left out.
void draw_text(Image& image, double x, double y, double height, const std::string& text, const Color& color,
               TextDirection direction = TextDirection::right);

}  // namespace flowskin::tools
