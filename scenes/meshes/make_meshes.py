#!/usr/bin/env python3
"""Makes the OBJ files of this folder. Lengths in m, y up; run it here after changing a number."""
import math

STEPS, DEPTH, HEIGHT, LANDING, WIDTH = 6, 0.20, 0.14, 0.80, 1.80


class Mesh:
    def __init__(self):
        self.index, self.faces = {}, []

    def face(self, *points):
        """Corners counter-clockwise seen from outside; equal points become one vertex."""
        corners = [self.index.setdefault(tuple(round(c, 9) + 0.0 for c in p), len(self.index) + 1) for p in points]
        self.faces.append(corners)

    def write(self, name, title):
        with open(name, "w", encoding="ascii", newline="\n") as file:
            file.write(f"# {title}\n# Made by make_meshes.py\no {name[:-4]}\n")
            for p in self.index:
                file.write("v " + " ".join(f"{c:g}" for c in p) + "\n")
            for corners in self.faces:
                file.write("f " + " ".join(map(str, corners)) + "\n")


def stairs():
    """A closed solid: a landing from x = -LANDING to 0, then STEPS risers and the treads between them."""
    mesh, half = Mesh(), WIDTH / 2
    edges = [-LANDING] + [DEPTH * k for k in range(STEPS)]
    tops = [HEIGHT * (STEPS - k) for k in range(STEPS)]
    for k, top in enumerate(tops):
        x0, x1 = edges[k], edges[k + 1]
        below = tops[k + 1] if k + 1 < STEPS else 0
        mesh.face((x0, top, half), (x1, top, half), (x1, top, -half), (x0, top, -half))
        mesh.face((x1, below, half), (x1, below, -half), (x1, top, -half), (x1, top, half))
        mesh.face((x0, 0, half), (x0, 0, -half), (x1, 0, -half), (x1, 0, half))
        # The corner at `below` belongs to the next riser too: the sides must have it as well.
        corner = [(x1, below)] if below > 0 else []
        side = [(x0, 0), (x1, 0)] + corner + [(x1, top), (x0, top)]
        mesh.face(*[(x, y, half) for x, y in side])
        mesh.face(*[(x, y, -half) for x, y in reversed(side)])
    mesh.face((-LANDING, 0, half), (-LANDING, tops[0], half), (-LANDING, tops[0], -half), (-LANDING, 0, -half))
    mesh.write("stairs.obj", f"A flight of {STEPS} steps, {DEPTH} m deep and {HEIGHT} m high, with a landing")


def stairs_floor():
    """The floor in front of the stairs, as wide as they are."""
    mesh, half, foot, far = Mesh(), WIDTH / 2, DEPTH * (STEPS - 1), 1.9
    mesh.face((foot, 0, half), (far, 0, half), (far, 0, -half), (foot, 0, -half))
    mesh.write("stairs_floor.obj", "The floor in front of the stairs")


def box():
    """An open box, 1 m wide and deep and 0.6 m high, seen from inside."""
    mesh, h, top = Mesh(), 0.5, 0.6
    mesh.face((-h, 0, h), (h, 0, h), (h, 0, -h), (-h, 0, -h))
    mesh.face((-h, 0, h), (-h, 0, -h), (-h, top, -h), (-h, top, h))
    mesh.face((h, 0, -h), (h, 0, h), (h, top, h), (h, top, -h))
    mesh.face((-h, 0, -h), (h, 0, -h), (h, top, -h), (-h, top, -h))
    mesh.face((h, 0, h), (-h, 0, h), (-h, top, h), (h, top, h))
    mesh.write("box.obj", "An open box of 1 x 0.6 x 1 m; its floor is y = 0")


def torus(large=0.22, small=0.09, around=48, across=24):
    mesh = Mesh()

    def point(i, j):
        u, v = 2 * math.pi * i / around, 2 * math.pi * j / across
        r = large + small * math.cos(v)
        return (r * math.cos(u), r * math.sin(u), small * math.sin(v))

    for i in range(around):
        for j in range(across):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            mesh.face(*[tuple(round(x, 6) for x in p) for p in (a, b, c, d)])
    mesh.write("torus.obj", f"A closed torus about the z axis, radii {large} and {small} m")


def cone(radius=0.2, height=0.25, around=48):
    """A closed cone that stands on y = 0, its tip cut off by a small cap."""
    mesh, cap = Mesh(), 0.04

    def ring(r, y, i):
        a = 2 * math.pi * i / around
        return (round(r * math.cos(a), 6), y, round(-r * math.sin(a), 6))

    for i in range(around):
        a, b = ring(radius, 0.0, i), ring(radius, 0.0, i + 1)
        c, d = ring(cap, height, i + 1), ring(cap, height, i)
        mesh.face(a, b, c, d)
        mesh.face(d, c, (0.0, height, 0.0))
        mesh.face(b, a, (0.0, 0.0, 0.0))
    mesh.write("cone.obj", "A blunt cone of radius 0.2 m and height 0.25 m on y = 0")


def capsule(radius=0.07, half=0.32, around=32, rings=10):
    """A closed rod along x with round ends; `half` is half the distance of the centres of its ends."""
    mesh = Mesh()

    def point(i, j):
        """Ring i from the left pole to the right one, corner j."""
        a = math.pi * (i if i <= rings else i - 1) / (2 * rings) - math.pi / 2
        x, r = radius * math.sin(a) + (-half if i <= rings else half), radius * math.cos(a)
        b = 2 * math.pi * j / around
        return tuple(round(c, 6) + 0.0 for c in (x, r * math.cos(b), r * math.sin(b)))

    last = 2 * rings + 1
    for j in range(around):
        mesh.face(point(0, 0), point(1, j + 1), point(1, j))
        mesh.face(point(last, 0), point(last - 1, j), point(last - 1, j + 1))
        for i in range(1, last - 1):
            mesh.face(point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j))
    mesh.write("capsule.obj", f"A closed rod with round ends along the x axis, radius {radius} m")


def dish(radius=0.32, thin=0.045, thick=0.13, around=64, rings=16):
    """A closed disc about the y axis, hollowed from both sides: `thin` in the middle, `thick` near its round rim."""
    mesh, rim = Mesh(), thick / 2

    def height(r):
        flat = radius - rim
        if r <= flat:
            return (thin + (thick - thin) * (r / flat) ** 2) / 2
        return math.sqrt(max(rim * rim - (r - flat) ** 2, 0.0))

    def point(side, i, j):
        # Rings close together on the rim, where the surface is steep.
        r, a = radius * math.sin(0.5 * math.pi * i / rings), 2 * math.pi * j / around
        y = 0.0 if i == rings else side * height(r)
        return tuple(round(c, 6) + 0.0 for c in (r * math.cos(a), y, -r * math.sin(a)))

    for j in range(around):
        mesh.face(point(1, 0, 0), point(1, 1, j), point(1, 1, j + 1))
        mesh.face(point(-1, 0, 0), point(-1, 1, j + 1), point(-1, 1, j))
        for i in range(1, rings):
            mesh.face(point(1, i, j), point(1, i + 1, j), point(1, i + 1, j + 1), point(1, i, j + 1))
            mesh.face(point(-1, i, j), point(-1, i, j + 1), point(-1, i + 1, j + 1), point(-1, i + 1, j))
    mesh.write("dish.obj", f"A closed disc of radius {radius} m, {thin} m thick in the middle and {thick} m near the rim")


def bar(radius=0.09, half=0.24, sides=12):
    """A closed horizontal bar along z, through the origin."""
    mesh = Mesh()

    def corner(k, z):
        a = 2 * math.pi * (k + 0.5) / sides
        return (round(radius * math.cos(a), 6), round(radius * math.sin(a), 6), z)

    for k in range(sides):
        mesh.face(corner(k, half), corner(k, -half), corner(k + 1, -half), corner(k + 1, half))
        mesh.face((0.0, 0.0, half), corner(k, half), corner(k + 1, half))
        mesh.face((0.0, 0.0, -half), corner(k + 1, -half), corner(k, -half))
    mesh.write("bar.obj", f"A closed bar of radius {radius} m and length {2 * half} m along the z axis")


def around_y(j, radius, y, around=48):
    """Point j of a circle about the y axis."""
    a = 2 * math.pi * j / around
    return (round(radius * math.cos(a), 6) + 0.0, y, round(-radius * math.sin(a), 6) + 0.0)


def cylinder(around=48):
    """Around the y axis, radius 1, from y = 0 to 1; closed."""
    mesh = Mesh()
    for j in range(around):
        a, b = around_y(j, 1, 0.0), around_y(j + 1, 1, 0.0)
        c, d = around_y(j + 1, 1, 1.0), around_y(j, 1, 1.0)
        mesh.face(a, b, c, d)
        mesh.face((0.0, 0.0, 0.0), b, a)
        mesh.face((0.0, 1.0, 0.0), d, c)
    mesh.write("cylinder.obj", "A closed cylinder around the y axis, radius 1 m, height 1 m")


def tub(thick=0.08, around=48):
    """A solid tub: room of radius 1 from y = 0 to 1, and walls around it, so that no fluid shows through."""
    mesh, outer = Mesh(), 1 + thick
    for j in range(around):
        k = j + 1
        mesh.face(around_y(k, 1, 0.0), around_y(j, 1, 0.0), around_y(j, 1, 1.0), around_y(k, 1, 1.0))
        mesh.face((0.0, 0.0, 0.0), around_y(j, 1, 0.0), around_y(k, 1, 0.0))
        mesh.face(around_y(j, 1, 1.0), around_y(j, outer, 1.0), around_y(k, outer, 1.0), around_y(k, 1, 1.0))
        mesh.face(around_y(j, outer, -thick), around_y(k, outer, -thick), around_y(k, outer, 1.0),
                  around_y(j, outer, 1.0))
        mesh.face((0.0, -thick, 0.0), around_y(k, outer, -thick), around_y(j, outer, -thick))
    mesh.write("tub.obj", "A tub around the y axis, inside radius 1 m and height 1 m, open above")


def paddle(width=0.5, height=0.16, shaft=0.06, top=0.6, thick=0.05):
    """A blade across the y axis, from y = 0 up, on a shaft; closed."""
    mesh, w, s, z = Mesh(), width / 2, shaft / 2, thick / 2
    blocks = [((-w, 0.0), (-s, height)), ((-s, 0.0), (s, height)), ((s, 0.0), (w, height)), ((-s, height), (s, top))]
    for (x0, y0), (x1, y1) in blocks:
        mesh.face((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))
        mesh.face((x1, y0, -z), (x0, y0, -z), (x0, y1, -z), (x1, y1, -z))
    # Corners of the outline, seen from +z.
    outline = [(-w, 0.0), (-s, 0.0), (s, 0.0), (w, 0.0), (w, height), (s, height), (s, top), (-s, top), (-s, height),
               (-w, height)]
    for (x0, y0), (x1, y1) in zip(outline, outline[1:] + outline[:1]):
        mesh.face((x0, y0, z), (x0, y0, -z), (x1, y1, -z), (x1, y1, z))
    mesh.write("paddle.obj", f"A paddle {width} m wide and {thick} m thick on a shaft along the y axis")


def star(outer=0.06, inner=0.03, points=5):
    """A flat star about the y axis, facing up: the outline of an outlet."""
    mesh = Mesh()

    def corner(k):
        r, a = (inner if k % 2 else outer), math.pi * k / points
        return (round(r * math.cos(a), 6), 0.0, round(-r * math.sin(a), 6))

    for k in range(2 * points):
        mesh.face((0.0, 0.0, 0.0), corner(k), corner((k + 1) % (2 * points)))
    mesh.write("star.obj", f"A flat star with {points} points, radii {outer} and {inner} m, in the plane y = 0")


if __name__ == "__main__":
    stairs()
    stairs_floor()
    box()
    torus()
    cone()
    capsule()
    bar()
    dish()
    cylinder()
    tub()
    paddle()
    star()
