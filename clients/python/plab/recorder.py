"""Recording beside a session."""

from __future__ import annotations

import os
import signal
import time
import warnings
from types import TracebackType

from . import _native
from .errors import MissedWarning, NoReply, PlabError, StartFailed
from .programs import Program
from .recording import Recording

_COMPLETE = (0, 130)  # it ended by itself, or by the signal that close() sends
_WITH_GAPS = 5
_UNDER_WAY = 0.1  # s: what the server has sent may reach this process before it reaches the recorder


class Recorder:
    """``plabctl record`` as a process: ``with session.record("run.mcap"): ...`` After the block the file is complete."""

    def __init__(
        self, path: str | os.PathLike[str], place: list[str], state_rate: float | None, overwrite: bool, timeout: float
    ) -> None:
        self.path = os.fspath(path)
        self._is_closed = False
        if os.path.exists(self.path):
            if not overwrite:
                raise StartFailed(f"{self.path} is there already; overwrite=True replaces it")
            os.unlink(self.path)
        arguments = ["record", "--output", self.path, *place]
        arguments += ["--state-rate", str(state_rate)] if state_rate is not None else []
        self._program = Program("plabctl", arguments)
        try:
            self._wait_for_first_frame(timeout)
        except BaseException:
            self._program.end()
            raise

    def _wait_for_first_frame(self, timeout: float) -> None:
        for slice in _native.slices(timeout):
            time.sleep(min(slice, 0.02))
            self._program.check()
            if self._has_frame():
                return
        raise NoReply(f"nothing was recorded within {timeout} s\n{self._program.log}".strip())

    def _has_frame(self) -> bool:
        try:
            with Recording(self.path) as recording:
                return next(iter(recording.frames()), None) is not None
        except PlabError:
            return False  # the file is not there yet, or no chunk of it

    def close(self) -> None:
        """Completes the file. StartFailed: it could not; MissedWarning: it has gaps."""
        if self._is_closed:
            return
        self._is_closed = True
        time.sleep(_UNDER_WAY)
        code = self._program.end(signal.SIGINT)
        if code == _WITH_GAPS:
            warnings.warn(f"{self.path} has gaps: {self._program.log}", MissedWarning, stacklevel=2)
        elif code not in _COMPLETE:
            raise StartFailed(f"{self.path} is not complete: {self._program.log or f'plabctl ended with exit code {code}'}")

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()
