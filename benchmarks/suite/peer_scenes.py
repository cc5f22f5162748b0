"""Simple diffuse scenes, described once and written for each program that renders them.

Metres, y up, radiance in W/(sr m^2) of the channels R, G, B. A quad is (corner, u, v); its front is where
u x v points, lamps shine to the front only, everything else reflects on both sides.
"""

import dataclasses
import math


@dataclasses.dataclass
class Quad:
    colour: tuple  # reflectance
    corner: tuple
    u: tuple
    v: tuple
    radiance: float = 0.0


@dataclasses.dataclass
class Scene:
    name: str
    quads: list
    eye: tuple
    target: tuple
    yfov: float  # degrees


WHITE, RED, GREEN, DARK, BLACK = (0.73,) * 3, (0.6, 0.06, 0.05), (0.12, 0.45, 0.15), (0.2, 0.18, 0.16), (0.0,) * 3


def room(low, high, colours):
    """Six walls that look inwards: left, right, bottom, top, back, front."""
    (x, y, z), (w, h, d) = low, tuple(b - a for a, b in zip(low, high))
    sides = [
        ((x, y, z), (0, h, 0), (0, 0, d)),
        ((x + w, y, z), (0, 0, d), (0, h, 0)),
        ((x, y, z), (0, 0, d), (w, 0, 0)),
        ((x, y + h, z), (w, 0, 0), (0, 0, d)),
        ((x, y, z), (w, 0, 0), (0, h, 0)),
        ((x, y, z + d), (0, h, 0), (w, 0, 0)),
    ]
    return [Quad(c, *side) for c, side in zip(colours, sides) if c]


def block(low, high, colour, turn=0.0):
    """Six sides that look outwards, turned about the vertical axis through its middle [degrees]."""
    quads = room(low, high, [colour] * 6)
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def turned(p):
        return (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0])

    def moved(p):
        x, y, z = turned(tuple(a - b for a, b in zip(p, middle)))
        return (x + middle[0], y + middle[1], z + middle[2])

    return [Quad(colour, moved(q.corner), turned(q.v), turned(q.u)) for q in quads]


def box():
    """A Cornell box of simple colours, open to the viewer."""
    quads = room((0, 0, 0), (1, 1, 1), [RED, GREEN, WHITE, WHITE, WHITE, None])
    quads += block((0.16, 0.0, 0.5), (0.46, 0.3, 0.8), WHITE, -17)
    quads += block((0.54, 0.0, 0.15), (0.84, 0.6, 0.45), WHITE, 20)
    quads.append(Quad(BLACK, (0.38, 0.998, 0.38), (0.24, 0, 0), (0, 0, 0.24), 15.0))
    return Scene("box", quads, (0.5, 0.5, 2.4), (0.5, 0.5, 0.0), 39.0)


def cove():
    """A room whose lamps lie on shelves and shine at the ceiling: all light that is seen was reflected."""
    quads = room((0, 0, 0), (5, 2.8, 4), [WHITE, WHITE, DARK, (0.85,) * 3, WHITE, WHITE])
    for x in (0.0, 4.7):
        quads += block((x, 2.4, 0.0), (x + 0.3, 2.45, 4.0), WHITE)
        quads.append(Quad(BLACK, (x + 0.1, 2.455, 0.2), (0, 0, 3.6), (0.1, 0, 0), 40.0))
    quads += block((1.4, 0.7, 1.2), (3.4, 0.74, 2.2), RED)
    quads += block((1.6, 0.0, 1.4), (3.2, 0.7, 2.0), DARK)
    quads += block((0.3, 0.0, 0.3), (0.9, 1.6, 0.9), GREEN, 30)
    return Scene("cove", quads, (4.6, 1.6, 3.7), (1.6, 0.9, 0.8), 60.0)


SCENES = {"box": box, "cove": cove}


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def scaled(a, factor):
    return tuple(factor * x for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1.0 / math.sqrt(sum(x * x for x in a)))


def words(numbers, between=" "):
    return between.join(f"{x:.9g}" for x in numbers)


def corners(q):
    return [q.corner, add(q.corner, q.u), add(add(q.corner, q.u), q.v), add(q.corner, q.v)]


def atrium(scene, _size):
    lines = ["atrium: 1", f"description: {scene.name}", "unit: watt", "materials:"]
    for i, q in enumerate(scene.quads):
        emission = f", emission: {{radiance: {q.radiance:g}}}" if q.radiance else ""
        lines.append(f"  m{i}: {{body: [{words(q.colour, ', ')}]{emission}}}")
    lines.append("objects:")
    for i, q in enumerate(scene.quads):
        points = ", ".join(f"[{words(p, ', ')}]" for p in corners(q))
        lines.append(f"  - {{name: q{i}, material: m{i}, polygon: [{points}]}}")
    lines.append(
        f"cameras: [{{name: view, perspective: {{eye: [{words(scene.eye, ', ')}], "
        f"target: [{words(scene.target, ', ')}], yfov: {scene.yfov}}}}}]"
    )
    return "\n".join(lines) + "\n"


def mitsuba(scene, size):
    lines = [
        '<scene version="3.0.0">',
        '<integrator type="path"><integer name="max_depth" value="-1"/></integrator>',
        '<sensor type="perspective"><string name="fov_axis" value="y"/>'
        f'<float name="fov" value="{scene.yfov}"/><transform name="to_world">'
        f'<lookat origin="{words(scene.eye, ", ")}" target="{words(scene.target, ", ")}" up="0, 1, 0"/></transform>'
        '<sampler type="independent"/><film type="hdrfilm"><rfilter type="box"/>'
        f'<integer name="width" value="{size[0]}"/><integer name="height" value="{size[1]}"/>'
        '<string name="pixel_format" value="rgb"/><string name="component_format" value="float32"/></film></sensor>',
    ]
    for q in scene.quads:
        # The unit rectangle spans -1 to 1 in x and y and looks along z.
        n = unit(cross(q.u, q.v))
        middle = add(q.corner, scaled(add(q.u, q.v), 0.5))
        columns = [scaled(q.u, 0.5), scaled(q.v, 0.5), n, middle]
        matrix = [columns[c][r] for r in range(3) for c in range(4)] + [0, 0, 0, 1]
        emitter = f'<emitter type="area"><rgb name="radiance" value="{q.radiance}"/></emitter>' if q.radiance else ""
        lines.append(
            f'<shape type="rectangle"><transform name="to_world"><matrix value="{words(matrix)}"/></transform>'
            f'<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="{words(q.colour)}"/>'
            f"</bsdf></bsdf>{emitter}</shape>"
        )
    return "\n".join(lines + ["</scene>"]) + "\n"


def pov(scene, size):
    """Lamps are surfaces that only its radiosity finds: none of its light sources shines by the cosine."""
    forward = unit(add(scene.target, scaled(scene.eye, -1)))
    right = unit(cross(forward, (0, 1, 0)))
    up = cross(right, forward)
    distance = 0.5 / math.tan(math.radians(scene.yfov / 2))

    def vector(a):
        return f"<{words(a, ', ')}>"

    lines = [
        "#version 3.7;",
        "global_settings { assumed_gamma 1.0 max_trace_level 20 radiosity { count COUNT, 10007 "
        "error_bound ERROR_BOUND recursion_limit RECURSION nearest_count 8 low_error_factor 0.5 gray_threshold 0 "
        "pretrace_start 0.08 pretrace_end 0.01 adc_bailout 0.001 brightness 1 } }",
        f"camera {{ location {vector(scene.eye)} direction {vector(scaled(forward, distance))} "
        f"up {vector(up)} right {vector(scaled(right, size[0] / size[1]))} }}",
    ]
    for q in scene.quads:
        a, b, c, d = (vector(p) for p in corners(q))
        look = (
            f"pigment {{ rgb 1 }} finish {{ ambient 0 diffuse 0 emission {q.radiance} }}"
            if q.radiance
            else f"pigment {{ rgb <{words(q.colour, ', ')}> }} finish {{ ambient 0 diffuse 1 emission 0 }}"
        )
        lines.append(f"mesh {{ triangle {{ {a}, {b}, {c} }} triangle {{ {a}, {c}, {d} }} texture {{ {look} }} }}")
        if q.radiance:  # its back shines as well: something black behind it
            behind = scaled(unit(cross(q.u, q.v)), -5e-4)
            a, b, c, d = (vector(add(p, behind)) for p in corners(q))
            lines.append(
                f"mesh {{ triangle {{ {a}, {b}, {c} }} triangle {{ {a}, {c}, {d} }} "
                "texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 } } }"
            )
    return "\n".join(lines) + "\n"


def radiance(scene, _size):
    lines = []
    for i, q in enumerate(scene.quads):
        if q.radiance:
            lines.append(f"void light m{i}\n0\n0\n3 {words([q.radiance] * 3)}")
        else:
            lines.append(f"void plastic m{i}\n0\n0\n5 {words(q.colour)} 0 0")
        points = "\n".join(words(p) for p in corners(q))
        lines.append(f"m{i} polygon q{i}\n0\n0\n12\n{points}")
    return "\n".join(lines) + "\n"


def radiance_view(scene, size):
    """Options of rpict."""
    direction = unit(add(scene.target, scaled(scene.eye, -1)))
    half = math.tan(math.radians(scene.yfov / 2))
    across = 2 * math.degrees(math.atan(half * size[0] / size[1]))
    return [
        "-vtv",
        "-vp",
        *scene.eye,
        "-vd",
        *direction,
        "-vu",
        0,
        1,
        0,
        "-vh",
        across,
        "-vv",
        scene.yfov,
        "-x",
        size[0],
        "-y",
        size[1],
        "-pa",
        0,
        "-pj",
        0.9,
    ]
