"""A client's place on the bus: one server, its scene, requests, and what it sends."""

from __future__ import annotations

import os
import time
import weakref
from collections.abc import Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Any

from . import _native
from .errors import Late, NoReply, NoServer, PlabError, Refused, ServerGone
from .frames import Frame, NameTable
from .recorder import Recorder
from .requests import Value, blueprint_of, encode, swap_operations, text_of, texts_of
from .streams import GONE_AFTER, EntryStream, FrameStream
from .values import Collision, Component, Contacts, Event, Interaction, Level, Metrics, Operation, Reply, ServerInfo, Swap, Type

if TYPE_CHECKING:
    from .server import Server


class Session:
    """Joins a running server. ``with plab.Session("plab") as session: ...``

    server: its name; by default PLAB_SERVER, or the only one that runs.
    domain: the DDS domain, by default PLAB_DOMAIN or 0.
    interface: a network interface, by default PLAB_INTERFACE, "" for this host only.
    timeout: s to wait for the server, and later for replies and data.
    own: the ``Server`` whose session it is; ``Server.session`` fills it in.

    Not for several threads at once; each thread may have a session of its own. Requests raise Refused with the server's reasons, NoReply
    and ServerGone. ``at`` names the step before which a request takes effect (Late: it has passed), ``revision`` the scene that it was
    made for.
    """

    def __init__(
        self,
        server: str | None = None,
        *,
        domain: int | None = None,
        interface: str | None = None,
        timeout: float = 5,
        own: Server | None = None,
    ) -> None:
        self.timeout = timeout
        self._own, self._domain, self._interface = own, domain, interface
        self._opened: weakref.WeakSet[Any] = weakref.WeakSet()
        self._catalogues: dict[int, _native.Handle] = {}
        self._lock_step: FrameStream | None = None
        self._at = (0, 0)  # run and step of the newest frame of step()
        self._names = NameTable(self._load_names)
        name = None if server is None else server.encode()
        network = None if interface is None else interface.encode()
        self._handle = _native.Handle("", _native.call("join", name, -1 if domain is None else domain, network), "leave")
        try:
            self._find(timeout)
        except BaseException:
            self.close()
            raise

    def _find(self, timeout: float) -> None:
        for slice in _native.slices(timeout):
            try:
                if self._handle.find(slice):
                    return
            except PlabError as why:
                raise NoServer(str(why)) from None
            why_not = _native.error()
            if self.has_ended():
                self.check_end()
                raise ServerGone("the server has ended already")
        raise NoServer(why_not)

    # ---- Life --------------------------------------------------------------------------------------------------------

    @property
    def server(self) -> str:
        """Its name."""
        return str(self._handle.server(), "utf-8")

    def servers(self, seconds: float = 0.5) -> list[ServerInfo]:
        """All servers of the domain that are seen in this time."""
        return [ServerInfo._of(one) for one in _native.parse(self._handle.servers(seconds))]

    def close(self) -> None:
        """Leaves the bus; the server goes on, unless it belongs to a ``Server`` that is closed."""
        for stream in list(self._opened):
            stream.close()
        for catalogue in self._catalogues.values():
            catalogue.close()
        self._catalogues.clear()
        self._handle.close()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def has_ended(self) -> bool:
        """Whether the process of a server of one's own has ended."""
        return self._own is not None and self._own.exit_code is not None

    def check_end(self) -> None:
        """ServerGone if it ended with an error, or was killed."""
        if self._own is not None and self._own.exit_code:
            raise ServerGone(f"server '{self._own.name}' ended with exit code {self._own.exit_code}\n{self._own.log}".strip())

    # ---- What there is -----------------------------------------------------------------------------------------------

    def info(self) -> ServerInfo:
        """The server's state, at most a second old."""
        return ServerInfo._of(self._part(_native.PART_SERVER))

    def components(self) -> dict[str, Component]:
        """Bodies and shafts by their ids."""
        return {one["id"]: Component._of(one) for one in self._part(_native.PART_OBJECTS)}

    def interactions(self) -> dict[str, Interaction]:
        """All other components by their ids; ``metrics`` has their costs and errors."""
        return {one["id"]: Interaction._of(one) for one in self._part(_native.PART_INTERACTIONS)}

    def types(self) -> dict[str, Type]:
        """Types that can be added or swapped in, by their names."""
        return {one["name"]: Type._of(one) for one in self._part(_native.PART_TYPES)}

    def levels(self) -> dict[str, Level]:
        """What governors chose, by the ids of the components that they govern."""
        parts: Mapping[str, Component | Interaction] = {**self.interactions(), **self.components()}
        chosen = {id: Level._of(id, one.parameters) for id, one in parts.items()}
        return {id: level for id, level in chosen.items() if level is not None}

    def metrics(self, timeout: float | None = None) -> Metrics:
        """Energy, momentum, costs and errors: those of the last ``step``, or of a running scene the newest, at most 0.25 s old."""
        timeout = self.timeout if timeout is None else timeout
        for slice in _native.slices(timeout):
            data = self._part(_native.PART_METRICS, timeout)
            if data is not None and (data["run"], data["step"]) >= self._at:
                return Metrics._of(data)
            if data is not None:
                # A paused server sends its next ones within a second, to a new reader at once.
                self._catalogues.pop(_native.PART_METRICS).close()
            time.sleep(min(slice, 0.005))
        raise NoReply(f"server '{self.server}' sent no metrics within {timeout} s")

    def _part(self, part: int, timeout: float | None = None) -> Any:
        return _native.parse(self._fetched(part, self.timeout if timeout is None else timeout).text(part))

    def _fetched(self, part: int, timeout: float) -> _native.Handle:
        """The catalogue is kept up to date from its first use on; parts that nobody asks for cost nothing."""
        catalogue = self._catalogues.get(part)
        if catalogue is None:
            pointer = _native.call("catalogue_open", self._handle.pointer, part)
            catalogue = self._catalogues[part] = _native.Handle("catalogue_", pointer, "catalogue_close")
        begin = time.monotonic()
        for slice in _native.slices(timeout):
            if catalogue.fetch(slice):
                return catalogue
            missing = _native.error()
            is_silent = catalogue.text(_native.PART_SERVER) == b"null"
            if self.has_ended() or is_silent and time.monotonic() - begin > GONE_AFTER:
                self.check_end()
                raise ServerGone(f"server '{self.server}' has gone")
        raise NoReply(missing)

    def _load_names(self) -> dict[tuple[int, int], str]:
        try:
            names = self._fetched(_native.PART_OBJECTS, self.timeout).names()
        except ServerGone:
            return {}  # its last frames are worth having without new names
        return {(run, handle): id for run, handle, id in _native.parse(names)}

    # ---- What happens ------------------------------------------------------------------------------------------------

    def frames(self, *, until: float | None = None, timeout: float | None = 10) -> FrameStream:
        """An iterator of states, as the server sends them (60 a second unless ``Server.start(states=...)`` says otherwise).

        until: simulated time, s, at which it ends. timeout: s without a frame after which NoReply is raised; None: never.
        """
        return FrameStream(self, timeout, until)

    def frame(self) -> Frame:
        """The state as it is now."""
        with FrameStream(self, self.timeout) as frames:
            return next(frames)

    def events(self, *, timeout: float | None = None) -> EntryStream[Event]:
        """An iterator of events from now on, without end. The server notices a new reader within 50 ms, for which this call waits."""
        return self._settled(EntryStream(self, "plab/events", Event._of, timeout))

    def collisions(self, *, timeout: float | None = None) -> EntryStream[Collision]:
        """As ``events``."""
        return self._settled(EntryStream(self, "plab/collisions", Collision._of, timeout))

    def contacts(self, *, timeout: float | None = 10) -> EntryStream[Contacts]:
        """An iterator of what presses on what, as often as frames: always the newest, and none while the server is paused."""
        return self._settled(EntryStream(self, "plab/contacts", Contacts._of, timeout))

    @staticmethod
    def _settled(stream: EntryStream[Any]) -> EntryStream[Any]:
        time.sleep(0.05)
        return stream

    def record(self, path: str | os.PathLike[str], *, state_rate: float | None = None, overwrite: bool = False) -> Recorder:
        """Records what the server sends, from the present frame on, until the recorder is closed; as plabctl does, in a process of its own.

        path: a new file, "run.mcap". state_rate: frames per simulated second at most. ``Server.start(record=...)`` has every step.
        """
        place = ["--server", self.server]
        place += ["--domain", str(self._domain)] if self._domain is not None else []
        place += ["--interface", self._interface] if self._interface else []
        return Recorder(path, place, state_rate, overwrite, self.timeout)

    # ---- Requests ----------------------------------------------------------------------------------------------------

    def request(
        self, *operations: Operation, at: int | None = None, revision: int | None = None, timeout: float | None = None
    ) -> Reply:
        """Operations that take effect at one step boundary, all or none; ``Operation`` has the words of server/docs/requests.md.

        A request that names a distant step is answered at that step: give it the ``timeout`` for that. After NoReply it may still be
        carried out; ``cancel`` withdraws it.
        """
        timeout = self.timeout if timeout is None else timeout
        self._connect(timeout)
        array, kept = encode(operations)
        self._handle.request(array, len(operations), -1 if at is None else at, -1 if revision is None else revision)
        for slice in _native.slices(timeout):
            try:
                text = self._handle.reply(slice)
            except PlabError as why:
                self.check_end()
                raise ServerGone(str(why)) from None
            if text:
                return self._outcome(_native.parse(text))
        name = self._handle.last_request().decode()
        raise NoReply(f"no reply from server '{self.server}' within {timeout} s; the request '{name}' may still be carried out", name)

    def _connect(self, timeout: float) -> None:
        for slice in _native.slices(timeout):
            if self._handle.connect(slice):
                return
            if self.has_ended():
                break
        self.check_end()
        raise ServerGone(f"server '{self.server}' takes no requests")

    @staticmethod
    def _outcome(data: Mapping[str, Any]) -> Reply:
        if data["outcome"] == "late":
            raise Late(data["reasons"], data["step"])
        if data["outcome"] != "done":
            raise Refused(data["reasons"], data["step"])
        return Reply._of(data)

    def swap(
        self,
        id: str,
        type: str,
        /,
        *,
        at: int | None = None,
        trial: float | str | None = None,
        allow_energy: float | str | None = None,
        timeout: float | None = None,
        **values: Value,
    ) -> Swap:
        """Exchanges one component for another of its family, and returns the proof. ``values`` are parameters of the new one.

        trial: s that the first step may be tried for, or "none", "unlimited", "20 ms or refuse". allow_energy: the factor by which the
        first step may multiply the energy, or "any".
        """
        reply = self.request(*swap_operations(id, type, values, trial, allow_energy), at=at, timeout=timeout)
        return reply.swaps[0]

    def swap_all(
        self, pattern: str, type: str, /, *, at: int | None = None, trial: float | str | None = None, **values: Value
    ) -> list[Swap]:
        """As ``swap``, of all ids that the pattern with ``*`` and ``?`` names: all or none."""
        return self.request(*swap_operations(pattern, type, values, trial, None), at=at).swaps

    def set(self, id: str, /, *, at: int | None = None, **values: Value) -> Reply:
        """Sets parameters or states of a component: ``session.set("gears", velocity_factor=-0.25)``."""
        return self.request(Operation("set", target=id, values=texts_of(values)), at=at)

    def push(self, id: str, impulse: Value, *, point: Value | None = None, at: int | None = None) -> Reply:
        """An impulse x y z (N s) on a body, at ``point`` (m, in the world) or its centre; of a shaft one number (N m s)."""
        values = {"impulse": text_of(impulse)} | ({} if point is None else {"point": text_of(point)})
        return self.request(Operation("push", target=id, values=values), at=at)

    def add(self, blueprint: str | os.PathLike[str], *, at: int | None = None) -> Reply:
        """Adds components: a file, or the text of a blueprint ("<component ..." or "<plab ...")."""
        text, file = blueprint_of(blueprint)
        return self.request(Operation("add", argument=file, blueprint=text), at=at)

    def remove(self, *ids: str, at: int | None = None) -> Reply:
        """Removes components: all or none."""
        return self.request(*(Operation("remove", target=id) for id in ids), at=at)

    def pause(self, *, at: int | None = None) -> Reply:
        return self.request(Operation("pause"), at=at)

    def resume(self) -> Reply:
        return self.request(Operation("resume"))

    def step(self, count: int = 1, *, timeout: float | None = None) -> Frame:
        """Makes steps, pauses, and returns the state after them. timeout: s without any progress after which NoReply is raised."""
        if self._lock_step is None:
            self._lock_step = FrameStream(self, self.timeout)
            next(self._lock_step)  # with it the server is known to see this reader
        reply = self.request(Operation("step", argument=str(count)), timeout=timeout)
        frame = self._lock_step.wait_for(reply.run, reply.step + count, self.timeout if timeout is None else timeout)
        self._at = (frame.run, frame.step)
        return frame

    def rate(self, rate: float | str) -> Reply:
        """Simulated seconds per second, "real" or "max"."""
        return self.request(Operation("rate", argument=text_of(rate)))

    def dt(self, dt: float | str, *, at: int | None = None) -> Reply:
        """The step length, s: 0.001 or "1/240"."""
        return self.request(Operation("dt", argument=text_of(dt)), at=at)

    def reset(self) -> Reply:
        """The scene as it was loaded; a new run begins."""
        return self.request(Operation("reset"))

    def load(self, blueprint: str | os.PathLike[str]) -> Reply:
        """Another scene: a file or the text of a blueprint; a new run begins."""
        text, file = blueprint_of(blueprint)
        return self.request(Operation("load", argument=file, blueprint=text))

    def snapshot(self, name: str) -> Reply:
        """Keeps this moment under a name."""
        return self.request(Operation("snapshot", target=name))

    def restore(self, name: str) -> Reply:
        """Back to a snapshot, bit for bit; a new run begins."""
        return self.request(Operation("restore", target=name))

    def rewind(self, *, to: float | None = None, by: float | None = None) -> Reply:
        """Back to a simulated time, or by some seconds; a new run begins."""
        if (to is None) == (by is None):
            raise TypeError("rewind needs either 'to' or 'by'")
        return self.request(Operation("rewind", argument=text_of(to) if to is not None else f"back {text_of(by or 0.0)}"))

    def cancel(self, request: str) -> Reply:
        """Withdraws a request that waits for its step: ``NoReply.request``."""
        return self.request(Operation("cancel", argument=request))

    def shutdown(self) -> Reply:
        """Ends the server."""
        return self.request(Operation("shutdown"))

    def __repr__(self) -> str:
        return f"<plab.Session of server '{self.server}'>"
