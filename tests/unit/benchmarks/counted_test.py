"""Comparison of counted work with a baseline: what fails, what passes, what is only said."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "benchmarks"))
from suite import counted  # noqa: E402  (the path comes first)


def case(command="render a", **numbers):
    return {"box": {"command": command, "numbers": {name.replace("_dot_", "."): v for name, v in numbers.items()}}}


class Compare(unittest.TestCase):
    def names(self, baseline, found):
        """Names of the regressions, names of the gains, number of complaints."""
        regressions, gains, complaints = counted.compare(baseline, found)
        return [c.name for c in regressions], [c.name for c in gains], len(complaints)

    def test_equal_counts_pass(self):
        self.assertEqual(self.names(case(samples=1000), case(samples=1000)), ([], [], 0))

    def test_within_the_tolerance_passes_and_beyond_it_fails(self):
        self.assertEqual(self.names(case(samples=1000), case(samples=1020)), ([], [], 0))
        self.assertEqual(self.names(case(samples=1000), case(samples=1021)), (["samples"], [], 0))

    def test_one_more_of_a_small_count_passes(self):
        self.assertEqual(self.names(case(iterations=9), case(iterations=10)), ([], [], 0))
        self.assertEqual(self.names(case(iterations=9), case(iterations=11)), (["iterations"], [], 0))

    def test_less_is_said_but_no_failure(self):
        self.assertEqual(self.names(case(samples=1000), case(samples=900)), ([], ["samples"], 0))

    def test_less_work_for_more_error_fails(self):
        found = self.names(case(samples=1000, error_dot_pixel=0.1), case(samples=500, error_dot_pixel=0.14))
        self.assertEqual(found, (["error.pixel"], ["samples"], 0))

    def test_what_was_not_traced_before_fails(self):
        self.assertEqual(self.names(case(), case(rays_dot_photon=1)), (["rays.photon"], [], 0))

    def test_what_is_no_longer_counted_is_a_complaint(self):
        self.assertEqual(self.names(case(samples=1000), case()), ([], [], 1))

    def test_a_number_that_is_none_fails(self):
        found = self.names(case(error_dot_pixel=0.1), case(error_dot_pixel=float("nan")))
        self.assertEqual(found, (["error.pixel"], [], 0))

    def test_memory_has_a_wide_bound(self):
        self.assertEqual(self.names(case(memory_mb=100.0), case(memory_mb=141.0)), ([], [], 0))
        self.assertEqual(self.names(case(memory_mb=100.0), case(memory_mb=141.1)), (["memory_mb"], [], 0))

    def test_other_cases_and_other_commands_cannot_be_compared(self):
        self.assertEqual(self.names(case(samples=1), {}), ([], [], 1))
        self.assertEqual(self.names({}, case(samples=1)), ([], [], 1))
        self.assertEqual(self.names(case("render a", samples=1), case("render b", samples=5)), ([], [], 1))

    def test_the_table_names_case_number_and_change(self):
        regressions, _, _ = counted.compare(case(samples=1000), case(samples=1500))
        self.assertEqual(
            counted.table(regressions).splitlines()[1].split(), ["box", "samples", "1000", "1500", "+50.0", "%"]
        )


if __name__ == "__main__":
    unittest.main()
