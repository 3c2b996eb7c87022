#include "tools/render/film.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/render/color.h"

namespace flowskin::tools {

Film::Film(int width, int height)
    : width_(width), height_(height), pixels_(std::size_t(width) * std::size_t(height)), more_(std::size_t(height)) {}

bool Film::same_surface(const Sample& a, const Sample& b) {
  return a.object == b.object && (a.object == kNoObject || (a.normal.dot(b.normal) > 0.9f &&
                                                            std::abs(a.normal.dot(b.point - a.point)) < 3 * a.spacing));
}

void Film::add(Layer& layer, const Sample& sample) {
  if (layer.samples == 0) {
    layer.sum = sample;
  } else {
    layer.sum.reflectance += sample.reflectance;
    layer.sum.irradiance += sample.irradiance;
    layer.sum.extra += sample.extra;
    layer.sum.unlit += sample.unlit;
  }
  layer.samples += 1;
}

void Film::set_pixel(int x, int y, const std::vector<Sample>& samples) {
  constexpr std::size_t max_more = 3;
  Pixel& target = pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
  auto& more = more_[std::size_t(y)];
  const std::size_t begin = more.size();
  target.first = Layer();
  for (const Sample& sample : samples) {
    Layer* layer = &target.first;
    if (layer->samples > 0 && !same_surface(layer->sum, sample)) {
      auto found = std::find_if(more.begin() + std::ptrdiff_t(begin), more.end(),
                                [&](const Layer& other) { return same_surface(other.sum, sample); });
      if (found == more.end() && more.size() - begin < max_more) found = more.insert(more.end(), Layer());
      // With more surfaces in one pixel than that, nobody sees which is which.
      layer = found == more.end() ? &more.back() : &*found;
    }
    add(*layer, sample);
  }
  target.more_begin = std::uint32_t(begin);
  target.more_end = std::uint32_t(more.size());
}

Vec3f Film::smooth_irradiance(int x, int y, const Layer& layer) const {
  constexpr float share[5] = {0.5f, 1, 1, 1, 0.5f};
  const Sample& center = layer.sum;
  Vec3f sum = center.irradiance / layer.samples;
  float weights = 1;
  for (int j = std::max(0, y - 2); j <= std::min(height_ - 1, y + 2); ++j) {
    for (int i = std::max(0, x - 2); i <= std::min(width_ - 1, x + 2); ++i) {
      const Layer& other = pixel(i, j).first;
      if ((i == x && j == y) || other.sum.object != center.object) continue;
      const float cosine = center.normal.dot(other.sum.normal);
      const float off_plane = std::abs(center.normal.dot(other.sum.point - center.point)) / center.spacing;
      if (cosine < 0.8f || off_plane > 3) continue;
      // Full weight where normals agree to about 10 degrees, none from 37 degrees on.
      const float agreement = std::min(1.0f, (cosine - 0.8f) / 0.18f) * (off_plane < 1.5f ? 1 : 2 - off_plane / 1.5f);
      const float weight = agreement * share[i - x + 2] * share[j - y + 2];
      sum += weight / other.samples * other.sum.irradiance;
      weights += weight;
    }
  }
  return sum / weights;
}

Image Film::develop(bool smooth, float exposure) const {
  Image image;
  image.width = width_;
  image.height = height_;
  image.pixels.resize(pixels_.size());
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Pixel& source = pixel(x, y);
      Vec3f light = Vec3f::Zero(), unlit = Vec3f::Zero();
      float samples = 0, unlit_samples = 0;
      const auto collect = [&](const Layer& layer) {
        const Sample& sum = layer.sum;
        samples += layer.samples;
        light += sum.extra;
        unlit += sum.unlit;
        if (!sum.unlit.isZero(0)) unlit_samples += layer.samples;
        if (sum.reflectance.isZero(0)) return;
        const Vec3f irradiance = smooth ? smooth_irradiance(x, y, layer) : Vec3f(sum.irradiance / layer.samples);
        light += sum.reflectance.cwiseProduct(irradiance) / std::numbers::pi_v<float>;
      };
      collect(source.first);
      for (std::uint32_t k = source.more_begin; k < source.more_end; ++k) collect(more_[std::size_t(y)][k]);
      const float scale = exposure / std::max(samples - unlit_samples, 1.0f);
      const float lit_share = samples > 0 ? (samples - unlit_samples) / samples : 0;
      const Vec3f developed(film_curve(scale * light.x()), film_curve(scale * light.y()),
                            film_curve(scale * light.z()));
      image.at(x, y) = to_srgb(lit_share * developed + unlit / std::max(samples, 1.0f));
    }
  }
  return image;
}

}  // namespace flowskin::tools
