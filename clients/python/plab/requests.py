"""Requests in the words of server/docs/requests.md."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from . import _native
from .values import Operation

#: What a parameter may be given as: a number, a truth value, numbers in order, or text with a unit ("0.5 rad", "1/240").
Value = float | bool | str | Iterable[float]


def text_of(value: Value) -> str:
    """As a blueprint has it. Numbers keep all their bits."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, Iterable):
        return " ".join(text_of(one) for one in value)
    number = float(value)  # also of a number of numpy
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def texts_of(values: Mapping[str, Value]) -> dict[str, str]:
    return {name: text_of(value) for name, value in values.items()}


def blueprint_of(source: str | os.PathLike[str]) -> tuple[str, str]:
    """A blueprint, and the file's name for messages: of a file, or of text that begins with "<"."""
    text = os.fspath(source)
    if text.lstrip().startswith("<"):
        return text, ""
    return Path(text).read_text(encoding="utf-8"), text


def swap_operations(
    id: str, type: str, values: Mapping[str, Value], trial: float | str | None, allow_energy: float | str | None
) -> list[Operation]:
    out = []
    if trial is not None:
        out.append(Operation("trial", argument=trial if isinstance(trial, str) else f"{text_of(trial * 1e3)} ms"))
    if allow_energy is not None:
        out.append(Operation("energy", argument=text_of(allow_energy)))
    return [*out, Operation("swap", target=id, argument=type, values=texts_of(values))]


def encode(operations: Sequence[Operation]) -> tuple[Any, list[Any]]:
    """An array for the library, and what has to live as long."""
    array = (_native.Operation * len(operations))()
    kept: list[Any] = []
    for out, operation in zip(array, operations, strict=True):
        out.verb, out.target = operation.verb.encode(), operation.target.encode()
        out.argument, out.blueprint = operation.argument.encode(), operation.blueprint.encode()
        values = (_native.NamedText * len(operation.values))()
        for value, (name, text) in zip(values, operation.values.items(), strict=True):
            value.name, value.text = name.encode(), text.encode()
        out.values, out.value_count = ctypes.cast(values, ctypes.POINTER(_native.NamedText)), len(values)
        kept.append(values)
    return array, kept
