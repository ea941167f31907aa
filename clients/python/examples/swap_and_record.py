#!/usr/bin/python3
"""A live exchange with its proof, in a recording that becomes a table: the balloons' impact is made inelastic while the scene runs."""

import sys
import tempfile
from pathlib import Path

import plab

file = Path(sys.argv[1] if len(sys.argv) > 1 else Path(tempfile.mkdtemp()) / "run.mcap")
with plab.Server.start("scenes/fan_and_balloons.xml", rate=2, until=5, record=file) as server, server.session() as session:
    session.resume()
    proof = session.swap("contact.response", "Response/Impulse", at=600, restitution=0.1)
    print(f"before step {proof.step} ({proof.time:.2f} s), pause {proof.pause * 1e6:.0f} µs; {proof.trial}")
    print(f"kept: {[name for name, fate in proof.fields.items() if fate == 'kept']}")
    print(f"the first step with it: {proof.energy_jump:+.3g} J, momentum {proof.momentum_jump} N s")
    server.wait(60)

with plab.Recording(file) as recording:
    table = recording.to_dataframe()
    impacts = plab.to_dataframe(c for c in recording.collisions() if c.kind == "impact")
    energy = plab.to_dataframe(recording.metrics())[["time", "energy_kinetic", "energy_unexplained"]]
balloons = table[table.id.isin(["red", "green"])].assign(speed=lambda t: (t.vx**2 + t.vy**2 + t.vz**2) ** 0.5)
print(balloons.groupby("id", observed=True)[["x", "speed"]].agg(["min", "max"]).round(3))
print(impacts[["time", "a", "b", "impulse_x"]].round(5))
print(energy.iloc[:: max(1, len(energy) // 5)].round(6))
