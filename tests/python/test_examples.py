"""The examples, and the code that server/docs/python.md and README.md show, run as they stand."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from importlib.util import find_spec
from pathlib import Path

import lab

EXAMPLES = lab.SOURCES / "clients/python/examples"


def run(script: Path, *arguments: str) -> str:
    """What it prints; from the folder above the scenes, as the documents say."""
    environment = os.environ | {"MPLBACKEND": "Agg"}
    done = subprocess.run(
        [sys.executable, script, *arguments], cwd=lab.SOURCES, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    if done.returncode != 0:
        raise AssertionError(f"{script}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


class ExamplesTest(lab.LabTest):
    def setUp(self):
        super().setUp()
        self.folder = Path(os.environ.get("PLAB_PICTURES") or tempfile.mkdtemp(prefix="plab_examples_"))
        self.folder.mkdir(exist_ok=True)

    def draw(self, name: str) -> str:
        if find_spec("matplotlib") is None:
            self.skipTest("no matplotlib here (Debian: python3-matplotlib)")
        picture = self.folder / f"{name}.png"
        said = run(EXAMPLES / f"{name}.py", str(picture))
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        return said

    def test_levels_of_detail_in_about_twenty_lines(self):
        self.draw("levels")
        text = (EXAMPLES / "levels.py").read_text()
        code = [line for line in text.splitlines() if line.strip() and not line.startswith(("#", '"""', "import"))]
        self.assertLess(len(code), 26)

    def test_a_sweep_shows_the_order_of_each_solver(self):
        errors: dict[str, list[float]] = {}
        for solver, error in re.findall(r"^(\w+) +dt 1/\d+ +error ([\d.e+-]+) m", self.draw("sweep"), re.MULTILINE):
            errors.setdefault(solver, []).append(float(error))
        self.assertEqual(len(errors), 4)
        for solver, order in (("SemiImplicitEuler", 1), ("StoermerVerlet", 2), ("RungeKutta4", 4)):
            coarse, fine = errors[solver][-2:]
            self.assertAlmostEqual(fine / coarse, 0.5**order, delta=0.25 * 0.5**order, msg=solver)

    def test_boxes_are_weighed_by_their_contacts(self):
        carried, weight = map(float, re.findall(r"([\d.]+) N", run(EXAMPLES / "weigh.py").splitlines()[0]))
        self.assertAlmostEqual(carried, weight, delta=1e-3 * weight)

    def test_an_exchange_in_a_recording(self):
        if find_spec("pandas") is None:
            self.skipTest("no pandas here (Debian: python3-pandas)")
        with tempfile.TemporaryDirectory() as folder:
            said = run(EXAMPLES / "swap_and_record.py", f"{folder}/run.mcap")
        self.assertIn("before step 600 (2.50 s)", said)
        self.assertRegex(said, r"green +2\.2\d* ")


class DocumentsTest(lab.LabTest):
    def test_shown_code_runs(self):
        blocks = []
        for page in ("server/docs/python.md", "README.md"):
            text = (lab.SOURCES / page).read_text()
            blocks += [(page, code) for code in re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)]
        self.assertGreater(len(blocks), 3)
        for page, code in blocks:
            with self.subTest(page=page, code=code[:60]), tempfile.TemporaryDirectory() as folder:
                if "matplotlib" in code and find_spec("matplotlib") is None or "dataframe" in code and find_spec("pandas") is None:
                    continue
                script = Path(folder) / "shown.py"
                # Files that the page names are made in a folder of their own.
                script.write_text(code.replace('"run.mcap"', f'"{folder}/run.mcap"'))
                run(script)


if __name__ == "__main__":
    unittest.main()
