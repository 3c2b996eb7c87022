// The one list of what vertices carry besides their positions: whoever adds, drops, interpolates, checks or archives
// vertices goes by it.
#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include "tracking/mesh/surface_mesh.h"

namespace flowskin::tracking {

/// Where the value of a new vertex comes from.
enum class Carried {
  material,  ///< A place of its material: between its neighbours' where an edge is split (not across a tear); else as
             ///< MaterialCarrier says.
  motion,    ///< Between its neighbours' where an edge is split; else zero until the next step.
  identity,  ///< A number that only one vertex has: next_id, unless it goes on as an old vertex.
};

/// Calls visit(how, name, member) for each member of SurfaceMesh that vertices carry, in the order of the archive.
/// The name is in the plural, for messages.
template <class Mesh, class Visit>
void for_each_vertex_member(Mesh& mesh, const Visit& visit) {
  visit(Carried::material, std::string_view("rest positions"), mesh.rest_positions);
  visit(Carried::material, std::string_view("places in a layer"), mesh.layers);
  visit(Carried::motion, std::string_view("velocities"), mesh.velocities);
  visit(Carried::identity, std::string_view("ids"), mesh.ids);
}

/// Calls visit(how, name, values) for each array with one value a vertex; layers are as many arrays.
template <class Mesh, class Visit>
void for_each_attribute(Mesh& mesh, const Visit& visit) {
  for_each_vertex_member(mesh, [&](Carried how, std::string_view name, auto& member) {
    using Value = typename std::remove_cvref_t<decltype(member)>::value_type;
    if constexpr (requires(Value value) { value.push_back(value.front()); }) {
      for (auto& values : member) visit(how, name, values);
    } else {
      visit(how, name, member);
    }
  });
}

/// Calls visit(values) for each array of places of the material (m).
template <class Mesh, class Visit>
void for_each_material(Mesh& mesh, const Visit& visit) {
  for_each_attribute(mesh, [&](Carried how, std::string_view, auto& values) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(values)>, std::vector<Vec3>>)
      if (how == Carried::material) visit(values);
  });
}

/// The value 0 of an attribute.
template <class T>
T zero_attribute() {
  if constexpr (std::is_arithmetic_v<T>)
    return T{};
  else
    return T::Zero();
}

/// Makes all attributes `count` long; what is new is zero until it is known.
inline void resize_attributes(std::size_t count, SurfaceMesh& mesh) {
  for_each_attribute(mesh, [count](Carried, std::string_view, auto& values) {
    values.resize(count, zero_attribute<typename std::remove_cvref_t<decltype(values)>::value_type>());
  });
}

/// Adds what a new vertex in the middle of edge ab carries. Where two bodies have met, the places of their materials
/// are farther apart than `farthest` (m): then those of a are taken.
inline void add_middle_attributes(int a, int b, double farthest, SurfaceMesh& mesh) {
  for_each_attribute(mesh, [&](Carried how, std::string_view, auto& values) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    if constexpr (std::is_integral_v<Value>) {
      values.push_back(mesh.next_id++);
    } else {
      const Value from = values[a], to = values[b];
      const bool torn = how == Carried::material && (from - to).norm() > farthest;
      values.push_back(torn ? from : Value((from + to) / 2));
    }
  });
}

}  // namespace flowskin::tracking
