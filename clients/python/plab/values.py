"""What a server says, as dataclasses: SI units, radians; vectors are tuples (x, y, z), rotations unit quaternions (w, x, y, z) that turn
vectors of the body into the world. Meanings are those of idl/plab.idl."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


def _number(value: float | None) -> float:
    """JSON has no number that is not finite."""
    return float("nan") if value is None else float(value)


def _vector(values: list[float | None]) -> Vector:
    x, y, z = (_number(v) for v in values)
    return (x, y, z)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A field of a component: ``text`` in SI without its ``unit``; ``kind`` "param", "state", "output", "level", "made" or "account"."""

    text: str
    unit: str
    kind: str

    @property
    def value(self) -> float | tuple[float, ...] | bool | str:
        """A number, a tuple of numbers, a truth value, or the text."""
        if self.text in ("true", "false"):
            return self.text == "true"
        try:
            numbers = tuple(float(word) for word in self.text.split())
        except ValueError:
            return self.text
        return numbers[0] if len(numbers) == 1 else numbers or self.text


def _parameters(data: Mapping[str, Any]) -> dict[str, Parameter]:
    return {name: Parameter(p["text"], p["unit"], p["kind"]) for name, p in data.items()}


@dataclass(frozen=True, slots=True)
class Component:
    """A body or a shaft."""

    id: str
    name: str
    type: str
    kind: str  #: "body" or "shaft"
    motion: str  #: "static", "kinematic", "dynamic"
    mass: float  #: kg; of a shaft its inertia, kg m^2
    position: Vector  #: m, when the catalogue was written; frames have what moves
    orientation: Quaternion
    shapes: list[str]
    handle: int  #: names it in frames; never reused within a run
    run: int
    quarantined: bool
    parameters: dict[str, Parameter]

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Component:
        mass = data["inertia"] if data["kind"] == "shaft" else data["mass"]
        w, x, y, z = (_number(v) for v in data["orientation"])
        return Component(
            data["id"], data["name"], data["type"], data["kind"], data["motion"], _number(mass), _vector(data["position"]), (w, x, y, z),
            data["shapes"], data["handle"], data["run"], data["quarantined"], _parameters(data["parameters"]),
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Interaction:
    """A component that is neither object nor shape: a constraint, a field, a detection, a solver, a response ..."""

    id: str
    name: str
    type: str  #: the algorithm
    family: str  #: it can be exchanged within this family
    since: int  #: step at which this algorithm became active
    roles: dict[str, list[str]]  #: ids of its participants
    run: int
    quarantined: bool
    parameters: dict[str, Parameter]

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Interaction:
        return Interaction(
            data["id"], data["name"], data["type"], data["family"], data["since"], data["roles"], data["run"], data["quarantined"],
            _parameters(data["parameters"]),
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Type:
    """A type that can be added or swapped in, loaded or not."""

    name: str
    family: str
    doc: str
    plugin: str
    loaded: bool
    order: int  #: of convergence; 0: none
    accuracy: str
    strengths: str
    cost: str
    limits: str
    source: str
    roles: list[dict[str, Any]]  #: name, accepts, least, most (None: any number), doc
    fields: list[dict[str, Any]]  #: name, kind, value_type, unit, fallback, required, rule, doc

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Type:
        return Type(**data)


@dataclass(frozen=True, slots=True)
class Level:
    """What a governor chose for a component, and why."""

    id: str
    governor: str
    level: int  #: 0: the cheapest; -1: not on the ladder
    levels: int
    algorithm: str
    reason: str
    since: float  #: s; NaN: not known
    error: float  #: as the governor measured it, in ``unit``; NaN: it measures none
    unit: str
    before: str = ""  #: the level that it had before; what follows is NaN where it is unknown
    cost_before: float = math.nan  #: s, of a step
    cost_after: float = math.nan
    error_before: float = math.nan  #: in ``change_unit``
    error_after: float = math.nan
    change_unit: str = ""

    @staticmethod
    def _of(id: str, parameters: Mapping[str, Parameter]) -> Level | None:
        def text(name: str) -> str:
            p = parameters.get(name)
            return p.text if p and p.kind == "level" else ""

        def number(name: str) -> float:
            return float(text(name) or "nan")

        if not text("governor"):
            return None
        unit = parameters["level_error"].unit if text("level_error") else ""
        errors = [parameters[name].unit for name in ("level_error_before", "level_error_after") if text(name)]
        change_unit = errors[0] if errors else ""
        return Level(
            id, text("governor"), int(text("level") or -1), int(text("levels") or 0), text("level_algorithm"), text("level_reason"),
            number("level_since"), number("level_error"), unit, text("level_before"), number("level_cost_before"),
            number("level_cost_after"), number("level_error_before"), number("level_error_after"), change_unit,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class InteractionMetrics:
    requested: str  #: algorithm that the scene or a request named
    resolved: str  #: the algorithm that does the work, and why if it differs
    cost: float  #: s of processor time per step, median of the last steps; 0 before the first
    error: float | None  #: in ``error_unit``; None: not known
    error_unit: str
    work: float  #: J done on the scene since the run began
    outputs: dict[str, Parameter]

    @staticmethod
    def _of(data: Mapping[str, Any]) -> InteractionMetrics:
        outputs = _parameters(data["outputs"])
        known = outputs.get("error")
        is_known = known is not None and known.kind == "account"
        return InteractionMetrics(
            data["requested"], data["resolved"], _number(data["cost_ns"]) * 1e-9, _number(data["error"]) if is_known else None,
            known.unit if known and is_known else "", _number(data["work"]), outputs,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Energy:
    """J."""

    kinetic: float
    stored: float
    work: float  #: by all interactions since the run began
    of_requests: float  #: part of work: what sets, pushes and swaps changed at once
    unexplained: float  #: kinetic - kinetic at start - work


@dataclass(frozen=True, slots=True)
class Metrics:
    run: int
    revision: int
    step: int
    time: float  #: s, simulated
    step_time: float  #: s of processor time per step, median of the last steps; 0 until the first of a run
    real_time_factor: float  #: 0 until known
    energy: Energy
    momentum: Vector  #: N s
    angular_momentum: Vector  #: N m s, about the world's origin
    residual: float  #: m/s, left over by contact responses in the last step
    deepest: float  #: m, penetration at the end of the last step
    contacts: int  #: pairs in contact
    interactions: dict[str, InteractionMetrics]

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Metrics:
        energy = Energy(**{name: _number(value) for name, value in data["energy"].items()})
        return Metrics(
            data["run"], data["revision"], data["step"], _number(data["time"]), _number(data["step_ns"]) * 1e-9,
            _number(data["real_time_factor"]), energy, _vector(data["momentum"]), _vector(data["angular_momentum"]),
            _number(data["residual"]), _number(data["deepest"]), data["contacts"],
            {id: InteractionMetrics._of(m) for id, m in data["interactions"].items()},
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened: ``kind`` is dotted ("request.swap", "script.print"), ``severity`` "info", "warning" or "failure"."""

    run: int
    number: int  #: counts without gaps
    step: int
    time: float  #: s, simulated
    kind: str
    severity: str
    component: str
    a: str
    b: str
    message: str
    values: list[float]

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Event:
        return Event(
            data["run"], data["sequence_number"], data["step"], _number(data["time"]), data["kind"], data["severity"], data["component"],
            data["a"], data["b"], data["message"], [_number(v) for v in data["values"]],
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Collision:
    run: int
    number: int  #: counts without gaps
    step: int
    time: float  #: s, inside the step
    kind: str  #: "begin", "impact", "rest", "end"
    detector: str
    a: str
    b: str
    position: Vector  #: m
    normal: Vector  #: from a to b
    impulse: Vector  #: N s, on b
    depth: float  #: m

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Collision:
        return Collision(
            data["run"], data["sequence_number"], data["step"], _number(data["time"]), data["kind"], data["detector"], data["a"], data["b"],
            _vector(data["position"]), _vector(data["normal"]), _vector(data["impulse"]), _number(data["depth"]),
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class ContactPoint:
    """Where two bodies touch, with the forces on ``b``; those on ``a`` are the opposite."""

    a: str
    b: str
    detector: str
    position: Vector  #: m
    normal: Vector  #: from a to b
    depth: float  #: m; below 0: a gap
    normal_force: float  #: N, along the normal
    friction_force: Vector  #: N, across the normal
    is_impact: bool  #: they met here in this step
    asleep: bool  #: the forces are those of the last step before they fell asleep

    def force_on(self, body: str) -> Vector:
        """N; zero if the body is neither of the two."""
        sign = 1 if body == self.b else -1 if body == self.a else 0
        return tuple(sign * (self.normal_force * n + f) for n, f in zip(self.normal, self.friction_force))  # type: ignore[return-value]


@dataclass(frozen=True, slots=True)
class Contacts:
    run: int
    number: int  #: a jump is samples that did not arrive
    step: int
    time: float  #: s, at the end of the step
    step_length: float  #: s
    points: tuple[ContactPoint, ...]
    left_out: int  #: points beyond the largest number of a sample
    force_left_out: float  #: N, sum of their normal forces

    def force_on(self, body: str) -> Vector:
        """N: of all contacts of a body."""
        forces = [point.force_on(body) for point in self.points]
        return (sum(f[0] for f in forces), sum(f[1] for f in forces), sum(f[2] for f in forces))

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Contacts:
        points = tuple(
            ContactPoint(
                pair["a"], pair["b"], pair["detector"], _vector(p["position"]), _vector(p["normal"]), _number(p["depth"]),
                _number(p["normal_force"]), _vector(p["friction_force"]), p["is_impact"], pair["asleep"],
            )  # fmt: skip
            for pair in data["entries"]
            for p in pair["points"]
        )
        return Contacts(
            data["run"], data["sequence_number"], data["step"], _number(data["time"]), _number(data["step_length"]), points,
            data["left_out"], _number(data["force_left_out"]),
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Outcome:
    """The first step after a swap, as it was or as it would have been."""

    energy: float  #: J, at its end, of what the swap can affect
    momentum: Vector  #: N s
    error: float
    cost: float  #: s of processor time; 0: not measured

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Outcome:
        return Outcome(_number(data["energy"]), _vector(data["momentum"]), _number(data["error"]), _number(data["cost_ns"]) * 1e-9)


@dataclass(frozen=True, slots=True)
class Swap:
    """The proof of an exchange: what was carried over, and the first step with the new component, beside what the old one would have
    given."""

    component: str
    from_type: str
    to_type: str
    fields: dict[str, str]  #: by name: "kept", "converted", "given", "fresh" or "lost"
    energy_before: float  #: J, at the boundary
    with_old: Outcome
    with_new: Outcome
    step: int = 0  #: it took effect before this step
    time: float = 0  #: s, simulated
    pause: float = 0  #: s for which the simulation loop stood still
    trial: str = ""  #: how it was proved

    @property
    def energy_jump(self) -> float:
        """J: what the exchange added to the energy of that step."""
        return self.with_new.energy - self.with_old.energy

    @property
    def momentum_jump(self) -> Vector:
        """N s."""
        (a, b, c), (x, y, z) = self.with_old.momentum, self.with_new.momentum
        return (x - a, y - b, z - c)

    @property
    def error_change(self) -> float:
        return self.with_new.error - self.with_old.error

    @staticmethod
    def _of(data: Mapping[str, Any], reply: Mapping[str, Any]) -> Swap:
        return Swap(
            data["component"], data["from"], data["to"], data["fields"], _number(data["energy_before"]), Outcome._of(data["with_old"]),
            Outcome._of(data["with_new"]), reply["step"], _number(reply["time"]), _number(reply["pause_ns"]) * 1e-9, reply["trial"],
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Reply:
    """The server's answer to a request that took effect."""

    run: int
    revision: int  #: of the scene, afterwards
    step: int  #: it took effect before this step
    time: float  #: s, simulated
    pause: float  #: s for which the simulation loop stood still
    waited: float  #: s from its arrival to that step
    trial: str  #: how it was proved
    swaps: list[Swap] = field(default_factory=list)

    @staticmethod
    def _of(data: Mapping[str, Any]) -> Reply:
        return Reply(
            data["run"], data["revision"], data["step"], _number(data["time"]), _number(data["pause_ns"]) * 1e-9,
            _number(data["waited_ns"]) * 1e-9, data["trial"], [Swap._of(s, data) for s in data["swaps"]],
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class ServerInfo:
    """What a server says of itself, at least once a second."""

    name: str
    version: str
    host: str
    process: int
    scene_file: str
    run: int  #: counts loads and resets
    revision: int  #: structural requests applied since the server started
    step: int
    time: float  #: s, simulated
    dt: float  #: s
    paused: bool
    rate_asked: float  #: real-time factor; 0: as fast as possible
    rate_reached: float
    slipped: float  #: s of simulated time lost because steps took too long
    overload: str  #: "", or how that is handled, or what takes so long

    @staticmethod
    def _of(data: Mapping[str, Any]) -> ServerInfo:
        return ServerInfo(**{name: data[name] for name in ServerInfo.__dataclass_fields__})


@dataclass(frozen=True, slots=True)
class Operation:
    """One operation of a request, as server/docs/requests.md lists them; values are text."""

    verb: str
    target: str = ""
    argument: str = ""
    blueprint: str = ""
    values: Mapping[str, str] = field(default_factory=dict)
