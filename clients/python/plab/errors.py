"""What goes wrong, as exceptions. Each carries the server's own words."""

from __future__ import annotations

from collections.abc import Sequence


class PlabError(Exception):
    """Base of all exceptions of this package."""


class NoServer(PlabError):
    """No server of that name was found in time; the text lists those that are there."""


class ServerGone(PlabError):
    """The server has ended, or is silent for so long that it counts as ended."""


class NoReply(PlabError, TimeoutError):
    """Nothing came within the time-out. A request may still be carried out: ``request`` is its name, for ``Session.cancel``."""

    def __init__(self, text: str, request: str = "") -> None:
        super().__init__(text)
        self.request = request


class Refused(PlabError):
    """The server refused a request; nothing has changed. ``reasons`` are all its reasons."""

    def __init__(self, reasons: Sequence[str], step: int) -> None:
        self.reasons = list(reasons) or ["the server gave no reason"]
        self.step = step
        super().__init__("\n".join(self.reasons))


class Late(Refused):
    """The step that the request named has passed; nothing has changed."""


class StartFailed(PlabError):
    """A program of pLab did not start, or ended with an error; the text is what it printed."""


class MissedWarning(UserWarning):
    """Data did not arrive, or part of a file is damaged; the text says how much."""
