"""Frames: the state of everything that moves at one moment, as arrays of numpy."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import _native

Array = NDArray[np.float64]

#: The ids of objects by their handles, of one run.
Names = Callable[[int, NDArray[np.uint32]], tuple[str, ...]]

_BODY = 14  # doubles in a row: handle, position, orientation, linear and angular velocity
_SHAFT = 3  # handle, angle, speed


@dataclass(frozen=True, slots=True)
class BodyState:
    position: Array  #: (3,), m
    quaternion: Array  #: (4,), w x y z: body to world
    linear_velocity: Array  #: (3,), m/s, in the world
    angular_velocity: Array  #: (3,), rad/s, in the world


@dataclass(frozen=True, slots=True)
class ShaftState:
    angle: float  #: rad, never wrapped
    speed: float  #: rad/s


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """The state after ``step`` steps. Rows are in the order of ``bodies`` and ``shafts``, which stays the same while ``run`` and
    ``revision`` do; static bodies are left out. Arrays are views of one copy that the frame owns."""

    run: int
    revision: int
    number: int  #: counts the frames that the server sent; a jump is frames that did not arrive
    step: int
    time: float  #: s, simulated
    stamp: float  #: s since 1970, when the step ended
    bodies: tuple[str, ...]  #: ids of the rows of bodies
    shafts: tuple[str, ...]  #: ids of the rows of shafts
    _bodies: Array = field(repr=False)
    _shafts: Array = field(repr=False)

    def __len__(self) -> int:
        return len(self._bodies) + len(self._shafts)

    @property
    def positions(self) -> Array:
        """(n, 3), m, in the world."""
        return self._bodies[:, 1:4]

    @property
    def quaternions(self) -> Array:
        """(n, 4), w x y z: body to world."""
        return self._bodies[:, 4:8]

    @property
    def linear_velocities(self) -> Array:
        """(n, 3), m/s, of the bodies' origins, in the world."""
        return self._bodies[:, 8:11]

    @property
    def angular_velocities(self) -> Array:
        """(n, 3), rad/s, in the world."""
        return self._bodies[:, 11:14]

    @property
    def angles(self) -> Array:
        """(m,), rad, of the shafts; never wrapped."""
        return self._shafts[:, 1]

    @property
    def speeds(self) -> Array:
        """(m,), rad/s, of the shafts."""
        return self._shafts[:, 2]

    def __getitem__(self, id: str) -> BodyState | ShaftState:
        """The state of one object; KeyError: it is not in the frame. ``body`` and ``shaft`` have the narrower types."""
        return self.body(id) if id in self.bodies else self.shaft(id)

    def body(self, id: str) -> BodyState:
        row = self._bodies[self._row(id, self.bodies)]
        return BodyState(row[1:4], row[4:8], row[8:11], row[11:14])

    def shaft(self, id: str) -> ShaftState:
        row = self._shafts[self._row(id, self.shafts)]
        return ShaftState(float(row[1]), float(row[2]))

    @staticmethod
    def _row(id: str, ids: tuple[str, ...]) -> int:
        try:
            return ids.index(id)
        except ValueError:
            raise KeyError(f"'{id}' is not in this frame, which has: {', '.join(ids[:20])}{' ...' if len(ids) > 20 else ''}") from None


def frame_of(raw: _native.Frame, names: Names) -> Frame:
    """Copies what the library holds until its next call."""
    bodies, shafts = _rows(raw.bodies, raw.body_count, _BODY), _rows(raw.shafts, raw.shaft_count, _SHAFT)
    ids = names(raw.run, _handles(bodies)), names(raw.run, _handles(shafts))
    return Frame(raw.run, raw.revision, raw.number, raw.step, raw.time, raw.stamp_ns * 1e-9, *ids, bodies, shafts)


def _handles(rows: Array) -> NDArray[np.uint32]:
    return rows.view(np.uint32)[:, 0]


def _rows(address: int | None, count: int, width: int) -> Array:
    out: Array = np.empty((count, width))
    if address and count:
        ctypes.memmove(out.ctypes.data, address, out.nbytes)
    return out


class NameTable:
    """Ids by handles, from ``load``, which is asked again when a handle is not known. An object that ``load`` does not know yet is "#7"."""

    _MOST = 8  # tables that are kept: of bodies and of shafts, of a few revisions

    def __init__(self, load: Callable[[], dict[tuple[int, int], str]]) -> None:
        self._load = load
        self._ids: dict[tuple[int, int], str] = {}
        self._tables: dict[tuple[int, bytes], tuple[str, ...]] = {}

    @property
    def is_loaded(self) -> bool:
        return bool(self._ids)

    def load(self) -> None:
        """Ids of runs that are over are kept: frames of them may still come."""
        self._ids.update(self._load())

    def __call__(self, run: int, handles: NDArray[np.uint32]) -> tuple[str, ...]:
        key = (run, handles.tobytes())
        known = self._tables.get(key)
        if known is not None:
            return known
        wanted = [(run, int(handle)) for handle in handles]
        if not all(one in self._ids for one in wanted):
            self.load()
        names = tuple(self._ids.get(one, f"#{one[1]}") for one in wanted)
        if all(one in self._ids for one in wanted):
            while len(self._tables) >= self._MOST:
                del self._tables[next(iter(self._tables))]
            self._tables[key] = names
        return names
