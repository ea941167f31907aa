#!/usr/bin/python3
"""A level-of-detail experiment: 1800 weights on springs, computed finely only where a viewer looks. What does that save, who sees it?"""

import sys

import matplotlib.pyplot as plt
import numpy as np
import plab

FINE, FINER = ({"relative_tolerance": 10.0**-n, "absolute_tolerance": 10.0**-n} for n in (5, 7))
SETTINGS = {"reference": ("DormandPrince54", FINER), "all fine": ("DormandPrince54", FINE), "all medium": ("RungeKutta4", {}),
            "all coarse": ("SemiImplicitEuler", {}), "fine where seen": None}  # fmt: skip
LEVELS = {-1: "the viewer", 0: "not seen: SemiImplicitEuler", 1: "small: RungeKutta4", 2: "seen: DormandPrince54"}
runs = {}
with plab.Server.start("scenes/levels/springs.xml") as server, server.session() as session:
    for name, setting in SETTINGS.items():
        session.reset()
        if setting:
            session.remove("lod")  # the governor, which chooses levels
            session.swap_all("*engine.*", f"Solver/{setting[0]}", trial="none", **setting[1])
        runs[name] = session.step(60), session.metrics().step_time
    levels = session.levels()  # by solver: engine.3.4 moves upper.3.4 and lower.3.4
frame, _ = runs["fine where seen"]
level = np.array([-1 if id == "drone" else levels["engine" + id[5:]].level for id in frame.bodies])
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5.5), layout="constrained")
for number in sorted(set(level), reverse=True):
    left.scatter(*frame.positions[level == number, :2].T, s=120 if number < 0 else 9, label=LEVELS[number])
for name, (other, cost) in list(runs.items())[1:]:
    error = np.linalg.norm(other.positions - runs["reference"][0].positions, axis=1)
    right.loglog(1e3 * cost, np.median(error[level == 2]), "o", label=f"{name}: {1e3 * cost:.1f} ms", markersize=10)
left.set(xlabel="x, m", ylabel="y, m", title="Levels that the governor chose", aspect="equal")
right.set(xlabel="processor time of a step, ms", ylabel="median error of what is seen, m", title="Error after 1 s against cost")
left.legend(bbox_to_anchor=(1, -0.12), ncols=2), right.legend(), right.grid(alpha=0.3, which="both")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "levels.png", dpi=110)
