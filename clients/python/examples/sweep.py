#!/usr/bin/python3
"""A parameter sweep: the error of four solvers on an orbit about a sun, against the time that they take. The closed form is Kepler's."""

import sys

import matplotlib.pyplot as plt
import numpy as np
import plab

SOLVERS = ["SemiImplicitEuler", "StoermerVerlet", "RungeKutta4", "DormandPrince54"]
STEPS = [1 / 50, 1 / 100, 1 / 200, 1 / 400, 1 / 800]  # s
UNTIL = 6  # s: nearly once around


def kepler(time: float, eccentricity: float = 0.6) -> np.ndarray:
    """Position on the orbit with a = mu = 1 that begins at the perihelion: E - e sin E = t by Newton's method."""
    anomaly = time
    for _ in range(50):
        anomaly -= (anomaly - eccentricity * np.sin(anomaly) - time) / (1 - eccentricity * np.cos(anomaly))
    return np.array([np.cos(anomaly) - eccentricity, np.sqrt(1 - eccentricity**2) * np.sin(anomaly), 0])


def measure(session: plab.Session, solver: str, dt: float) -> tuple[float, float]:
    """Error at the end, m, and processor time, s."""
    session.reset()
    session.dt(dt)
    session.swap("solver", f"Solver/{solver}")
    frame = session.step(round(UNTIL / dt))
    error = float(np.linalg.norm(frame.body("planet").position - kepler(frame.time)))
    return error, session.metrics().step_time * UNTIL / dt


figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
with plab.Server.start("scenes/studies/kepler.xml") as server, server.session() as session:
    for solver in SOLVERS:
        rows = [measure(session, solver, dt) for dt in STEPS]
        axes.loglog([1e3 * cost for _, cost in rows], [error for error, _ in rows], "o-", label=solver)
        for dt, (error, cost) in zip(STEPS, rows):
            print(f"{solver:18} dt 1/{round(1 / dt):<4} error {error:.2e} m  {cost * 1e3:6.2f} ms")
axes.set_title("Kepler orbit, e = 0.6: steps of 1/50 to 1/800 s")
axes.set(xlabel=f"processor time for {UNTIL} s, ms", ylabel="error of the position at the end, m")
axes.legend()
axes.grid(alpha=0.3)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "sweep.png", dpi=110)
