"""Scene files of rooms that differ in one number: what the sweeps of run times go over."""

import math

HEAD = "atrium: 1\nunit: nit\nmaterials:\n"
LAMP = "  - {{name: lamp, material: lamp, polygon: [[3, {y}, 3], [5, {y}, 3], [5, {y}, 5], [3, {y}, 5]]}}\n"
CAMERA = "cameras: [{name: view, perspective: {eye: [0.3, 1.8, 7.6], target: [4, 0.6, 3], yfov: 60}}]\n"
# Looks down: no lamp of the ceiling is in it, smaller than a pixel and far brighter than all else.
CAMERA_DOWN = "cameras: [{name: view, perspective: {eye: [0.3, 1.8, 7.6], target: [4, 0, 3], yfov: 32}}]\n"


def furnished(content):
    """A room of 8 x 8 x 3 m with a lamp and one object, given as the keys of a scene file."""
    return (
        HEAD + "  wall: {body: 0.7}\n  thing: {body: 0.5}\n  lamp: {body: 0.0, emission: {power: 8000}}\nobjects:\n"
        "  - {name: room, material: wall, box: {min: [0, 0, 0], max: [8, 3, 8], inside: true}}\n"
        + LAMP.format(y=2.98)
        + f"  - {{name: things, material: thing, {content}}}\n"
        + CAMERA
    )


def lamps(count):
    """A hall with so many lamps of 2 cm below its ceiling, always of the same flux together, and 16 blocks."""
    across = math.ceil(math.sqrt(count))
    step = 8.0 / across
    places = ", ".join(
        f"[{(i % across + 0.5) * step:.6g}, 2.9, {(i // across + 0.5) * step:.6g}]" for i in range(count)
    )
    return (
        HEAD + "  wall: {body: 0.7}\n  thing: {body: 0.5}\n  lamp: {body: 0.0, emission: {power: 8000}}\nobjects:\n"
        "  - {name: room, material: wall, box: {min: [0, 0, 0], max: [8, 3, 8], inside: true}}\n"
        "  - {name: block, material: thing, box: {min: [0.5, 0, 0.5], max: [1.1, 0.9, 1.1]}, "
        "repeat: {count: [4, 1, 4], step: [2, 1, 2]}}\n"
        "  - {name: lamp, material: lamp, polygon: [[-0.01, 0, -0.01], [0.01, 0, -0.01], [0.01, 0, 0.01], "
        f"[-0.01, 0, 0.01]], at: [{places}]}}\n" + CAMERA_DOWN
    )


def grey(reflectance):
    """A closed room with four blocks in which everything but the lamp reflects the same."""
    return (
        HEAD + f"  wall: {{body: {reflectance}}}\n  lamp: {{body: 0.0, emission: {{power: 8000}}}}\nobjects:\n"
        "  - {name: room, material: wall, box: {min: [0, 0, 0], max: [8, 3, 8], inside: true}}\n"
        "  - {name: block, material: wall, box: {min: [1.5, 0, 1.5], max: [2.5, 1.2, 2.5]}, "
        "repeat: {count: [2, 1, 2], step: [4, 1, 4]}}\n" + LAMP.format(y=2.9) + CAMERA
    )
