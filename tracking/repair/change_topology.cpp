#include "tracking/repair/change_topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "tracking/extraction/marching_cubes.h"
#include "tracking/mesh/keep_vertices.h"
#include "tracking/mesh/mesh_measures.h"
#include "tracking/repair/places_to_mend.h"
#include "tracking/repair/repair_limits.h"
#include "tracking/repair/replace_region.h"
#include "tracking/repair/small_parts.h"

namespace flowskin::tracking {
namespace {

// Of a closed surface, without the components that enclose less than `least` (m^3).
SurfaceCounts counts_of(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, double least,
                        double edge_length) {
  const MeshComponents parts = mesh_components(positions, triangles);
  // Each triangle has three sides, each edge two of them: V - E + F = V - F / 2.
  std::vector<int> doubled_euler(parts.count, 0);
  for (int part : parts.of_vertex) {
    if (part >= 0) doubled_euler[part] += 2;
  }
  for (const Triangle& triangle : triangles) --doubled_euler[parts.of_vertex[triangle[0]]];
  const auto count = [&](double smallest) {
    SurfaceCounts::Parts sum;
    for (int part = 0; part < parts.count; ++part) {
      if (std::abs(parts.volumes[part]) < smallest) continue;
      ++sum.components;
      sum.euler += doubled_euler[part] / 2;
    }
    return sum;
  };
  const double cell = std::pow(edge_length, 3);
  const auto& [half, whole] = kRepairLimits.counted_parts;
  return {count(std::max(least, half * cell)), count(std::max(least, whole * cell))};
}

// Interpolation along the edges of the grid makes parts hardly larger than a cell much too small to be compared.
void put_small_parts_on_roots(const FieldGrid& fresh, double edge_length, SurfaceGeometry& surface) {
  const MeshComponents parts = mesh_components(surface.positions, surface.triangles);
  const double small = kRepairLimits.compared_on_roots * std::pow(edge_length, 3);
  const auto value = [&](const Vec3& x) { return fresh.field.value(x); };
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    if (std::abs(parts.volumes[parts.of_vertex[v]]) < small) put_on_root(fresh.grid, value, surface.positions[v]);
  }
}

// Components that enclose less are taken out in the end (m^3).
double least_volume(const TopologySettings& settings) {
  const double dust = kRepairLimits.dust * std::pow(settings.edge_length, 3);
  return settings.small_parts == SmallParts::drop ? std::max(dust, settings.smallest_part) : dust;
}

// A mesh while regions of it are replaced: removed triangles and vertices stay in their places until the end.
class MeshUnderRepair {
 public:
  MeshUnderRepair(const FieldGrid& fresh, SurfaceMesh& mesh, Projection& projection)
      : fresh_(fresh), mesh_(mesh), projection_(projection), old_count_(mesh.positions.size()) {
    mend_.positions = mesh.positions;
    mend_.normals = projection.normals;
    mend_.triangles = mesh.triangles;
    mend_.alive.assign(mesh.triangles.size(), 1);
    mend_.boxes = boxes_of(fresh.grid, mesh);
    for (int t = 0; t < static_cast<int>(mend_.boxes.size()); ++t) mend_.bins.add(t, mend_.boxes[t]);
  }

  // Patches for all places at once; those that got in each other's way once more, until none are left. Returns how many
  // places were replaced.
  int replace(const std::vector<CellSet>& places, std::string& why) {
    int replaced = 0;
    std::vector<int> open(places.size());
    std::iota(open.begin(), open.end(), 0);
    while (!open.empty()) {
      const int base = static_cast<int>(mend_.positions.size());
      std::vector<std::optional<MeshPatch>> patches(open.size());
      std::vector<std::string> whys(open.size());
#pragma omp parallel for schedule(dynamic, 1)
      for (std::ptrdiff_t p = 0; p < std::ssize(open); ++p) patches[p] = patch_for(places[open[p]], whys[p]);
      std::vector<int> in_the_way;
      for (std::size_t p = 0; p < open.size(); ++p) {
        if (!patches[p]) {
          why = whys[p];
        } else if (is_alive(patches[p]->removed)) {
          renumber_born(base, *patches[p]);
          apply(*patches[p]);
          ++replaced;
        } else {
          in_the_way.push_back(open[p]);
        }
      }
      open = std::move(in_the_way);
    }
    return replaced;
  }

  // Takes out the components for which `is_dust` holds.
  void remove(const MeshComponents& components, const std::vector<char>& is_dust) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (is_dust[components.of_vertex[mesh_.triangles[t][0]]]) mend_.alive[t] = 0;
    }
  }

  // Gives the new vertices their attributes, drops what is not used any more, and hands the mesh back.
  void finish(const Particles& particles, const MaterialSettings& settings, TopologyReport& report) {
    dress_new_vertices(particles, settings);
    const std::vector<char> used = drop_triangles();
    name_new_vertices(used, settings.same_vertex, report);
    const std::vector<int> number = compact(used);
    take_over_projection(number);
  }

 private:
  // Grows the region where it does not fit, or where the patch intersects something.
  std::optional<MeshPatch> patch_for(CellSet cells, std::string& why) const {
    std::optional<MeshPatch> best;
    std::size_t fewest = 0;
    Misfit misfit;
    for (int attempt = 1; attempt <= kRepairLimits.attempts; ++attempt) {
      auto patch = replace_region(fresh_, cells, mend_, misfit);
      if (patch && misfit.cells.empty()) return patch;
      why = misfit.why;
      if (patch && (!best || misfit.cells.size() < fewest)) {
        fewest = misfit.cells.size();
        best = patch;
      }
      const CellSet bad(std::move(misfit.cells));
      // Deep within the region more cells do not help.
      if (patch && !bad.empty() && cells.contains(bad.dilated(2))) break;
      const CellSet wider = cells.united(bad.dilated(1));
      const bool all_around =
          wider.cells().size() == cells.cells().size() || attempt % kRepairLimits.all_around_every == 0;
      cells = all_around ? wider.united(cells.dilated(1 + attempt / (2 * kRepairLimits.all_around_every))) : wider;
    }
    return best;
  }

  bool is_alive(const std::vector<int>& triangles) const {
    return std::all_of(triangles.begin(), triangles.end(), [&](int t) { return mend_.alive[t] != 0; });
  }

  // Other patches have brought vertices since the mesh had `base` of them.
  void renumber_born(int base, MeshPatch& patch) const {
    const int offset = static_cast<int>(mend_.positions.size()) - base;
    for (Triangle& triangle : patch.triangles) {
      for (int& vertex : triangle) vertex += vertex >= base ? offset : 0;
    }
  }

  void apply(const MeshPatch& patch) {
    for (int t : patch.removed) mend_.alive[t] = 0;
    mend_.positions.insert(mend_.positions.end(), patch.born.begin(), patch.born.end());
    mend_.normals.insert(mend_.normals.end(), patch.born_normals.begin(), patch.born_normals.end());
    for (const Triangle& triangle : patch.triangles) {
      mend_.boxes.push_back(box_of(fresh_.grid, triangle, mend_.positions));
      mend_.bins.add(static_cast<int>(mend_.triangles.size()), mend_.boxes.back());
      mend_.triangles.push_back(triangle);
      mend_.alive.push_back(1);
    }
  }

  void dress_new_vertices(const Particles& particles, const MaterialSettings& settings) {
    std::vector<Triangle> gone;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!mend_.alive[t]) gone.push_back(mesh_.triangles[t]);
    }
    const std::size_t count = mend_.positions.size();
    MaterialCarrier(mesh_.positions, gone, fresh_.field, particles, settings)
        .append_material(mesh_, std::span(mend_.positions).subspan(old_count_),
                         std::span(mend_.normals).subspan(old_count_), mesh_);
    resize_attributes(count, mesh_);
  }

  // Returns which vertices the triangles that are left use.
  std::vector<char> drop_triangles() {
    std::vector<char> used(mend_.positions.size(), 0);
    mesh_.triangles.clear();
    for (std::size_t t = 0; t < mend_.triangles.size(); ++t) {
      if (!mend_.alive[t]) continue;
      mesh_.triangles.push_back(mend_.triangles[t]);
      for (int vertex : mend_.triangles[t]) used[vertex] = 1;
    }
    return used;
  }

  // A new vertex beside one that is gone, on the same side of the fluid, goes on under its id.
  void name_new_vertices(const std::vector<char>& used, double same_vertex, TopologyReport& report) {
    std::vector<int> gone, born;
    for (int v = 0; v < std::ssize(used); ++v) {
      const bool is_old = v < static_cast<int>(old_count_);
      if (is_old != (used[v] != 0)) (is_old ? gone : born).push_back(v);
    }
    const auto chosen = [](const std::vector<Vec3>& values, const std::vector<int>& vertices) {
      std::vector<Vec3> result;
      for (int vertex : vertices) result.push_back(values[vertex]);
      return result;
    };
    const std::vector<Vec3> old_places = chosen(mend_.positions, gone), old_normals = chosen(mend_.normals, gone);
    const std::vector<Vec3> places = chosen(mend_.positions, born), normals = chosen(mend_.normals, born);
    const std::vector<int> same = same_vertices({old_places, old_normals}, {places, normals}, same_vertex);
    for (std::size_t i = 0; i < born.size(); ++i) {
      const int old = same[i] < 0 ? -1 : gone[same[i]];
      const bool goes_on = old >= 0;
      mesh_.ids[born[i]] = goes_on ? mesh_.ids[old] : mesh_.next_id++;
      report.born += goes_on ? 0 : 1;
    }
  }

  // Returns the new number of each vertex, -1 for those that are gone.
  std::vector<int> compact(const std::vector<char>& used) {
    std::vector<int> number(used.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v]) number[v] = count++;
    }
    mesh_.positions = mend_.positions;
    keep_numbered(number, mesh_.positions);
    keep_attributes(number, mesh_);
    for (Triangle& triangle : mesh_.triangles) {
      for (int& vertex : triangle) vertex = number[vertex];
    }
    return number;
  }

  // Old vertices have not moved; the new ones are projected once more, which tells whether they have arrived.
  void take_over_projection(const std::vector<int>& number) {
    std::vector<int> moved;
    for (int vertex : projection_.failed) {
      if (number[vertex] >= 0) moved.push_back(number[vertex]);
    }
    projection_.failed.clear();
    for (std::size_t v = old_count_; v < number.size(); ++v) {
      if (number[v] >= 0) moved.push_back(number[v]);
    }
    projection_.normals.resize(number.size());
    projection_.distances.resize(number.size());
    keep_numbered(number, projection_.normals);
    keep_numbered(number, projection_.distances);
    project_moved(fresh_.field, default_projection(fresh_.field.scale()), moved, mesh_.positions, projection_);
  }

  const FieldGrid& fresh_;
  SurfaceMesh& mesh_;
  Projection& projection_;
  std::size_t old_count_;
  MeshToMend mend_;
};

// Takes out the components that enclose next to nothing, either way round, and the small ones where they are unwanted.
void sweep(const FieldGrid& fresh, const Particles& particles, const TopologySettings& settings, SurfaceMesh& mesh,
           Projection& projection, TopologyReport& report) {
  const double least = least_volume(settings);
  const MeshComponents components = mesh_components(mesh.positions, mesh.triangles);
  std::vector<char> is_dust(components.count);
  for (int c = 0; c < components.count; ++c) is_dust[c] = std::abs(components.volumes[c]) < least;
  if (std::find(is_dust.begin(), is_dust.end(), 1) == is_dust.end()) return;
  MeshUnderRepair repair(fresh, mesh, projection);
  report.dropped += static_cast<int>(std::count(is_dust.begin(), is_dust.end(), 1));
  repair.remove(components, is_dust);
  repair.finish(particles, settings.material, report);
}

// Makes balls of the same volume around the same centre of the small parts, either way round.
void round_small_parts(const TopologySettings& settings, SurfaceMesh& mesh, TopologyReport& report) {
  const MeshComponents components = mesh_components(mesh.positions, mesh.triangles);
  std::vector<std::vector<int>> vertices(components.count);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    vertices[components.of_vertex[v]].push_back(static_cast<int>(v));
  std::vector<std::vector<Triangle>> triangles(components.count);
  for (const Triangle& triangle : mesh.triangles) triangles[components.of_vertex[triangle[0]]].push_back(triangle);
  for (int c = 0; c < components.count; ++c) {
    if (!(std::abs(components.volumes[c]) < settings.smallest_part)) continue;
    report.balls += make_ball(vertices[c], triangles[c], components.volumes[c], mesh.positions);
  }
}

}  // namespace

TopologyReport change_topology(const ImplicitField& field, const Particles& particles, const TopologySettings& settings,
                               SurfaceMesh& mesh, Projection& projection) {
  const std::shared_ptr<const SparseGrid> kept = field.on_grid(settings.edge_length);
  const SparseGrid& grid = *kept;
  const FieldGrid fresh{field, grid};
  SurfaceGeometry expected = march(grid);
  put_small_parts_on_roots(fresh, settings.edge_length, expected);
  const double least = least_volume(settings), edge_length = settings.edge_length;
  TopologyReport report;
  report.expected = counts_of(expected.positions, expected.triangles, least, edge_length);
  PlacesToMend to_mend(fresh, expected, settings.depth);
  for (int round = 0; round < kRepairLimits.rounds; ++round) {
    std::vector<CellSet> regions = to_mend.find(mesh, projection);
    if (regions.empty()) {
      report.counts = counts_of(mesh.positions, mesh.triangles, least, edge_length);
      if (report.counts.agree_with(report.expected)) break;
      regions = to_mend.find_hidden(mesh);
      if (regions.empty()) regions = to_mend.find_strays(mesh);
      if (regions.empty()) break;
    }
    if (!settings.local) {
      report.stubborn = static_cast<int>(regions.size());
      report.counts = counts_of(mesh.positions, mesh.triangles, least, edge_length);
      report.why = "mesh and field disagree";
      break;
    }
    MeshUnderRepair repair(fresh, mesh, projection);
    const int replaced = repair.replace(regions, report.why);
    report.stubborn += static_cast<int>(regions.size()) - replaced;
    report.regions += replaced;
    repair.finish(particles, settings.material, report);
  }
  if (report.regions > 0 || settings.small_parts == SmallParts::drop) {
    sweep(fresh, particles, settings, mesh, projection, report);
    report.counts = counts_of(mesh.positions, mesh.triangles, least, edge_length);
  }
  if (settings.small_parts == SmallParts::balls) round_small_parts(settings, mesh, report);
  return report;
}

}  // namespace flowskin::tracking
