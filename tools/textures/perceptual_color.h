// Colours chosen by lightness, chroma and hue as the eye sees them.
#pragma once

#include "tools/frame_data.h"

namespace flowskin::tools {

/// Linear light, 0 to 1 per channel, of a colour in OKLCh [B. Ottosson, "A perceptual color space for image
/// processing", 2020]: lightness 0 to 1, chroma about 0 to 0.3, hue in turns. Channels outside the gamut are clamped.
Vec3 linear_from_oklch(double lightness, double chroma, double hue);

/// sRGB code values of linear light; clamped to 0 to 255.
Color encode_srgb(const Vec3& linear);

}  // namespace flowskin::tools
