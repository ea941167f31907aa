"""Without a server: values as text, errors, tables."""

import sys
import unittest
import unittest.mock

import lab
import numpy as np
import plab
from plab.requests import text_of


class TextTest(unittest.TestCase):
    def test_numbers_keep_all_their_bits(self):
        for value in (0.1, 1 / 3, -2.5e-17, np.float64(0.1), np.float32(0.1)):
            self.assertEqual(float(text_of(value)), float(value))
        self.assertEqual(text_of(3.0), "3")
        self.assertEqual(text_of(np.int64(7)), "7")

    def test_vectors_truth_and_units(self):
        self.assertEqual(text_of((0, 0.5, -1)), "0 0.5 -1")
        self.assertEqual(text_of(np.array([1.0, 2.0, 3.5])), "1 2 3.5")
        self.assertEqual(text_of(True), "true")
        self.assertEqual(text_of("0.5 rad"), "0.5 rad")

    def test_parameters_read_back(self):
        self.assertEqual(plab.Parameter("0.5", "rad", "param").value, 0.5)
        self.assertEqual(plab.Parameter("1 2 3", "m", "state").value, (1, 2, 3))
        self.assertEqual(plab.Parameter("true", "", "param").value, True)
        self.assertEqual(plab.Parameter("mesh a", "", "param").value, "mesh a")
        self.assertEqual(plab.Parameter("", "", "param").value, "")


class TableTest(unittest.TestCase):
    def test_without_pandas_the_error_says_what_to_install(self):
        with unittest.mock.patch.dict(sys.modules, {"pandas": None}):
            with self.assertRaisesRegex(ImportError, "apt install python3-pandas"):
                plab.to_dataframe([])

    def test_vectors_have_a_column_for_each_component(self):
        outcome = plab.Outcome(1.5, (1, 2, 3), 0.0, 2e-6)
        swap = plab.Swap("gears", "A", "B", {"ratio": "kept"}, 1.0, outcome, outcome)
        table = plab.to_dataframe([swap])
        self.assertEqual(table.loc[0, "with_new_momentum_y"], 2)
        self.assertEqual(table.loc[0, "fields"], {"ratio": "kept"})


class PackageTest(unittest.TestCase):
    def test_what_it_exports_is_there_and_explained(self):
        for name in plab.__all__:
            self.assertTrue(getattr(plab, name).__doc__ or name == "MissedWarning", name)
        self.assertRegex(plab.__version__, r"^\d+\.\d+\.\d+$")

    def test_only_what_exists_is_joined(self):
        with self.assertRaisesRegex(plab.PlabError, "0 to 232, not 233"):
            plab.Session("nobody", domain=233)
        with self.assertRaisesRegex(plab.PlabError, "not a valid server name"):
            plab.Session("no body")
        with self.assertRaisesRegex(plab.PlabError, "no_such_file.mcap"):
            plab.Recording("no_such_file.mcap")


if __name__ == "__main__":
    assert lab
    unittest.main()
