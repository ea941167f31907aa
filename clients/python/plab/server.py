"""A server of one's own: plabd as a process that ends with its context."""

from __future__ import annotations

import itertools
import os
import subprocess
import tempfile
import time
from collections.abc import Iterable
from types import TracebackType
from typing import IO

from .errors import NoServer
from .programs import Program
from .session import Session

_numbers = itertools.count(1)


class Server:
    """A plabd that this process started. ``with Server.start(scene) as server, server.session() as session: ...``"""

    def __init__(self, program: Program, name: str, domain: int, scene_file: IO[str] | None) -> None:
        self._program, self._scene_file = program, scene_file
        self.name, self.domain = name, domain

    @classmethod
    def start(
        cls,
        scene: str | os.PathLike[str],
        *,
        name: str | None = None,
        domain: int | None = None,
        rate: float | str = "max",
        paused: bool = True,
        until: float | None = None,
        states: float | str = 60,
        threads: int = 1,
        record: str | os.PathLike[str] | None = None,
        options: Iterable[str] = (),
        timeout: float = 30,
    ) -> Server:
        """Starts plabd and waits until it takes requests.

        scene: a file (a blueprint, URDF or MJCF; installed scenes are found by their names), or the text of a blueprint, "<plab ...".
        name, domain: on the bus; by default a name that nobody else has, and PLAB_DOMAIN or 0. It listens on loopback only.
        rate: simulated seconds per second, "real" or "max".
        paused: the scene waits at step 0 for ``Session.step`` or ``Session.resume``.
        until: s, simulated: the server ends there.
        states: frames per second of real time, or "all" for one of each step. A step while paused always sends one.
        record: a file; the server records the run itself, from step 0.
        options: further options of plabd (``plabd --help``).
        timeout: s to wait for it. StartFailed has what plabd printed, for instance the errors of the scene with line and column.
        """
        name = name or f"python_{os.getpid()}_{next(_numbers)}"
        domain = int(os.environ.get("PLAB_DOMAIN") or 0) if domain is None else domain
        file = None
        text = os.fspath(scene)
        if text.lstrip().startswith("<"):
            file = tempfile.NamedTemporaryFile("w", prefix="plab_", suffix=".xml", encoding="utf-8")
            file.write(text)
            file.flush()
            text = file.name
        arguments = [text, "--name", name, "--domain", str(domain), "--rate", str(rate), "--states", str(states), "--threads", str(threads)]
        arguments += ["--paused"] if paused else []
        arguments += ["--until", str(until)] if until is not None else []
        arguments += ["--record", os.fspath(record)] if record is not None else []
        environment = {key: value for key, value in os.environ.items() if key not in ("PLAB_INTERFACE", "PLAB_SERVER", "PLAB_DOMAIN")}
        server = cls(Program("plabd", [*arguments, *options], environment), name, domain, file)
        try:
            server._wait_until_ready(timeout)
        except BaseException:
            server.close()
            raise
        return server

    def _wait_until_ready(self, timeout: float) -> None:
        end = time.monotonic() + timeout
        while " ready after " not in self._program.log:
            self._program.check()
            if self._program.process.poll() is not None:
                return  # it has ended at its time already
            if time.monotonic() > end:
                raise NoServer(f"plabd is not ready after {timeout} s\n{self.log}")
            time.sleep(0.01)

    def session(self, timeout: float = 10) -> Session:
        """Joins this server. Several sessions are several clients."""
        return Session(self.name, domain=self.domain, interface="", timeout=timeout, own=self)

    @property
    def process(self) -> int:
        """Process id."""
        return self._program.process.pid

    @property
    def log(self) -> str:
        """What plabd has printed so far."""
        return self._program.log

    @property
    def exit_code(self) -> int | None:
        """None: it is running."""
        return self._program.process.poll()

    def wait(self, timeout: float | None = None) -> int:
        """Waits until it ends by itself (``until``, ``Session.shutdown``); returns its exit code. TimeoutError after ``timeout`` s."""
        try:
            return self._program.process.wait(timeout)
        except subprocess.TimeoutExpired:
            raise TimeoutError(f"server '{self.name}' is still running after {timeout} s") from None

    def close(self) -> None:
        """Ends it: the step in progress is finished, and files are complete."""
        self._program.end()
        if self._scene_file is not None:
            self._scene_file.close()

    def __enter__(self) -> Server:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "running" if self.exit_code is None else f"ended with {self.exit_code}"
        return f"<plab.Server {self.name}, process {self.process}, {state}>"
