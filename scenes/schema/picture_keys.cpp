// Textures and pictures.
#include "scenes/schema/schema.h"

namespace flowskin::scenes {

namespace {

/// What is shown may be as far out as recorded particles, and the camera stands a way off (m).
constexpr double farthest_picture = 100 * max_recorded_coordinate;

}  // namespace

void add_texture_keys(KeyTable& table, TextureSpec& texture) {
  table.text("texture.image", texture.image, "checker, marble, or an image file relative to the scene file.");
  table.name("texture.mapping", texture.mapping, {"box", "planar", "spherical"},
             "How texture coordinates follow from rest positions.");
  table.number("texture.tile_size", texture.tile_size, at_least(0, 1e5), "m",
               "Edge of one copy of the image on the fluid; 0: from the size of the fluid.");
  table.vector("texture.axis", texture.axis, "", "Direction of projection (planar), pole (spherical).");
  table.vector("texture.rest_center", texture.rest_center, "m",
               "Centre of the fluid at rest, which the mapping refers to; used where rest_size is not 0.",
               farthest_picture);
  table.number("texture.rest_size", texture.rest_size, at_least(0, farthest_picture), "m",
               "Longest edge of the box around the fluid at rest; 0: centre and size from the particles at the start.");
  table.name("texture.when_stretched", texture.when_stretched, {"leave", "fade", "solid"},
             "Where the texture is stretched past the limit: leave it, fade to a newer texture, or to the solid one.");
  table.number("texture.stretch_limit", texture.stretch_limit, above(1, 1000), "",
               "Factor of stretch or squeeze at which that sets in; at one and a half times that it is complete.");
}

void add_render_keys(KeyTable& table, RenderSpec& render) {
  table.boolean("render.enabled", render.enabled, "Whether pictures are made.");
  table.vector("render.camera.position", render.camera.position, "m",
               "Place of the camera; position and look_at both zero: placed to see the whole scene.", farthest_picture);
  table.vector("render.camera.look_at", render.camera.look_at, "m", "Point in the middle of the picture.",
               farthest_picture);
  table.vector("render.camera.up", render.camera.up, "", "Direction that is up in the picture.");
  table.number("render.camera.vertical_fov", render.camera.vertical_fov, at_least(1, 170), "degrees",
               "Vertical field of view.");
  table.integer("render.width", render.width, 16, 16384, "pixels", "Width of the pictures.");
  table.integer("render.height", render.height, 16, 16384, "pixels", "Height of the pictures.");
  table.integer("render.samples", render.samples, 1, 4096, "", "Rays per pixel.");
  table.name("render.style", render.style, {"textured", "solid", "normals", "confidence"},
             "textured, solid (colour of the rest position) or normals.");
  table.boolean("render.ground", render.ground, "Whether a ground plane catches shadows.");
  table.number("render.ground_height", render.ground_height, at_least(-farthest_picture, farthest_picture), "m",
               "Height of the ground plane.");
  table.color("render.ground_color", render.ground_color, "Reflectance of the ground.");
  table.vector("render.light_direction", render.light_direction, "", "Direction towards the light.");
  table.number("render.light_size", render.light_size, at_least(0, 180), "degrees",
               "Angular diameter of the light: softness of shadows.");
  table.number("render.exposure", render.exposure, above(0, 1000), "", "Brightness of the pictures.");
}

}  // namespace flowskin::scenes
