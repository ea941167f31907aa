"""pLab in Python: run scenes, step them, exchange algorithms while they run, and get the numbers as arrays.

    import plab

    with plab.Server.start("scenes/fan_and_balloons.xml") as server, server.session() as session:
        frame = session.step(240)
        print(frame.time, frame["red"].position)
        proof = session.swap("gears", "Constraint/AngularVelocity/Assign")
        print(proof.energy_jump, "J")

``server/docs/python.md`` is the manual.
"""

from . import _native
from .errors import Late, MissedWarning, NoReply, NoServer, PlabError, Refused, ServerGone, StartFailed
from .frames import BodyState, Frame, ShaftState
from .recorder import Recorder
from .recording import Recording
from .server import Server
from .session import Session
from .tables import to_dataframe
from .values import (
    Collision,
    Component,
    ContactPoint,
    Contacts,
    Energy,
    Event,
    Interaction,
    InteractionMetrics,
    Level,
    Metrics,
    Operation,
    Outcome,
    Parameter,
    Reply,
    ServerInfo,
    Swap,
    Type,
)

__version__: str = _native.call("version").decode()

__all__ = [
    "BodyState",
    "Collision",
    "Component",
    "ContactPoint",
    "Contacts",
    "Energy",
    "Event",
    "Frame",
    "Interaction",
    "InteractionMetrics",
    "Late",
    "Level",
    "Metrics",
    "MissedWarning",
    "NoReply",
    "NoServer",
    "Operation",
    "Outcome",
    "Parameter",
    "PlabError",
    "Recorder",
    "Recording",
    "Refused",
    "Reply",
    "Server",
    "ServerGone",
    "ServerInfo",
    "Session",
    "ShaftState",
    "StartFailed",
    "Swap",
    "Type",
    "to_dataframe",
]
