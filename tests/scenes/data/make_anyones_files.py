#!/usr/bin/env python3
"""Writes the particle files in anyone/: the same eight particles in the formats of other programs, by other hands than
FlowSkin's (NumPy, h5py, gzip, struct). Particle k of step s is at (k/8 + s/2, k^2/64, -k), moves with (k, 1/2, -k/4),
and has the id 100 - k and the radius 1/4. Usage: make_anyones_files.py [FOLDER]; needs python3-numpy, python3-h5py."""
import gzip
import json
import os
import struct
import sys

import h5py
import numpy as np

os.chdir(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "anyone"))
K = np.arange(8)
IDS, RADII = 100 - K, np.full(8, 0.25)
VELOCITIES = np.stack([K, np.full(8, 0.5), -K / 4], axis=1)


def places(step=0):
    return np.stack([K / 8 + step / 2, K**2 / 64, -K.astype(float)], axis=1)


def write(name, content):
    with open(name, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())


def csv(step=0, ends="\n"):
    rows = [[*places(step)[k], *VELOCITIES[k], IDS[k], RADII[k]] for k in K]
    return ends.join(["x,y,z,vx,vy,vz,id,radius"] + [",".join(str(v) for v in row) for row in rows]) + ends


def bgeo():
    attributes = [(b"v", 3, 5), (b"id", 1, 1), (b"pscale", 1, 0), (b"name", 1, 4)]
    out = b"BgeoV" + struct.pack(">9i", 5, 8, 0, 0, 0, len(attributes), 0, 0, 0)
    for name, size, kind in attributes:
        out += struct.pack(">H", len(name)) + name + struct.pack(">Hi", size, kind)
        if kind == 4:
            out += struct.pack(">i", 2) + struct.pack(">H", 5) + b"water" + struct.pack(">H", 3) + b"oil"
        else:
            out += bytes(4 * size)
    for k in K:
        out += struct.pack(">4f", *places()[k], 1) + struct.pack(">3f", *VELOCITIES[k])
        out += struct.pack(">ifi", IDS[k], 0.25, k % 2)
    return out + b"\x00\xff"


def dump(kind):
    out = ""
    for step in range(3):
        out += f"ITEM: TIMESTEP\n{step * 100}\nITEM: NUMBER OF ATOMS\n8\n"
        low, edges = np.array([-1.0, 0.0, -8.0]), np.diag([4.0, 2.0, 16.0])
        if kind == "tilted":
            edges[0, 1], edges[0, 2], edges[1, 2] = 0.5, -1.0, 0.25
            xy, xz, yz = edges[0, 1], edges[0, 2], edges[1, 2]
            bounds = [(low[0] + min(0, xy, xz, xy + xz), low[0] + 4 + max(0, xy, xz, xy + xz), xy),
                      (low[1] + min(0, yz), low[1] + 2 + max(0, yz), xz), (low[2], low[2] + 16, yz)]
            out += "ITEM: BOX BOUNDS xy xz yz pp pp pp\n"
        else:
            bounds = [(low[i], low[i] + edges[i, i]) for i in range(3)]
            out += "ITEM: BOX BOUNDS pp pp ff\n"
        out += "".join(" ".join(f"{b:.16e}" for b in row) + "\n" for row in bounds)
        if kind == "plain":
            out += "ITEM: ATOMS id type x y z vx vy vz radius element\n"
            points = places(step)
        else:
            out += "ITEM: ATOMS id type xs ys zs vx vy vz radius element\n"
            points = np.linalg.solve(edges, (places(step) - low).T).T
        for k in K:
            row = [IDS[k], 1, *points[k], *VELOCITIES[k], 0.25]
            out += " ".join(repr(float(v)) if isinstance(v, float) else str(v) for v in row) + " Ar\n"
    return out


def xyz(kind):
    out = ""
    for step in range(1 if kind in ("bare", "element") else 3):
        if kind in ("plain", "extended"):
            out += "8\n"
        if kind == "plain":
            out += f"Atoms. Timestep: {step * 100}\n"
        if kind == "extended":
            out += f'Lattice="9 0 0 0 9 0 0 0 9" Properties=species:S:1:pos:R:3:velo:R:3:id:I:1 Time={step / 4}\n'
        for k in K:
            row = [str(v) for v in places(step)[k]]
            if kind == "extended":
                row += [str(v) for v in VELOCITIES[k]] + [str(IDS[k])]
            out += " ".join(([] if kind == "bare" else ["Ar"]) + row) + "\n"
    return out


def vtp(step=0, some=slice(None), lz4=False):
    """Appended raw data; LZ4 blocks of literals only are valid LZ4."""
    def block(data):
        count, out = len(data), b""
        if count < 15:
            return bytes([count << 4]) + data
        out, count = b"\xf0", count - 15
        while count >= 255:
            out, count = out + b"\xff", count - 255
        return out + bytes([count]) + data

    arrays = [("Points", places(step)[some], "Float64", 3), ("velocity", VELOCITIES[some], "Float64", 3),
              ("id", IDS[some].astype("<i8"), "Int64", 1), ("radius", RADII[some], "Float64", 1)]
    tags, appended = [], b""
    for name, values, kind, components in arrays:
        raw = np.ascontiguousarray(values).tobytes()
        tags.append(f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="appended" '
                    f'offset="{len(appended)}"/>')
        if lz4:  # two blocks: a whole one and the rest
            size = len(raw) * 2 // 3
            parts = [block(raw[:size]), block(raw[size:])]
            appended += struct.pack("<5I", 2, size, len(raw) - size, len(parts[0]), len(parts[1])) + b"".join(parts)
        else:
            appended += struct.pack("<I", len(raw)) + raw
    compressor = ' compressor="vtkLZ4DataCompressor"' if lz4 else ""
    head = (f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"{compressor}>\n'
            f'<PolyData><Piece NumberOfPoints="{len(arrays[0][1])}"><Points>{tags[0]}</Points><PointData>'
            + "".join(tags[1:]) + '</PointData></Piece></PolyData>\n<AppendedData encoding="raw">\n_')
    return head.encode() + appended + b"\n</AppendedData></VTKFile>\n"


def structured():
    record = np.zeros(8, dtype=[("x", "<f8"), ("y", "<f8"), ("z", ">f4"), ("vel", "<f4", (3,)), ("name", "U3"),
                                ("id", "<i8"), ("radius", "<f4")])
    record["x"], record["y"], record["z"] = places().T
    record["vel"], record["id"], record["radius"] = VELOCITIES, IDS, RADII
    return record


write("table.csv.gz", gzip.compress(csv().encode(), mtime=0))
write("carriage_returns.csv", csv(ends="\r"))
write("points.bgeo", bgeo())
write("points_gz.bgeo", gzip.compress(bgeo(), mtime=0))
write("plain.dump", dump("plain"))
write("scaled.dump", dump("scaled"))
write("tilted.lammpstrj.gz", gzip.compress(dump("tilted").encode(), mtime=0))
for kind in ("plain", "extended", "bare", "element"):
    write(f"{kind}.xyz", xyz(kind))
np.save("places.npy", places())
np.save("fortran.npy", np.asfortranarray(places().astype("f4")))
np.save("steps.npy", np.stack([places(s) for s in range(3)]))
np.save("records.npy", structured())
np.savez("arrays.npz", positions=places(), velocities=VELOCITIES, ids=IDS, radius=RADII, time=0.75)
np.savez_compressed("pysph_like.npz", x=places()[:, 0], y=places()[:, 1], z=places()[:, 2], u=VELOCITIES[:, 0],
                    v=VELOCITIES[:, 1], w=VELOCITIES[:, 2], gid=IDS.astype("u4"), tag=np.zeros(8, dtype="i4"))
np.savez("steps.npz", pos=np.stack([places(s) for s in range(3)]), vel=np.stack([VELOCITIES] * 3), id=IDS,
         time=[0, 0.25, 0.5])
np.savez("pickled.npz", version=2, particles={"fluid": {"arrays": {"x": places()[:, 0]}}})
rows = [{"position": dict(zip("xyz", places()[k])), "velocity": list(VELOCITIES[k]), "id": int(IDS[k]), "name": "a"}
        for k in K]
write("rows.json", json.dumps(places().tolist()))
write("objects.json", json.dumps(rows))
write("object.json", json.dumps({"time": 0.75, "positions": places().tolist(), "velocities": VELOCITIES.tolist(),
                                 "ids": IDS.tolist(), "program": "anyone's"}))
write("columns.json", json.dumps({"particles": {"x": list(places()[:, 0]), "y": list(places()[:, 1]),
                                                "z": list(places()[:, 2])}}))
write("frames.json", json.dumps({"frames": [{"t": s / 4, "particles": places(s).tolist()} for s in range(3)]}))
write("time.csv", "Time," + csv().split("\n")[0] + "\n"
      + "".join(f"{s / 4}," + line + "\n" for s in range(3) for line in csv(s).split("\n")[1:-1]))
write("time_step.csv", '"TimeStep",' + csv().split("\n")[0] + "\n"
      + "".join(f"{s}," + line + "\n" for s in range(3) for line in csv(s).split("\n")[1:-1]))
write("lz4.vtp", vtp(lz4=True))
write("piece_0.vtp", vtp(some=slice(0, 5)))
write("piece_1.vtp", vtp(some=slice(5, 8)))
write("pieces.pvtp", '<?xml version="1.0"?>\n<VTKFile type="PPolyData" version="0.1"><PPolyData GhostLevel="0">'
      '<Piece Source="piece_0.vtp"/><Piece Source="piece_1.vtp"/></PPolyData></VTKFile>\n')
for s in range(3):
    write(f"step_{s}.vtp", vtp(s))
write("parts.pvd", '<VTKFile type="Collection"><Collection>\n<DataSet timestep="0" part="0" file="piece_0.vtp"/>\n'
      '<DataSet timestep="0" part="1" file="piece_1.vtp"/>\n<DataSet timestep="0.25" part="0" file="step_1.vtp"/>\n'
      '<DataSet timestep="0.5" part="0" file="step_2.vtp"/></Collection></VTKFile>\n')
write("series.vtk.series", json.dumps({"file-series-version": "1.0", "files": [
    {"name": f"step_{s}.vtp", "time": s / 4} for s in range(3)]}))


def h5(name, fill):
    with h5py.File(name, "w", libver="earliest") as file:
        fill(file)


def fill_group(group, step=0, names=("x", "y", "z", "vx", "vy", "vz", "id")):
    for name, values in zip(names, [*places(step).T, *VELOCITIES.T, IDS]):
        group[name] = values


def fill_steps(file):
    for s in range(3):
        fill_group(file.create_group(f"Step#{s}"), s)
        file[f"Step#{s}"].attrs["TimeValue"] = s / 4


def fill_pysph(file):
    """As pysph.solver.output.HDFOutput does: what is not stored is an empty array."""
    for name in ("fluid", "walls"):
        arrays = file.create_group(f"particles/{name}/arrays")
        fill_group(arrays, 0, ("x", "y", "z", "u", "v", "w", "gid"))
        arrays.create_dataset("au", (0,))
        file[f"particles/{name}/constants/rho0"] = [1000.0]
    file.create_group("solver_data").attrs["t"] = 0.75


def fill_plain(file):
    file["Position"] = places().astype(">f4")
    file.create_dataset("Velocity", data=VELOCITIES, compression="gzip", chunks=(4, 3))
    file["ParticleIDs"] = IDS.astype("u8")
    file["name"] = "anyone's"


def fill_vtkhdf(file):
    root = file.create_group("VTKHDF")
    root.attrs["Type"], root.attrs["Version"] = np.bytes_("PolyData"), (2, 0)
    root["Points"] = places()
    root["PointData/velocity"], root["PointData/id"] = VELOCITIES, IDS
    root["Polygons/Offsets"], root["Polygons/Connectivity"] = [0], np.zeros(0, dtype="i8")


h5("steps.h5part", fill_steps)
h5("pysph.hdf5", fill_pysph)
h5("plain.h5", fill_plain)
h5("points.vtkhdf", fill_vtkhdf)
