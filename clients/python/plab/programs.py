"""pLab's programs as processes of their own, which do not outlive this one."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from .errors import StartFailed


def path_of(program: str) -> str:
    """The one that was installed with this package (PREFIX/bin, PREFIX/lib/python3/dist-packages/plab), or that of PATH."""
    beside = Path(__file__).resolve().parents[4] / "bin" / program
    found = str(beside) if os.access(beside, os.X_OK) else shutil.which(program)
    if found is None:
        raise StartFailed(f"there is no program '{program}', neither {beside} nor in PATH")
    return found


class Program:
    """A running program, whose output is kept. It is told to end when this process ends, however that ends; Ctrl-C does not reach it.

    The kernel does that for the thread that started it: start a program in a thread that lives as long as the program is used.
    """

    def __init__(self, program: str, arguments: Sequence[str], environment: dict[str, str] | None = None) -> None:
        command = [path_of(program), *arguments]
        guard = shutil.which("setpriv")  # of util-linux
        if guard is not None:
            command = [guard, "--pdeathsig", "TERM", "--", *command]
        self.name = program
        self._output = tempfile.TemporaryFile()  # without a name: nothing is left over
        self.process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=self._output, stderr=self._output, env=environment, start_new_session=True
        )

    @property
    def log(self) -> str:
        """What it has printed so far, at most the last megabyte."""
        if self._output.closed:
            return self._kept
        size = os.fstat(self._output.fileno()).st_size
        most = 1 << 20
        return os.pread(self._output.fileno(), most, max(0, size - most)).decode(errors="replace").strip()

    def check(self) -> None:
        """StartFailed, with what it printed, if it has ended with an error."""
        code = self.process.poll()
        if code:
            raise StartFailed(self.log or f"{self.name} ended with exit code {code}")

    def end(self, signal_number: int = signal.SIGTERM, patience: float = 10) -> int:
        """Asks it to end, waits, and kills it if it does not; returns its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal_number)
        try:
            self.process.wait(patience)
        except subprocess.TimeoutExpired:
            self.process.kill()
        finally:
            if self.process.poll() is None:
                # Ctrl-C came while it was ending, or it was killed.
                self.process.kill()
                self.process.wait()
            if not self._output.closed:
                self._kept = self.log
                self._output.close()
        return self.process.returncode
