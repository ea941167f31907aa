"""Reads recordings (MCAP, server/docs/recording.md), without a server."""

from __future__ import annotations

import ctypes
import os
import warnings
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from . import _native
from .errors import MissedWarning, PlabError
from .frames import Frame, NameTable, frame_of
from .tables import to_dataframe
from .values import Collision, Event, Metrics

if TYPE_CHECKING:
    import pandas

T = TypeVar("T")

_STATES, _OBJECTS = b"plab/states", b"plab/objects"


class Recording:
    """``with plab.Recording("run.mcap") as recording: for frame in recording.frames(): ...``

    ``since`` and ``until`` are seconds of the recording's time line: simulated time that continues where a new run begins at zero. What is
    damaged is left out, and told by a MissedWarning. One iterator at a time: a new one ends the one before.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        self._handle = _native.Handle("recording_", _native.call("recording_open", self.path.encode()), "recording_close")
        self._reading = 0  # counts iterators
        self._ids: dict[tuple[int, int], str] = {}
        self._names = NameTable(lambda: dict(self._ids))

    @property
    def about(self) -> dict[str, str]:
        """What the file says of its origin: server, version, scene_file, dt ..."""
        out: dict[str, str] = _native.parse(self._handle.about())
        return out

    def frames(self, *, since: float = 0, until: float = float("inf")) -> Iterator[Frame]:
        """States in the order of their time, complete also where the file has only what moved."""
        for message in self._messages([_OBJECTS, _STATES], 0, until):
            if message.topic == _OBJECTS:
                # Objects that were there before ``since`` have names as well.
                data = _native.parse(message.text)
                self._ids[(data["run"], data["handle"])] = data["id"]
            elif message.time >= since:
                yield frame_of(message.frame, self._names)

    def events(self, *, since: float = 0, until: float = float("inf")) -> Iterator[Event]:
        return self._entries(b"plab/events", Event._of, since, until)

    def collisions(self, *, since: float = 0, until: float = float("inf")) -> Iterator[Collision]:
        return self._entries(b"plab/collisions", Collision._of, since, until)

    def metrics(self, *, since: float = 0, until: float = float("inf")) -> Iterator[Metrics]:
        for message in self._messages([b"plab/metrics"], since, until):
            yield Metrics._of(_native.parse(message.text))

    def to_dataframe(self, *, since: float = 0, until: float = float("inf")) -> pandas.DataFrame:
        """The frames as a table, see ``plab.to_dataframe``."""
        return to_dataframe(self.frames(since=since, until=until))

    def _entries(self, topic: bytes, make: Callable[[Any], T], since: float, until: float) -> Iterator[T]:
        for message in self._messages([topic], since, until):
            for entry in _native.parse(message.text):
                yield make(entry)

    def _messages(self, topics: list[bytes], since: float, until: float) -> Iterator[_native.Message]:
        self._reading += 1
        mine = self._reading
        array = (ctypes.c_char_p * len(topics))(*topics)
        self._handle.select(array, len(topics), since, min(until, 9e9))
        message = _native.Message()
        while mine == self._reading:
            try:
                if not self._handle.next(ctypes.byref(message)):
                    return
            except PlabError as why:
                warnings.warn(str(why), MissedWarning, stacklevel=3)
                continue
            yield message

    def close(self) -> None:
        self._reading += 1
        self._handle.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<plab.Recording {self.path}>"
