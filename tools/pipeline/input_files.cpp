#include "tools/pipeline/input_files.h"

#include <fmt/format.h>

#include <string_view>

#include "scenes/io/checksum.h"

namespace flowskin::tools {

namespace {

std::uint32_t checksum_of(const sph::TriangleMesh& mesh) {
  std::uint32_t sum = 0;
  StateWriter writer([&](std::string_view bytes) { sum = scenes::checksum(sum, bytes); });
  writer(mesh.positions, mesh.triangles);
  writer.flush();
  return sum;
}

std::uint32_t checksum_of(const Image& image) {
  const std::string_view pixels(reinterpret_cast<const char*>(image.pixels.data()),
                                image.pixels.size() * sizeof(Color));
  return scenes::checksum(static_cast<std::uint32_t>(image.width), pixels);
}

}  // namespace

std::vector<FileContent> input_files(const scenes::Scene& scene, const Image& texture) {
  std::vector<FileContent> files;
  const auto add_meshes = [&](const char* list, const auto& specs, const auto& mesh_of) {
    for (std::size_t i = 0; i < specs.size(); ++i)
      files.push_back({fmt::format("{}[{}].file", list, i), specs[i].mesh.file, checksum_of(mesh_of(specs[i]))});
  };
  add_meshes(
      "bodies", scene.bodies, [](const auto& spec) -> const auto& { return spec.body.mesh; });
  add_meshes(
      "emitters", scene.emitters, [](const auto& spec) -> const auto& { return spec.emitter.mesh; });
  add_meshes(
      "sinks", scene.sinks, [](const auto& spec) -> const auto& { return spec.sink.mesh; });
  add_meshes(
      "boundaries", scene.boundaries, [](const auto& spec) -> const auto& { return spec.boundary.mesh; });
  files.push_back({"texture.image", scene.texture.image, checksum_of(texture)});
  return files;
}

}  // namespace flowskin::tools
