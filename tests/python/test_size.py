"""Ten thousand bodies."""

import time
import unittest

import lab
import numpy as np

COUNT = 10_000


class SizeTest(lab.LabTest):
    def test_ten_thousand_bodies(self):
        session = self.session(lab.many_balls(COUNT))
        frame = session.step(100)
        self.assertEqual(frame.positions.shape, (COUNT, 3))
        begin = time.monotonic()
        ids = frame.bodies
        self.assertEqual(set(ids), {f"ball{i}" for i in range(COUNT)})
        numbers = np.array([int(id.removeprefix("ball")) for id in ids])
        expected = np.stack([numbers, numbers % 7 * frame.time, np.full(COUNT, frame.time)], axis=1)
        np.testing.assert_allclose(frame.positions, expected, rtol=1e-12)
        self.assertLess(time.monotonic() - begin, 20)
        session.set("ball77", linear_velocity=(0, 0, 0))
        later = session.step(10)
        np.testing.assert_array_equal(later.body("ball77").position, frame.body("ball77").position)
        self.assertEqual(len(session.components()), COUNT)

    def test_a_slow_reader_gets_the_newest(self):
        session = self.session(lab.many_balls(COUNT), rate=1)
        session.resume()
        with session.frames() as frames:
            first = next(frames)
            time.sleep(1.5)
            for _ in range(20):
                last = next(frames)
        self.assertGreater(last.number - first.number, 30)
        self.assertGreater(last.time - first.time, 1)


if __name__ == "__main__":
    unittest.main()
