"""Meshes of any number of triangles and the files of four formats that hold them. Vertices are flat arrays."""

import array
import json
import math
import struct


class Mesh:
    """positions: x, y, z one after the other; triangles: three indices each."""

    def __init__(self):
        self.positions = array.array("f")
        self.triangles = array.array("I")

    def add_sphere(self, centre, radius, rings, segments):
        first = len(self.positions) // 3
        circle = [
            (math.cos(2 * math.pi * s / segments), math.sin(2 * math.pi * s / segments)) for s in range(segments)
        ]
        for r in range(rings + 1):
            y, across = math.cos(math.pi * r / rings), math.sin(math.pi * r / rings)
            for c, s in circle:
                self.positions.extend(
                    (centre[0] + radius * across * c, centre[1] + radius * y, centre[2] + radius * across * s)
                )
        for r in range(rings):
            for s in range(segments):
                a, b = first + r * segments + s, first + r * segments + (s + 1) % segments
                if r > 0:
                    self.triangles.extend((a, b, a + segments))
                if r + 1 < rings:
                    self.triangles.extend((b, b + segments, a + segments))

    def count(self):
        return len(self.triangles) // 3


def spheres(triangles):
    """64 spheres on the floor of a room of 8 x 8 m, about so many triangles together."""
    mesh = Mesh()
    rings = max(2, round(math.sqrt(triangles / 64 / 4) + 0.5))
    for i in range(64):
        mesh.add_sphere((0.5 + i % 8, 0.35, 0.5 + i // 8), 0.25 + 0.01 * (i % 7), rings, 2 * rings)
    return mesh


def write_ply(mesh, file):
    with open(file, "wb") as out:
        out.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.positions) // 3}\nproperty float x\n"
            f"property float y\nproperty float z\nelement face {mesh.count()}\n"
            "property list uchar int vertex_indices\nend_header\n".encode()
        )
        out.write(mesh.positions.tobytes())
        triangle, t = struct.Struct("<BIII"), mesh.triangles
        out.write(b"".join(triangle.pack(3, t[i], t[i + 1], t[i + 2]) for i in range(0, len(t), 3)))


def write_obj(mesh, file):
    p, t = mesh.positions, mesh.triangles
    with open(file, "w", encoding="utf-8") as out:
        out.writelines(f"v {p[i]:.7g} {p[i + 1]:.7g} {p[i + 2]:.7g}\n" for i in range(0, len(p), 3))
        out.writelines(f"f {t[i] + 1} {t[i + 1] + 1} {t[i + 2] + 1}\n" for i in range(0, len(t), 3))


def write_glb(mesh, file):
    p = mesh.positions
    low, high = [min(p[k::3]) for k in range(3)], [max(p[k::3]) for k in range(3)]
    positions, indices = p.tobytes(), mesh.triangles.tobytes()
    head = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(positions) + len(indices)}],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(positions)},
            {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(p) // 3, "type": "VEC3", "min": low, "max": high},
            {"bufferView": 1, "componentType": 5125, "count": len(mesh.triangles), "type": "SCALAR"},
        ],
    }
    text = json.dumps(head).encode()
    text += b" " * (-len(text) % 4)
    binary = positions + indices
    with open(file, "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 12 + 8 + len(text) + 8 + len(binary)))
        out.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        out.write(struct.pack("<II", len(binary), 0x004E4942) + binary)


def yaml_mesh(mesh):
    """As `mesh:` of a scene file has it."""
    p, t = mesh.positions, mesh.triangles
    vertices = ", ".join(f"[{p[i]:.7g}, {p[i + 1]:.7g}, {p[i + 2]:.7g}]" for i in range(0, len(p), 3))
    faces = ", ".join(f"[{t[i]}, {t[i + 1]}, {t[i + 2]}]" for i in range(0, len(t), 3))
    return f"{{vertices: [{vertices}], faces: [{faces}]}}"
