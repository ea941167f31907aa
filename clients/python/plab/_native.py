"""The library beside this file (clients/python/native/library.h), through ctypes. Nothing else calls it.

ctypes releases the interpreter's lock during a call. A call that waits does so for a slice at most, so that Ctrl-C is noticed between two.
"""

from __future__ import annotations

import ctypes
import json
import math
import time
from collections.abc import Callable, Iterator
from ctypes import POINTER, Structure, c_char_p, c_double, c_int, c_int64, c_size_t, c_uint, c_uint64, c_void_p
from pathlib import Path
from typing import Any

from .errors import PlabError

SLICE = 0.1  # s, how late Ctrl-C may be noticed


class NamedText(Structure):
    _fields_ = [("name", c_char_p), ("text", c_char_p)]


class Operation(Structure):
    _fields_ = [
        ("verb", c_char_p),
        ("target", c_char_p),
        ("argument", c_char_p),
        ("blueprint", c_char_p),
        ("values", POINTER(NamedText)),
        ("value_count", c_size_t),
    ]


class Frame(Structure):
    _fields_ = [
        ("run", c_uint64),
        ("revision", c_uint64),
        ("number", c_uint64),
        ("step", c_int64),
        ("time", c_double),
        ("stamp_ns", c_int64),
        ("bodies", c_void_p),
        ("body_count", c_size_t),
        ("shafts", c_void_p),
        ("shaft_count", c_size_t),
    ]


class Message(Structure):
    _fields_ = [("topic", c_char_p), ("time", c_double), ("text", c_char_p), ("frame", Frame)]


PART_SERVER, PART_SCENE, PART_OBJECTS, PART_SHAPES, PART_INTERACTIONS, PART_TYPES, PART_METRICS = (1 << i for i in range(7))

_PROTOTYPES: dict[str, tuple[Any, list[Any]]] = {
    "version": (c_char_p, []),
    "error": (c_char_p, []),
    "join": (c_void_p, [c_char_p, c_int, c_char_p]),
    "find": (c_int, [c_void_p, c_double]),
    "connect": (c_int, [c_void_p, c_double]),
    "server": (c_char_p, [c_void_p]),
    "servers": (c_char_p, [c_void_p, c_double]),
    "request": (c_int, [c_void_p, POINTER(Operation), c_size_t, c_int64, c_int64]),
    "reply": (c_char_p, [c_void_p, c_double]),
    "last_request": (c_char_p, [c_void_p]),
    "leave": (None, [c_void_p]),
    "catalogue_open": (c_void_p, [c_void_p, c_uint]),
    "catalogue_fetch": (c_int, [c_void_p, c_double]),
    "catalogue_text": (c_char_p, [c_void_p, c_uint]),
    "catalogue_names": (c_char_p, [c_void_p]),
    "catalogue_close": (None, [c_void_p]),
    "frames_open": (c_void_p, [c_void_p]),
    "frames_next": (c_int, [c_void_p, c_double, POINTER(Frame)]),
    "frames_writers": (c_uint, [c_void_p]),
    "frames_close": (None, [c_void_p]),
    "entries_open": (c_void_p, [c_void_p, c_char_p]),
    "entries_next": (c_char_p, [c_void_p, c_double]),
    "entries_missing": (c_uint64, [c_void_p]),
    "entries_writers": (c_uint, [c_void_p]),
    "entries_close": (None, [c_void_p]),
    "recording_open": (c_void_p, [c_char_p]),
    "recording_about": (c_char_p, [c_void_p]),
    "recording_select": (c_int, [c_void_p, POINTER(c_char_p), c_size_t, c_double, c_double]),
    "recording_next": (c_int, [c_void_p, POINTER(Message)]),
    "recording_close": (None, [c_void_p]),
}


def _load() -> dict[str, Callable[..., Any]]:
    path = Path(__file__).with_name("libplab_python.so")
    try:
        library = ctypes.CDLL(str(path))
    except OSError as why:
        raise ImportError(f"plab: {path} cannot be loaded: {why}") from why
    functions = {}
    for name, (result, arguments) in _PROTOTYPES.items():
        function = getattr(library, "plab_" + name)
        function.restype, function.argtypes = result, arguments
        functions[name] = function
    return functions


_functions = _load()


def call(name: str, *arguments: Any) -> Any:
    """The result; where the function failed, PlabError with its reason."""
    result = _functions[name](*arguments)
    if result is None and _PROTOTYPES[name][0] is not None or result == -1 and _PROTOTYPES[name][0] is c_int:
        raise PlabError(error())
    return result


def error() -> str:
    return str(_functions["error"](), "utf-8")


def parse(text: bytes) -> Any:
    return json.loads(text)


def slices(timeout: float) -> Iterator[float]:
    """Waiting times that add up to ``timeout`` seconds at most; at least one, perhaps 0."""
    end = time.monotonic() + (timeout if math.isfinite(timeout) else 1e8)
    while True:
        left = end - time.monotonic()
        yield min(max(left, 0.0), SLICE)
        if end <= time.monotonic():
            return


class Handle:
    """Something that the library opened, with its functions: ``handle.next(0.1)`` calls ``plab_frames_next(handle, 0.1)``."""

    def __init__(self, kind: str, pointer: int | None, close: str) -> None:
        self._kind, self._pointer, self._close = kind, pointer, close

    def __getattr__(self, name: str) -> Callable[..., Any]:
        return lambda *arguments: self.call(self._kind + name, *arguments)

    def call(self, name: str, *arguments: Any) -> Any:
        if self._pointer is None:
            raise PlabError("this is closed")
        return call(name, self._pointer, *arguments)

    @property
    def pointer(self) -> int:
        if self._pointer is None:
            raise PlabError("this is closed")
        return self._pointer

    def close(self) -> None:
        pointer, self._pointer = self._pointer, None
        if pointer is not None:
            _functions[self._close](pointer)

    def __del__(self) -> None:
        self.close()
