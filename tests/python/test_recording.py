"""Recordings: made by the server and by a session, read back, as tables."""

import os
import tempfile
import time
import unittest
import warnings
from pathlib import Path

import lab
import numpy as np
import plab


class RecordingTest(lab.LabTest):
    def setUp(self):
        super().setUp()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name) / "run.mcap"

    def test_the_servers_own_recording_has_every_step(self):
        with plab.Server.start(lab.PAPER, record=self.file) as server, server.session() as session:
            live = session.step(100)
        with plab.Recording(self.file) as recording:
            self.assertEqual(recording.about["server"], server.name)
            frames = list(recording.frames())
            part = [frame.step for frame in recording.frames(since=0.1, until=0.2)]
        # A scene that stands still sends its state to each new reader.
        self.assertEqual(sorted({frame.step for frame in frames}), list(range(101)))
        np.testing.assert_array_equal(frames[-1].positions, live.positions)
        np.testing.assert_array_equal(frames[-1].angles, live.angles)
        self.assertEqual(frames[-1].bodies, ("green", "red"))
        self.assertEqual((part[0], part[-1]), (24, 48))

    def test_a_session_records_from_the_present_on(self):
        with plab.Server.start(lab.PAPER) as server, server.session() as session:
            session.step(10)
            with session.record(self.file):
                live = [session.step(1) for _ in range(20)]
                session.swap("gears", "Constraint/AngularVelocity/Assign")
                live.append(session.step(1))
            with self.assertRaisesRegex(plab.StartFailed, "run.mcap is there already"):
                session.record(self.file)
            session.record(self.file.with_name("other.mcap")).close()
            session.record(self.file.with_name("other.mcap"), overwrite=True).close()
            with self.assertRaisesRegex(plab.StartFailed, "no_such_folder"):
                session.record(self.file.with_name("no_such_folder") / "run.mcap")
        with plab.Recording(self.file) as recording:
            frames = {frame.step: frame for frame in recording.frames()}
            events = list(recording.events())
        self.assertEqual(min(frames), 10)
        for frame in live:
            np.testing.assert_array_equal(frames[frame.step].positions, frame.positions)
            np.testing.assert_array_equal(frames[frame.step].speeds, frame.speeds)
        self.assertIn("request.swap", {event.kind for event in events})

    def test_a_recorder_joins_the_domain_of_its_session(self):
        other = int(os.environ["PLAB_DOMAIN"]) + 1
        with plab.Server.start(lab.BALL, domain=other) as server:
            with self.assertRaises(plab.NoServer):
                plab.Session(server.name, timeout=0.5)
            with plab.Session(server.name, domain=other) as session, session.record(self.file):
                session.step(5)
        with plab.Recording(self.file) as recording:
            self.assertEqual([frame.step for frame in recording.frames()][-1], 5)

    def test_frames_as_a_table(self):
        with plab.Server.start(lab.PAPER, record=self.file) as server, server.session() as session:
            last = session.step(900)
        with plab.Recording(self.file) as recording:
            table = recording.to_dataframe()
            impacts = plab.to_dataframe(c for c in recording.collisions() if c.kind == "impact")
        table = table.drop_duplicates(["step", "id"])
        self.assertEqual(len(table), 901 * 8)
        red = table[(table.id == "red") & (table.step == 900)].iloc[0]
        np.testing.assert_array_equal([red.x, red.y, red.z], last.body("red").position)
        fan = table[(table.id == "fan") & (table.step == 900)].iloc[0]
        self.assertEqual(fan.speed, last.shaft("fan").speed)
        self.assertTrue(np.isnan(fan.x) and np.isnan(red.speed))
        self.assertAlmostEqual(impacts.time[0], 3.286, 2)
        self.assertIn("impulse_x", impacts.columns)

    def test_damage_is_told_and_left_out(self):
        with plab.Server.start(lab.PAPER, record=self.file) as server, server.session() as session:
            for _ in range(20):
                session.step(100)
                time.sleep(0.03)  # a chunk of its own
        data = bytearray(self.file.read_bytes())
        for quarter in (1, 2, 3):
            begin = len(data) * quarter // 4
            for i in range(begin, begin + 64):
                data[i] ^= 0xFF
        self.file.write_bytes(data)
        with plab.Recording(self.file) as recording, warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            frames = list(recording.frames())
        self.assertTrue(any(one.category is plab.MissedWarning and "run.mcap" in str(one.message) for one in told), told)
        self.assertTrue(500 < len(frames) < 2001, len(frames))

    def test_no_recording(self):
        self.file.write_bytes(os.urandom(1000))
        with self.assertRaisesRegex(plab.PlabError, "run.mcap"):
            plab.Recording(self.file)


if __name__ == "__main__":
    unittest.main()
