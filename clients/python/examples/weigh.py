#!/usr/bin/python3
"""Weighs boxes by the forces of their contacts: what presses on the ground, and on each box of a stack."""

import plab

BOXES = 4
SCENE = """<plab version="1">
  <scene title="Scales" dt="1/240"/>
  <component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
  <component id="cube" type="Shape/Box" half_extents="0.2 0.2 0.1"/>
  <component id="weight" type="Field/Gravity" between="*"/>
  <component id="contact" type="CDetection/ODE" between="*"/>
  {}
</plab>"""
bodies = "".join(f'<component id="b{k}" type="State/RigidBody" shape="cube" mass="2" position="0 0 {0.1 + 0.2 * k}"/>' for k in range(BOXES))

with plab.Server.start(SCENE.format(bodies), paused=False) as server, server.session() as session:
    for contacts in session.contacts():
        if contacts.time > 1:
            break
print(f"at {contacts.time:.2f} s the ground carries {-contacts.force_on('ground')[2]:.3f} N; they weigh {BOXES * 2 * 9.81:.3f} N")
for point in contacts.points:
    print(f"{point.a} on {point.b}: {point.normal_force:8.3f} N at {point.position}")
