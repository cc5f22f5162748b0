"""Simple scenes, described once and written for each program that renders them.

Metres, y up, radiance in W/(sr m^2) of the channels R, G, B. A quad is (corner, u, v); its front is where
u x v points, lamps shine to the front only, what is diffuse or metal reflects on both sides, and quads of
glass enclose a body, all of them one.
"""

import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Diffuse:
    colour: tuple  # reflectance


@dataclasses.dataclass(frozen=True)
class Metal:
    """Facets of GGX of the width alpha, which hide each other as Smith has it; Fresnel's reflectance of n + i k."""

    alpha: float
    n: float
    k: float


@dataclasses.dataclass(frozen=True)
class Glass:
    """Smooth and clear, in air."""

    ior: float


@dataclasses.dataclass
class Quad:
    surface: object  # Diffuse, Metal or Glass
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

    def surfaces(self):
        return {type(q.surface) for q in self.quads}


WHITE, RED, GREEN = Diffuse((0.73,) * 3), Diffuse((0.6, 0.06, 0.05)), Diffuse((0.12, 0.45, 0.15))
BRIGHT, DARK, BLACK = Diffuse((0.85,) * 3), Diffuse((0.2, 0.18, 0.16)), Diffuse((0.0,) * 3)
METAL, GLASS = Metal(0.1, 0.2, 3.0), Glass(1.5)


def room(low, high, surfaces):
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
    return [Quad(s, *side) for s, side in zip(surfaces, sides) if s]


def block(low, high, surface, turn=0.0):
    """Six sides that look outwards, turned about the vertical axis through its middle [degrees]."""
    quads = room(low, high, [surface] * 6)
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def turned(p):
        return (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0])

    def moved(p):
        x, y, z = turned(tuple(a - b for a, b in zip(p, middle)))
        return (x + middle[0], y + middle[1], z + middle[2])

    return [Quad(surface, moved(q.corner), turned(q.v), turned(q.u)) for q in quads]


def cornell(name, short, tall):
    """A Cornell box of simple colours, open to the viewer, with two blocks."""
    quads = room((0, 0, 0), (1, 1, 1), [RED, GREEN, WHITE, WHITE, WHITE, None])
    quads += short + tall
    quads.append(Quad(BLACK, (0.38, 0.998, 0.38), (0.24, 0, 0), (0, 0, 0.24), 15.0))
    return Scene(name, quads, (0.5, 0.5, 2.4), (0.5, 0.5, 0.0), 39.0)


def short_block(surface):
    return block((0.16, 0.0, 0.5), (0.46, 0.3, 0.8), surface, -17)


def tall_block(surface, floor=0.0):
    return block((0.54, floor, 0.15), (0.84, floor + 0.6, 0.45), surface, 20)


def box():
    return cornell("box", short_block(WHITE), tall_block(WHITE))


def gloss():
    return cornell("gloss", short_block(METAL), tall_block(METAL))


def glass():
    """The block of glass stands a little above the floor, in air on all sides."""
    return cornell("glass", short_block(WHITE), tall_block(GLASS, 0.02))


def cove():
    """A room whose lamps lie on shelves and shine at the ceiling: all light that is seen was reflected."""
    quads = room((0, 0, 0), (5, 2.8, 4), [WHITE, WHITE, DARK, BRIGHT, WHITE, WHITE])
    for x in (0.0, 4.7):
        quads += block((x, 2.4, 0.0), (x + 0.3, 2.45, 4.0), WHITE)
        quads.append(Quad(BLACK, (x + 0.1, 2.455, 0.2), (0, 0, 3.6), (0.1, 0, 0), 40.0))
    quads += block((1.4, 0.7, 1.2), (3.4, 0.74, 2.2), RED)
    quads += block((1.6, 0.0, 1.4), (3.2, 0.7, 2.0), DARK)
    quads += block((0.3, 0.0, 0.3), (0.9, 1.6, 0.9), GREEN, 30)
    return Scene("cove", quads, (4.6, 1.6, 3.7), (1.6, 0.9, 0.8), 60.0)


SCENES = {"box": box, "cove": cove, "gloss": gloss, "glass": glass}


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


def atrium_material(surface):
    match surface:
        case Metal(alpha, n, k):
            return f"ior: {{n: {n:g}, k: {k:g}}}, lobe: {{ggx: {{alpha: {alpha:g}}}}}, fresnel_error: 0"
        case Glass(ior):
            return f"medium: solid, ior: {ior:g}, fresnel_error: 0"
        case Diffuse(colour):
            return f"body: [{words(colour, ', ')}]"


def atrium(scene, _size):
    lines = ["atrium: 1", f"description: {scene.name}", "unit: watt", "materials:"]
    for i, q in enumerate(scene.quads):
        emission = f", emission: {{radiance: {q.radiance:g}}}" if q.radiance else ""
        lines.append(f"  m{i}: {{{atrium_material(q.surface)}{emission}}}")
    lines.append("objects:")
    for i, q in enumerate(scene.quads):
        points = ", ".join(f"[{words(p, ', ')}]" for p in corners(q))
        lines.append(f"  - {{name: q{i}, material: m{i}, polygon: [{points}]}}")
    lines.append(
        f"cameras: [{{name: view, perspective: {{eye: [{words(scene.eye, ', ')}], "
        f"target: [{words(scene.target, ', ')}], yfov: {scene.yfov}}}}}]"
    )
    return "\n".join(lines) + "\n"


def mitsuba_bsdf(surface):
    match surface:
        case Metal(alpha, n, k):
            reflects = (
                f'<bsdf type="roughconductor"><string name="distribution" value="ggx"/>'
                f'<float name="alpha" value="{alpha}"/><rgb name="eta" value="{n}"/><rgb name="k" value="{k}"/></bsdf>'
            )
        case Glass(ior):
            ends = f'<float name="int_ior" value="{ior}"/><float name="ext_ior" value="1"/>'
            return f'<bsdf type="dielectric">{ends}</bsdf>'
        case Diffuse(colour):
            reflects = f'<bsdf type="diffuse"><rgb name="reflectance" value="{words(colour)}"/></bsdf>'
    return f'<bsdf type="twosided">{reflects}</bsdf>'


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
            f"{mitsuba_bsdf(q.surface)}{emitter}</shape>"
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

    def triangles(q, move=(0, 0, 0)):
        a, b, c, d = (vector(add(p, move)) for p in corners(q))
        return f"triangle {{ {a}, {b}, {c} }} triangle {{ {a}, {c}, {d} }}"

    lines = [
        "#version 3.7;",
        "global_settings { assumed_gamma 1.0 max_trace_level 20 radiosity { count COUNT, 10007 "
        "error_bound ERROR_BOUND recursion_limit RECURSION nearest_count 8 low_error_factor 0.5 gray_threshold 0 "
        "pretrace_start 0.08 pretrace_end 0.01 adc_bailout 0.001 brightness 1 } }",
        f"camera {{ location {vector(scene.eye)} direction {vector(scaled(forward, distance))} "
        f"up {vector(up)} right {vector(scaled(right, size[0] / size[1]))} }}",
    ]
    body = [q for q in scene.quads if isinstance(q.surface, Glass)]
    for q in scene.quads:
        if q in body:
            continue
        look = (
            f"pigment {{ rgb 1 }} finish {{ ambient 0 diffuse 0 emission {q.radiance} }}"
            if q.radiance
            else f"pigment {{ rgb {vector(q.surface.colour)} }} finish {{ ambient 0 diffuse 1 emission 0 }}"
        )
        lines.append(f"mesh {{ {triangles(q)} texture {{ {look} }} }}")
        if q.radiance:  # its back shines as well: something black behind it
            behind = scaled(unit(cross(q.u, q.v)), -5e-4)
            look = "pigment { rgb 0 } finish { ambient 0 diffuse 0 }"
            lines.append(f"mesh {{ {triangles(q, behind)} texture {{ {look} }} }}")
    if body:
        lines.append(
            f"mesh {{ {' '.join(triangles(q) for q in body)} inside_vector y texture {{ pigment {{ rgbt 1 }} "
            "finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } } "
            f"interior {{ ior {body[0].surface.ior} }} }}"
        )
    return "\n".join(lines) + "\n"


def radiance(scene, _size):
    lines = []
    for i, q in enumerate(scene.quads):
        if q.radiance:
            lines.append(f"void light m{i}\n0\n0\n3 {words([q.radiance] * 3)}")
        else:
            lines.append(f"void plastic m{i}\n0\n0\n5 {words(q.surface.colour)} 0 0")
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
