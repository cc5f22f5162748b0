"""What the benchmarks measure on: generated scenes are what they say, tables are read as they are written."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "benchmarks"))
from suite import meshes, peer_scenes, peers, program  # noqa: E402  (the path comes first)
from suite.sections import radiosity  # noqa: E402


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class PeerScenes(unittest.TestCase):
    def side(self, quad, point):
        """Which side of a quad a point lies on; positive: its front."""
        middle = peer_scenes.add(quad.corner, peer_scenes.scaled(peer_scenes.add(quad.u, quad.v), 0.5))
        return dot(peer_scenes.cross(quad.u, quad.v), peer_scenes.add(point, peer_scenes.scaled(middle, -1)))

    def test_rooms_look_inwards_and_blocks_outwards(self):
        for quad in peer_scenes.room((0, 0, 0), (2, 3, 4), [peer_scenes.WHITE] * 6):
            self.assertGreater(self.side(quad, (1, 1.5, 2)), 0)
        for quad in peer_scenes.block((0, 0, 0), (2, 3, 4), peer_scenes.WHITE, 30):
            self.assertLess(self.side(quad, (1, 1.5, 2)), 0)

    def test_a_turned_block_keeps_its_area(self):
        sides = peer_scenes.block((0, 0, 0), (2, 3, 4), peer_scenes.WHITE, 30)
        area = sum(dot(n, n) ** 0.5 for n in (peer_scenes.cross(q.u, q.v) for q in sides))
        self.assertAlmostEqual(area, 2 * (6 + 8 + 12))

    def test_glass_stands_free_and_looks_outwards(self):
        body = [q for q in peer_scenes.glass().quads if isinstance(q.surface, peer_scenes.Glass)]
        self.assertEqual(len(body), 6)
        self.assertGreater(min(p[1] for q in body for p in peer_scenes.corners(q)), 0.01)
        middle = peer_scenes.scaled([sum(p[i] for q in body for p in peer_scenes.corners(q)) for i in range(3)], 1 / 24)
        for quad in body:
            self.assertLess(self.side(quad, middle), 0)

    def test_each_program_has_words_for_the_materials_it_knows(self):
        words = {peer_scenes.Metal: (peer_scenes.gloss, "ggx"), peer_scenes.Glass: (peer_scenes.glass, "ior")}
        for peer in (peers.Atrium, peers.Mitsuba, peers.PovRay):
            write = peer.write
            for surface in peer.knows & words.keys():
                make, word = words[surface]
                self.assertIn(word, write(make(), peers.SIZE))

    def test_lamps_shine_down_in_the_box_and_up_in_the_cove(self):
        for make, up in ((peer_scenes.box, -1), (peer_scenes.cove, 1)):
            lamps = [q for q in make().quads if q.radiance]
            self.assertTrue(lamps)
            for lamp in lamps:
                self.assertGreater(up * peer_scenes.cross(lamp.u, lamp.v)[1], 0)


class Meshes(unittest.TestCase):
    def test_spheres_are_closed_and_look_outwards(self):
        mesh = meshes.Mesh()
        mesh.add_sphere((1, 2, 3), 0.5, 5, 10)
        edges, t, p = {}, mesh.triangles, mesh.positions
        for i in range(0, len(t), 3):
            corner = [tuple(p[3 * t[i + k] : 3 * t[i + k] + 3]) for k in range(3)]
            u, v = (tuple(a - b for a, b in zip(corner[k], corner[0])) for k in (1, 2))
            middle = tuple(sum(c[k] for c in corner) / 3 - (1, 2, 3)[k] for k in range(3))
            self.assertGreater(dot(peer_scenes.cross(u, v), middle), 0)
            for k in range(3):
                # Vertices of a pole are one point.
                edge = tuple(tuple(round(x, 5) for x in corner[j]) for j in (k, (k + 1) % 3))
                edges[edge] = edges.get(edge, 0) + 1
        for (a, b), times in edges.items():
            self.assertEqual((times, edges.get((b, a))), (1, 1))

    def test_about_as_many_triangles_as_asked(self):
        for wanted in (10000, 100000):
            self.assertAlmostEqual(meshes.spheres(wanted).count() / wanted, 1.0, delta=0.15)


class Costs(unittest.TestCase):
    def test_cost_of_a_process_is_its_own(self):
        busy = "import time\nwhile time.process_time() < 0.2: pass"
        cost, text = program.run([sys.executable, "-c", busy + "\nprint('done')"])
        self.assertEqual(text.strip(), "done")
        self.assertGreaterEqual(cost.cpu, 0.2)
        self.assertGreaterEqual(cost.wall, 0.2)
        self.assertGreater(cost.memory, 1.0)

    def test_a_program_that_fails_is_a_failure_with_its_words(self):
        with self.assertRaisesRegex(program.Failed, "exit code 3\nno such scene"):
            program.run([sys.executable, "-c", "import sys; print('no such scene', file=sys.stderr); sys.exit(3)"])

    def test_the_median_is_of_each_number(self):
        costs = [program.Cost(1, 9, 5), program.Cost(2, 8, 5), program.Cost(3, 7, 6)]
        self.assertEqual(program.median(costs), program.Cost(2, 8, 5))


class RadiosityTables(unittest.TestCase):
    TEXT = """# Page

## room

| method | effort | rays | rays per side | CPU s | wall s | peak MB | RMS error | 95 % interval | best 99 % | p95 / RMS | bias | statistical | absolute | own estimate | points | interpolated |
| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| rows, 20k elements | fixed | 7.0e6 | 207 | 5.9 | 7.6 | 119 | 5.4 % | 3.7 % - 6.7 % | 4.6 % | 2.0 | +1.09 % | 5.3 % | 2.8 % | 6.9 % | 35.6 % | 31.3 % |
| path tracing | 64 paths | 2.0e7 | 601 | 13.1 | 17.3 |  | 17.2 % | 0.00 % - 24.7 % | 11.1 % | 1.7 | +0.06 % | 17.2 % |  | 13.2 % |  |  |
"""

    def test_rows_of_every_method_are_read(self):
        rows = radiosity.read_tables(self.TEXT)["room"]
        self.assertEqual([r["method"] for r in rows], ["rows", "path tracing"])
        self.assertEqual((rows[0]["rays"], rows[0]["cpu"], rows[0]["memory"]), (7e6, 5.9, 119))
        self.assertAlmostEqual(rows[1]["rms"], 0.172)
        self.assertIsNone(rows[1]["memory"])

    def test_a_goal_is_met_by_the_cheapest_row_that_has_the_error(self):
        rows = radiosity.read_tables(self.TEXT)["room"]
        self.assertEqual(radiosity.to_goal(rows, 0.2, "cpu"), "5.9")
        self.assertEqual(radiosity.to_goal(rows, 0.05, "cpu"), "-")


if __name__ == "__main__":
    unittest.main()
