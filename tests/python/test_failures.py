"""What goes wrong: each as an exception with the server's words, soon, and without a process left over."""

import os
import signal
import subprocess
import sys
import time
import unittest

import lab
import plab


class StartTest(lab.LabTest):
    def test_a_scene_with_an_error_is_named_with_its_place(self):
        with self.assertRaisesRegex(plab.StartFailed, r"xml:2:\d+: .*[Mm]ass"):
            plab.Server.start('<plab version="1">\n<component id="a" type="State/RigidBody" mass="-1" inertia="1 1 1"/></plab>')

    def test_a_scene_that_is_not_there(self):
        with self.assertRaisesRegex(plab.StartFailed, "no_such_scene.xml"):
            plab.Server.start("no_such_scene.xml")

    def test_an_option_that_does_not_exist(self):
        with self.assertRaisesRegex(plab.StartFailed, "no-such-option"):
            plab.Server.start(lab.BALL, options=["--no-such-option"])

    def test_a_name_that_is_taken(self):
        server = self.start()
        with self.assertRaisesRegex(plab.StartFailed, server.name):
            plab.Server.start(lab.BALL, name=server.name)


class RefusalTest(lab.LabTest):
    def test_an_unknown_id(self):
        with self.assertRaisesRegex(plab.Refused, "no component has the id 'bell', did you mean 'ball'") as caught:
            self.session().set("bell", mass=1)
        self.assertEqual(caught.exception.step, 0)

    def test_a_swap_to_another_family_changes_nothing(self):
        session = self.session(lab.PAPER)
        before = session.step(100)
        revision = session.info().revision
        with self.assertRaises(plab.Refused) as caught:
            session.swap("gears", "Field/Gravity")
        self.assertIn("Field/Gravity", caught.exception.reasons[0])
        self.assertEqual(session.interactions()["gears"].type, "Constraint/AngularVelocity/Graph")
        self.assertEqual(session.info().revision, revision)
        self.assertEqual(session.frame().positions.tobytes(), before.positions.tobytes())

    def test_a_value_that_breaks_a_rule(self):
        session = self.session(lab.PAPER)
        with self.assertRaisesRegex(plab.Refused, "velocity_factor"):
            session.set("gears", velocity_factor=0)
        with self.assertRaisesRegex(plab.Refused, "no_such_field"):
            session.set("gears", no_such_field=1)

    def test_all_reasons_are_there(self):
        with self.assertRaises(plab.Refused) as caught:
            self.session().add(
                '<plab version="1"><component id="a" type="Shape/Sphere" radius="-1"/><component id="b" type="Shape/Shpere"/></plab>'
            )
        self.assertEqual(len(caught.exception.reasons), 2)
        self.assertIn("radius", str(caught.exception))
        self.assertIn("Shape/Sphere", str(caught.exception))


class TimeTest(lab.LabTest):
    def test_no_server(self):
        begin = time.monotonic()
        with self.assertRaisesRegex(plab.NoServer, "no server 'nobody' was found in domain"):
            plab.Session("nobody", timeout=0.5)
        self.assertLess(time.monotonic() - begin, 3)

    def test_no_server_but_others(self):
        server = self.start()
        with self.assertRaisesRegex(plab.NoServer, f"there are: .*{server.name}"):
            plab.Session("nobody", timeout=1)

    def test_several_servers_have_to_be_named(self):
        self.start(), self.start()
        with self.assertRaisesRegex(plab.NoServer, "several servers"):
            plab.Session()

    def test_a_request_for_a_distant_step_can_be_withdrawn(self):
        session = self.session()
        with self.assertRaises(plab.NoReply) as caught:
            session.request(plab.Operation("pause"), at=10**9, timeout=0.3)
        session.cancel(caught.exception.request)
        with self.assertRaises(plab.Refused):
            session.cancel(caught.exception.request)

    def test_a_paused_scene_sends_no_more_frames(self):
        with self.session().frames(timeout=0.5) as frames:
            next(frames)
            with self.assertRaisesRegex(plab.NoReply, "no frame within 0.5 s"):
                next(frames)

    def test_what_is_closed_says_so(self):
        session = self.session()
        frames = session.frames()
        session.close()
        session.close()
        for use in (session.info, session.frame, lambda: next(frames), lambda: session.step(), lambda: session.server):
            with self.assertRaisesRegex(plab.PlabError, "closed"):
                use()


class DeathTest(lab.LabTest):
    def test_a_server_that_is_killed_between_frames(self):
        server = self.start(rate=1)
        session = server.session()
        session.resume()
        with session.frames() as frames, self.assertRaisesRegex(plab.ServerGone, "exit code -9"):
            for i, _ in enumerate(frames):
                if i == 5:
                    os.kill(server.process, signal.SIGKILL)
        with self.assertRaises(plab.ServerGone):
            session.step()
        with self.assertRaises(plab.ServerGone):
            session.info()
        session.close()

    def test_another_ones_server_that_is_killed(self):
        server = self.start(rate=1)
        with plab.Session(server.name) as session:
            session.resume()
            frames = session.frames(timeout=None)
            next(frames)
            os.kill(server.process, signal.SIGKILL)
            begin = time.monotonic()
            with self.assertRaises(plab.ServerGone):
                list(frames)
            with self.assertRaises(plab.ServerGone):
                session.set("ball", mass=1)
            self.assertLess(time.monotonic() - begin, 20)

    def test_a_server_that_is_shut_down(self):
        server = self.start()
        session = server.session()
        session.step(3)
        session.shutdown()
        self.assertEqual(server.wait(10), 0)
        self.assertEqual(list(session.frames()), [])
        with self.assertRaises(plab.ServerGone):
            session.step()
        session.close()

    def run_script(self, body: str) -> subprocess.Popen:
        script = f"import sys, lab, plab\nserver = plab.Server.start(lab.BALL, rate=1)\nsession = server.session()\n{body}"
        child = subprocess.Popen(
            [sys.executable, "-c", script],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=os.path.dirname(__file__),
            start_new_session=True,
        )
        self.addCleanup(child.stdout.close)
        self.addCleanup(child.stderr.close)
        self.addCleanup(child.kill)
        self.assertEqual(child.stdout.readline(), "waiting\n", child.poll() and child.stderr.read())
        return child

    def test_ctrl_c_ends_each_wait_soon(self):
        waits = {
            "frames": "next(f)",
            "a reply": "session.request(plab.Operation('pause'), at=10**9, timeout=60)",
            "events": "next(session.events())",
            "a server": "plab.Session('nobody', timeout=60)",
        }
        for what, wait in waits.items():
            with self.subTest(what):
                child = self.run_script(
                    "f = session.frames(timeout=None); next(f)\nprint('waiting', flush=True)\n"
                    f"try:\n    {wait}\n"
                    "except KeyboardInterrupt:\n    print('interrupted', server.exit_code, flush=True)\n    raise\n"
                    "finally:\n    session.close(); server.close()\n"
                )
                time.sleep(0.3)
                begin = time.monotonic()
                os.killpg(child.pid, signal.SIGINT)  # as a terminal does
                self.assertEqual(child.stdout.readline(), "interrupted None\n")  # the server runs on
                self.assertLess(time.monotonic() - begin, 1.5)
                self.assertEqual(child.wait(20), -signal.SIGINT)
                self.assertTrue(lab.wait_until(lambda child=child: not lab.processes_of(f"python_{child.pid}_")))

    def test_a_script_that_is_killed_takes_its_server_along(self):
        child = self.run_script("print('waiting', flush=True)\nsession.resume()\nfor f in session.frames(): pass")
        self.assertTrue(lab.processes_of(f"python_{child.pid}_"))
        child.kill()
        child.wait()
        self.assertTrue(lab.wait_until(lambda: not lab.processes_of(f"python_{child.pid}_")))

    def test_a_script_that_forgets_to_close_takes_its_server_along(self):
        child = self.run_script("print('waiting', flush=True)")
        self.assertEqual(child.wait(20), 0, child.stderr.read())
        self.assertTrue(lab.wait_until(lambda: not lab.processes_of(f"python_{child.pid}_")))


if __name__ == "__main__":
    unittest.main()
