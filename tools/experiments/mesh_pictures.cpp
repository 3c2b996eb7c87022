#include "tools/experiments/mesh_pictures.h"

#include <algorithm>
#include <cmath>

#include "common/bounds.h"
#include "tools/pipeline/picture_maker.h"
#include "tools/render/camera.h"
#include "tools/render/color.h"
#include "tools/render/renderer.h"
#include "tools/textures/texture_mapping.h"
#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tools {
namespace {

constexpr float kWireOpacity = 0.55f;
constexpr float kWireWidth = 1.1f;  // pixels
constexpr Color kWireColor{20, 24, 32};

void blend(Image& image, int x, int y, float opacity) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height || opacity <= 0) return;
  const Vec3f mixed = (1 - opacity) * to_linear(image.at(x, y)) + opacity * to_linear(kWireColor);
  image.at(x, y) = to_srgb(mixed);
}

// How dark the edges make each pixel: the nearest edge counts, so that pixels where edges meet do not get darker.
class WireLayer {
 public:
  WireLayer(int width, int height)
      : width_(width), height_(height), cover_(std::size_t(width) * std::size_t(height), 0.0f) {}

  void line(const Vec2f& a, const Vec2f& b) {
    if (!a.allFinite() || !b.allFinite()) return;
    const Vec2f low = a.cwiseMin(b).array() - 2, high = a.cwiseMax(b).array() + 2;
    const int left = std::max(0, int(low.x())), right = std::min(width_ - 1, int(high.x()));
    const int top = std::max(0, int(low.y())), bottom = std::min(height_ - 1, int(high.y()));
    const Vec2f along = b - a;
    const float squared = std::max(along.squaredNorm(), 1e-12f);
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const Vec2f point(float(x) + 0.5f, float(y) + 0.5f);
        const float share = std::clamp((point - a).dot(along) / squared, 0.0f, 1.0f);
        const float distance = (point - a - share * along).norm();
        float& cover = cover_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
        cover = std::max(cover, std::clamp(0.5f * kWireWidth + 0.5f - distance, 0.0f, 1.0f));
      }
    }
  }

  void draw_on(Image& image) const {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        blend(image, x, y, kWireOpacity * cover_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]);
  }

 private:
  int width_, height_;
  std::vector<float> cover_;
};

// Edges of triangles that face the camera; the bodies are nearly convex, so few of them are hidden.
void draw_wire(const scenes::CameraSpec& spec, const tracking::SurfaceMesh& mesh, Image& image) {
  const Camera camera(spec, image.width, image.height, Vec3::Zero());
  WireLayer wire(image.width, image.height);
  for (const tracking::Triangle& triangle : mesh.triangles) {
    const Vec3 area = doubled_area_vector(mesh.positions, triangle);
    if (area.dot(spec.position - mesh.positions[triangle[0]]) <= 0) continue;
    for (int corner = 0; corner < 3; ++corner)
      wire.line(camera.project(mesh.positions[triangle[corner]]),
                camera.project(mesh.positions[triangle[(corner + 1) % 3]]));
  }
  wire.draw_on(image);
}

Color error_color(double share) {
  static const Vec3f low = to_linear({45, 96, 180}), middle = to_linear({236, 236, 232}),
                     high = to_linear({190, 36, 30});
  const float s = float(std::clamp(std::isfinite(share) ? share : 1.0, 0.0, 1.0));
  return s < 0.5f ? to_srgb((1 - 2 * s) * low + 2 * s * middle) : to_srgb((2 - 2 * s) * middle + (2 * s - 1) * high);
}

}  // namespace

struct MeshPainter::Impl {
  Impl(const scenes::Scene& painted, const sph::Box& body)
      : scene(painted),
        textured(painted.render, painted.boundaries, make_texture(painted.texture.image, painted.directory), body),
        solid(solid_settings(painted), painted.boundaries, Image{}, body) {}

  static scenes::RenderSpec solid_settings(const scenes::Scene& scene) {
    scenes::RenderSpec settings = scene.render;
    settings.style = "solid";
    return settings;
  }
  SurfaceFrame dressed(const tracking::SurfaceMesh& mesh) const {
    return dress(mesh, 0, scene.texture, rest_frame(mesh.rest_positions));
  }
  Image with_wire(Image image, const tracking::SurfaceMesh& mesh) const {
    draw_wire(scene.render.camera, mesh, image);
    return image;
  }

  scenes::Scene scene;
  Renderer textured, solid;
};

MeshPainter::MeshPainter(const scenes::Scene& scene, const tracking::SurfaceMesh& start)
    : impl_(std::make_unique<Impl>(scene, bounds(start.positions))) {}
MeshPainter::~MeshPainter() = default;

Image MeshPainter::textured(const tracking::SurfaceMesh& mesh) const {
  return impl_->with_wire(impl_->textured.draw(impl_->dressed(mesh)), mesh);
}

Image MeshPainter::colored(const tracking::SurfaceMesh& mesh, const std::vector<double>& errors, double largest) const {
  SurfaceFrame frame = impl_->dressed(mesh);
  for (std::size_t v = 0; v < errors.size(); ++v) frame.colors[v] = error_color(errors[v] / largest);
  return impl_->with_wire(impl_->solid.draw(frame), mesh);
}

}  // namespace flowskin::tools
