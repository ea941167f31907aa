#!/usr/bin/python3
"""Steps a second in lock step over the bus, and frames that arrive. PLAB_SOURCES=. PYTHONPATH=build/lib/python3/dist-packages"""

import statistics
import time

import lab
import plab

SECONDS = 3


def lock_step(session: plab.Session) -> tuple[float, float]:
    """Steps a second, and the median of one, s."""
    times = []
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        begin = time.perf_counter()
        session.step()
        times.append(time.perf_counter() - begin)
    return len(times) / sum(times), statistics.median(times)


def at_most(session: plab.Session) -> tuple[float, float]:
    """Frames a second that arrive, and steps a second that the server makes, as fast as it can."""
    with session.frames() as frames:
        first = last = next(frames)
        session.resume()
        count, end = 0, time.monotonic() + SECONDS
        while time.monotonic() < end:
            last, count = next(frames), count + 1
    session.pause()
    return count / SECONDS, (last.step - first.step) / SECONDS


def in_real_time(count: int, rate: int) -> tuple[int, int]:
    """Frames that arrived, and how many were sent, of a server that sends each of ``rate`` steps a second."""
    scene = lab.many_balls(count).replace("1/100", f"1/{rate}")
    with plab.Server.start(scene, rate=1, states="all") as server, server.session() as session:
        with session.frames(until=SECONDS) as frames:
            next(frames)
            session.resume()
            numbers = [frame.number for frame in frames]
    return len(numbers), numbers[-1] - numbers[0] + 1


def main() -> None:
    for count, rate in ((1, 1000), (200, 1000), (10_000, 60)):
        with plab.Server.start(lab.many_balls(count)) as server, server.session() as session:
            session.step(10)
            steps, median = lock_step(session)
            step_time = session.metrics().step_time
        with plab.Server.start(lab.many_balls(count), states="all") as server, server.session() as session:
            arrived, made = at_most(session)
        got, sent = in_real_time(count, rate)
        print(f"{count:6} bodies: {steps:.0f} steps/s in lock step, median {median * 1e6:.0f} us, of it the step {step_time * 1e6:.0f} us")
        print(f"{'':14} as fast as it can: {arrived:.0f} frames/s arrive of {made:.0f} steps/s")
        print(f"{'':14} {rate} frames/s in real time: {got} arrive of {sent}")


if __name__ == "__main__":
    main()
