"""Tables for pandas."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .frames import Frame

if TYPE_CHECKING:
    import pandas

_BODY_COLUMNS = ["x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]
_SHAFT_COLUMNS = ["angle", "speed"]


def to_dataframe(things: Iterable[Any] | Mapping[str, Any]) -> pandas.DataFrame:
    """A table of frames, or of any dataclasses of this package (events, collisions, swaps; dictionaries of components, levels ...).

    Frames: a row for each object of each frame, with the columns run, step, time (s), id, and x y z (m), qw qx qy qz, vx vy vz (m/s),
    wx wy wz (rad/s) of bodies, angle (rad) and speed (rad/s) of shafts; NaN where an object has none. Others: a row for each, a column for
    each field; vectors have a column for each component (momentum_x). Needs pandas (Debian: python3-pandas).
    """
    try:
        import pandas
    except ImportError as why:
        raise ImportError("plab.to_dataframe needs pandas, which is not installed (Debian: apt install python3-pandas)") from why
    rows = list(things.values() if isinstance(things, Mapping) else things)
    if rows and isinstance(rows[0], Frame):
        return _frames_table(rows, pandas)
    return pandas.DataFrame([_flat(dataclasses.asdict(row)) for row in rows])


def _frames_table(frames: list[Frame], pandas: Any) -> pandas.DataFrame:
    counts = [len(frame) for frame in frames]
    numbers = np.full((sum(counts), len(_BODY_COLUMNS) + len(_SHAFT_COLUMNS)), np.nan)
    ids: list[str] = []
    at = 0
    for frame in frames:
        bodies, shafts = len(frame.positions), len(frame.angles)
        numbers[at : at + bodies, : len(_BODY_COLUMNS)] = frame._bodies[:, 1:]
        numbers[at + bodies : at + bodies + shafts, len(_BODY_COLUMNS) :] = frame._shafts[:, 1:]
        ids += [*frame.bodies, *frame.shafts]
        at += bodies + shafts
    table = pandas.DataFrame(numbers, columns=_BODY_COLUMNS + _SHAFT_COLUMNS)
    table.insert(0, "id", pandas.Categorical(ids))
    for name in ("time", "step", "run"):
        table.insert(0, name, np.repeat([getattr(frame, name) for frame in frames], counts))
    return table


def _flat(row: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    out: dict[str, Any] = {}
    for name, value in row.items():
        if isinstance(value, tuple) and len(value) in (3, 4):
            letters = "xyz" if len(value) == 3 else "wxyz"
            out.update({f"{prefix}{name}_{letter}": one for letter, one in zip(letters, value, strict=True)})
        elif dataclasses.is_dataclass(value) or isinstance(value, Mapping) and name in ("energy", "with_old", "with_new"):
            out.update(_flat(value, f"{prefix}{name}_"))
        else:
            out[prefix + name] = value
    return out
