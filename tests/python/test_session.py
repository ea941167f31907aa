"""Sessions with a server: steps, frames, requests, what it says."""

import threading
import unittest

import lab
import numpy as np
import plab


class StepTest(lab.LabTest):
    def test_a_step_returns_the_state_after_it(self):
        session = self.session()
        self.assertEqual(session.frame().step, 0)
        for count, step in ((1, 1), (10, 11), (89, 100)):
            frame = session.step(count)
            self.assertEqual(frame.step, step)
        self.assertAlmostEqual(frame.time, 1.0, 12)
        ball = frame["ball"]
        np.testing.assert_allclose(ball.position, [0, 0, 100 - 9.81 / 2], rtol=1e-9)
        np.testing.assert_allclose(ball.linear_velocity, [0, 0, -9.81], rtol=1e-9)
        np.testing.assert_allclose(ball.quaternion, [1, 0, 0, 0])
        self.assertEqual(frame.positions.shape, (1, 3))
        self.assertEqual(frame.bodies, ("ball",))
        with self.assertRaisesRegex(KeyError, "'bell' is not in this frame, which has: .*"):
            frame.body("bell")

    def test_two_runs_have_the_same_bits(self):
        def states() -> list[bytes]:
            with plab.Server.start(lab.PAPER) as server, server.session() as session:
                frames = [session.step(300) for _ in range(3)]
            return [frame.positions.tobytes() + frame.quaternions.tobytes() + frame.speeds.tobytes() for frame in frames]

        self.assertEqual(states(), states())

    def test_shafts_have_angles_and_speeds(self):
        frame = self.session(lab.PAPER).step(240)
        self.assertIn("fan", frame.shafts)
        self.assertEqual(len(frame), len(frame.angles) + len(frame.positions))
        gear, large = frame.shaft("small_gear"), frame["large_gear"]
        self.assertAlmostEqual(large.speed, -0.5 * gear.speed, 9)
        self.assertAlmostEqual(frame.shaft("motor").speed, 40, 9)

    def test_a_reset_begins_a_new_run(self):
        session = self.session()
        first = session.step(5)
        session.reset()
        again = session.step(5)
        self.assertGreater(again.run, first.run)
        np.testing.assert_array_equal(first.positions, again.positions)

    def test_going_back_gives_the_same_bits(self):
        session = self.session()
        session.step(10)
        session.snapshot("here")
        first = session.step(30)
        session.restore("here")
        np.testing.assert_array_equal(session.step(30).positions, first.positions)
        session.rewind(by=0.3)
        self.assertEqual(session.frame().step, 10)


class FramesTest(lab.LabTest):
    def test_a_server_that_ends_at_its_time_ends_the_frames(self):
        server = self.start(rate="max", until=3, states="all")
        session = server.session()
        frames = session.frames()
        session.resume()
        steps = [frame.step for frame in frames]
        self.assertEqual(steps, sorted(steps))
        self.assertGreater(len(steps), 3)
        self.assertEqual(server.wait(10), 0)
        session.close()

    def test_until_ends_the_frames(self):
        session = self.session(rate=1)
        session.resume()
        with session.frames(until=0.5) as frames:
            last = list(frames)[-1]
        self.assertGreaterEqual(last.time, 0.5)
        self.assertLess(last.time, 1.0)

    def test_a_late_joiner_sees_a_scene_that_stands_still(self):
        server = self.start()
        with server.session() as first:
            first.step(17)
            with server.session() as second:
                self.assertEqual(second.frame().step, 17)
                self.assertEqual(second.info().step, 17)

    def test_two_sessions_are_two_clients_of_one_scene(self):
        server = self.start(lab.PAPER)
        with server.session() as one, server.session() as other:
            with other.frames() as frames:
                next(frames)
                one.step(3)
                self.assertEqual(next(f for f in frames if f.step >= 3).step, 3)
            self.assertEqual(other.step(4).step, 7)
            for i in range(20):
                wanted = "Constraint/AngularVelocity/" + ("Assign", "Graph")[i % 2]
                one.swap("gears", wanted, trial="none")
                self.assertTrue(lab.wait_until(lambda wanted=wanted: other.interactions()["gears"].type == wanted))
                self.assertEqual(one.interactions()["gears"].type, wanted)

    def test_each_thread_may_have_a_session(self):
        server = self.start(lab.PAPER, rate=1)
        with server.session() as session:
            session.resume()
        seen: dict[int, int] = {}

        def watch(i: int) -> None:
            with server.session() as session, session.frames(until=0.5) as frames:
                seen[i] = sum(1 for _ in frames)

        threads = [threading.Thread(target=watch, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(30)
        self.assertEqual(len(seen), 4)


class RequestTest(lab.LabTest):
    def test_a_swap_has_its_proof(self):
        session = self.session(lab.PAPER)
        session.step(240)
        same = session.swap("gears", "Constraint/AngularVelocity/Graph")
        self.assertEqual((same.from_type, same.energy_jump), (same.to_type, 0))
        proof = session.swap("gears", "Constraint/AngularVelocity/Assign")
        self.assertEqual(proof.step, 240)
        self.assertEqual(proof.fields["velocity_factor"], "kept")
        self.assertGreater(proof.energy_before, 0)
        self.assertNotEqual(proof.energy_jump, 0)
        self.assertAlmostEqual(proof.with_old.energy + proof.energy_jump, proof.with_new.energy, 15)
        self.assertGreater(proof.pause, 0)
        self.assertEqual(session.interactions()["gears"].since, 240)

    def test_patterns_are_exchanged_together(self):
        session = self.session(lab.PAPER)
        swaps = session.swap_all("*gear*", "Constraint/AngularVelocity/Impulse")
        self.assertEqual({swap.component for swap in swaps}, {"gears", "axle_to_gear", "gear_to_axle"})

    def test_values_are_given_and_read_back(self):
        session = self.session(lab.PAPER)
        session.swap("contact.response", "Response/Impulse", restitution=0.25)
        self.assertEqual(session.interactions()["contact.response"].parameters["restitution"].value, 0.25)
        session.set("red", mass=0.03, position=(1.4, 0.3, 1.25))
        self.assertEqual(session.components()["red"].mass, 0.03)
        np.testing.assert_array_equal(session.frame().body("red").position, [1.4, 0.3, 1.25])

    def test_a_push_changes_the_velocity_by_impulse_over_mass(self):
        session = self.session()
        session.remove("weight")
        session.push("ball", (0.5, 0, -1))
        np.testing.assert_allclose(session.step().linear_velocities, [[0.25, 0, -0.5]], rtol=1e-15)

    def test_components_are_added_and_removed(self):
        session = self.session()
        session.add('<component id="other" type="State/RigidBody" mass="1" shape="round" position="5 0 0"/>')
        self.assertEqual(set(session.step().bodies), {"ball", "other"})
        session.remove("weight", "ball")
        self.assertEqual(session.step().bodies, ("other",))
        self.assertNotIn("weight", session.interactions())

    def test_requests_for_a_step_wait_for_it(self):
        session = self.session(rate=1)
        session.resume()
        reply = session.pause(at=50)
        self.assertEqual(reply.step, 50)
        self.assertTrue(session.info().paused)
        with self.assertRaises(plab.Late):
            session.set("ball", mass=3, at=10)

    def test_what_a_server_says(self):
        session = self.session(lab.PAPER)
        info = session.info()
        self.assertEqual((info.name, info.paused, info.dt), (session.server, True, 1 / 240))
        self.assertIn(session.server, [server.name for server in session.servers()])
        types = session.types()
        self.assertEqual(types["Constraint/AngularVelocity/Graph"].family, session.interactions()["gears"].family)
        self.assertEqual(session.interactions()["gears"].roles, {"driver": ["small_gear"], "driven": ["large_gear"]})
        red = session.components()["red"]
        self.assertEqual((red.mass, red.kind, red.position), (0.02, "body", (1.4, 0.3, 1)))
        self.assertEqual(session.levels(), {})

    def test_metrics_are_those_of_the_last_step(self):
        session = self.session()
        for count in (1, 50, 200):
            frame = session.step(count)
            metrics = session.metrics()
            self.assertEqual(metrics.step, frame.step)
            speed = frame.linear_velocities[0, 2]
            self.assertAlmostEqual(metrics.energy.kinetic, 0.5 * 2 * speed**2, 9)
        self.assertGreater(metrics.step_time, 0)

    def test_levels_of_a_governor(self):
        session = self.session(str(lab.SOURCES / "scenes/levels/springs.xml"))
        session.step(60)
        levels = session.levels()
        self.assertGreater(len(levels), 1)
        one = next(iter(levels.values()))
        self.assertGreater(one.levels, 1)
        self.assertIn(one.governor, session.interactions())


class EventTest(lab.LabTest):
    def test_events_come_in_order_and_whole(self):
        session = self.session(lab.PAPER)
        with session.events(timeout=5) as events:
            for i in range(5):
                session.set("gears", velocity_factor=-0.5 - i)
            got = [next(events) for _ in range(5)]
        self.assertEqual({event.kind for event in got}, {"request.set"})
        self.assertEqual([event.number for event in got], list(range(got[0].number, got[0].number + 5)))

    def test_collisions_of_the_balloons(self):
        session = self.session(lab.PAPER)
        with session.collisions(timeout=10) as collisions:
            session.step(850)
            first = next(collisions)
            impact = next(c for c in collisions if c.kind == "impact")
        self.assertEqual({first.a, first.b}, {"red", "green"})
        self.assertEqual(first.kind, "begin")
        self.assertAlmostEqual(first.time, 3.286, 2)
        self.assertGreater(np.linalg.norm(impact.impulse), 1e-3)


class ContactTest(lab.LabTest):
    SCENE = """<plab version="1">
      <scene title="Scales" dt="1/240"/>
      <component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
      <component id="cube" type="Shape/Box" half_extents="0.2 0.2 0.1"/>
      <component id="weight" type="Field/Gravity" between="*"/>
      <component id="contact" type="CDetection/ODE" between="*"/>
      <component id="b0" type="State/RigidBody" shape="cube" mass="2" position="0 0 0.1"/>
      <component id="b1" type="State/RigidBody" shape="cube" mass="3" position="0 0 0.3"/>
    </plab>"""

    def test_contacts_after_steps(self):
        session = self.session(self.SCENE)
        with session.contacts(timeout=10) as stream:
            session.step(240)
            # Those of the first step may still be on their way when the last one is over.
            contacts = next(entry for entry in stream if entry.step == 240)
        self.assertAlmostEqual(contacts.step_length, 1 / 240)
        self.assertEqual(contacts.left_out, 0)
        weight = 5 * 9.81
        self.assertAlmostEqual(contacts.force_on("ground")[2], -weight, delta=1e-3 * weight)
        self.assertAlmostEqual(contacts.force_on("b1")[2], 3 * 9.81, delta=1e-3 * weight)
        self.assertEqual({(point.a, point.b) for point in contacts.points}, {("b0", "ground"), ("b0", "b1")})
        self.assertTrue(all(not point.is_impact and abs(point.normal[2]) > 0.999 for point in contacts.points))


if __name__ == "__main__":
    unittest.main()
