"""What a server sends, as iterators."""

from __future__ import annotations

import ctypes
import time
import warnings
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from . import _native
from .errors import MissedWarning, NoReply, ServerGone
from .frames import Frame, frame_of

if TYPE_CHECKING:
    from .session import Session

T = TypeVar("T")

GONE_AFTER = 2.0  # s without a writer: plab-bus may have been started again, which takes less


class Stream(Generic[T]):
    """An iterator that waits for what comes next.

    It ends at its ``until``, or when a server of one's own (``Server.start``) has ended by itself. ServerGone: another server has ended,
    or one was killed. NoReply: nothing came for ``timeout`` s, for instance because the server is paused. ``close`` unsubscribes.
    """

    _what = ""

    def __init__(self, session: Session, handle: _native.Handle, timeout: float | None) -> None:
        self._session, self._handle = session, handle
        self._timeout = float("inf") if timeout is None else timeout
        session._opened.add(self)

    def _take(self, slice: float) -> T | None:
        raise NotImplementedError

    def _next(self) -> T | None:
        """None: the server has ended as it should."""
        seen = time.monotonic()
        for slice in _native.slices(self._timeout):
            has_ended = self._session.has_ended()
            out = self._take(0.0 if has_ended else slice)
            if out is not None:
                return out
            if has_ended:
                self._session.check_end()
                return None
            if self._handle.writers() > 0:
                seen = time.monotonic()
            elif time.monotonic() - seen > GONE_AFTER:
                raise ServerGone(f"server '{self._session.server}' has gone")
        raise NoReply(f"server '{self._session.server}' sent no {self._what} within {self._timeout} s")

    def __iter__(self) -> Iterator[T]:
        return self

    def __next__(self) -> T:
        out = self._next()
        if out is None:
            raise StopIteration
        return out

    def close(self) -> None:
        self._handle.close()
        self._session._opened.discard(self)

    def __enter__(self) -> Stream[T]:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


class FrameStream(Stream[Frame]):
    """Frames in their order; of a reader that is slow the newest few are kept, and ``Frame.number`` jumps."""

    _what = "frame"

    def __init__(self, session: Session, timeout: float | None, until: float | None = None) -> None:
        handle = _native.Handle("frames_", _native.call("frames_open", session._handle.pointer), "frames_close")
        super().__init__(session, handle, timeout)
        if not session._names.is_loaded:
            session._names.load()
        self._raw = _native.Frame()
        self._until = until
        self._is_over = False

    def _take(self, slice: float) -> Frame | None:
        if not self._handle.next(slice, ctypes.byref(self._raw)):
            return None
        return frame_of(self._raw, self._session._names)

    def __next__(self) -> Frame:
        if self._is_over:
            raise StopIteration
        frame = super().__next__()
        self._is_over = self._until is not None and frame.time >= self._until
        return frame

    def wait_for(self, run: int, step: int, timeout: float) -> Frame:
        """The frame of this step; ``timeout`` begins again with each frame that comes before it."""
        self._timeout = timeout
        while True:
            frame = self._next()
            if frame is None:
                raise ServerGone(f"server '{self._session.server}' ended before step {step}")
            if frame.run == run and frame.step >= step or frame.run > run:
                return frame


class EntryStream(Stream[T]):
    """Events or collisions, all of them: what did not arrive is told by a MissedWarning. Contacts: the newest ones."""

    def __init__(self, session: Session, topic: str, make: Callable[[Any], T], timeout: float | None) -> None:
        handle = _native.Handle("entries_", _native.call("entries_open", session._handle.pointer, topic.encode()), "entries_close")
        super().__init__(session, handle, timeout)
        self._what, self._make = topic.removeprefix("plab/"), make
        self._missing = 0

    def _take(self, slice: float) -> T | None:
        text = self._handle.next(slice)
        missing = self._handle.missing()
        if missing > self._missing:
            warnings.warn(f"{missing - self._missing} {self._what} did not arrive", MissedWarning, stacklevel=4)
            self._missing = missing
        return self._make(_native.parse(text)) if text else None
