"""What the tests of the Python package share."""

from __future__ import annotations

import os
import time
import unittest
from pathlib import Path

# No other test is likely to use it.
os.environ["PLAB_DOMAIN"] = str(20 + os.getpid() % 200)
os.environ.pop("PLAB_SERVER", None)

import plab  # noqa: E402

SOURCES = Path(os.environ["PLAB_SOURCES"])
PAPER = str(SOURCES / "scenes/fan_and_balloons.xml")

BALL = """<plab version="1">
  <scene title="Ball" dt="1/100"/>
  <component id="round" type="Shape/Sphere" radius="0.5"/>
  <component id="ball" type="State/RigidBody" mass="2" shape="round" position="0 0 100"/>
  <component id="weight" type="Field/Gravity" between="ball"/>
</plab>"""


def many_balls(count: int) -> str:
    """Balls that fly apart, without forces."""
    bodies = (
        f'<component id="ball{i}" type="State/RigidBody" mass="1" inertia="1 1 1" position="{i} 0 0" linear_velocity="0 {i % 7} 1"/>'
        for i in range(count)
    )
    return f'<plab version="1"><scene title="Balls" dt="1/100"/>{"".join(bodies)}</plab>'


def processes_of(part: str) -> list[int]:
    """Running processes whose command line has this part."""
    out = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit() and int(folder.name) != os.getpid():
            try:
                line = (folder / "cmdline").read_bytes()
                is_dead = (folder / "stat").read_text().rpartition(")")[2].split()[0] == "Z"
            except OSError:
                continue
            if part.encode() in line and not is_dead:
                out.append(int(folder.name))
    return out


def wait_until(condition, seconds: float = 5) -> bool:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


class LabTest(unittest.TestCase):
    """No process is left over by any test."""

    def setUp(self) -> None:
        self.addCleanup(self.check_nothing_is_left)  # the last of all

    def check_nothing_is_left(self) -> None:
        mine = f"python_{os.getpid()}_"
        self.assertTrue(wait_until(lambda: not processes_of(mine)), f"left over: {processes_of(mine)}")

    def start(self, scene: str = BALL, **options: object) -> plab.Server:
        server = plab.Server.start(scene, **options)
        self.addCleanup(server.close)
        return server

    def session(self, scene: str = BALL, **options: object) -> plab.Session:
        session = self.start(scene, **options).session()
        self.addCleanup(session.close)
        return session
