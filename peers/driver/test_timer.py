"""Tests of `peers/programs/timer.c`, with libraries of a few lines."""

import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).parent.parent / "programs/timer.c"
# The sum and the difference of a state's two numbers, of `LANES` states at once.
LIBRARY = """
#include <string.h>
static double own[2 * LANES];
int prepare(const char *robot) { return strcmp(robot, "unknown") == 0; }
const double *f(const double *x, double *result)
{
  (void)result;
  for (int lane = 0; lane < LANES; ++lane) {
    own[lane] = x[lane] + x[LANES + lane];
    own[LANES + lane] = x[lane] - x[LANES + lane];
  }
  return own;
}
const float *f_single(const float *x, float *result)
{
  result[0] = x[0] + x[1];
  result[1] = 0;
  return result;
}
const float *f_single_result(const float *x, float *result)
{
  result[0] = x[0] + x[1];
  result[1] = x[0] - x[1];
  return result;
}
"""
STATES = [1.0, 0.5, 2.0, 0.25, 3.0, 0.125, 4.0, 0.0625]


@unittest.skipUnless(shutil.which("cc"), "needs a C compiler")
class Timer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.compiled("timer", SOURCE, "-ldl")
        source = cls.folder / "library.c"
        source.write_text(LIBRARY)
        for lanes in (1, 2):
            cls.compiled(f"lanes{lanes}.so", source, "-shared", "-fPIC", f"-DLANES={lanes}")
        (cls.folder / "states").write_bytes(struct.pack("8d", *STATES))

    @classmethod
    def compiled(cls, name: str, source: Path, *flags: str):
        subprocess.run(["cc", "-O1", str(source), "-o", str(cls.folder / name), *flags], check=True)

    def run_timer(self, mode: str, *programs: str) -> subprocess.CompletedProcess:
        words = [word for program in programs for word in program.split()]
        command = ["./timer", mode, "states", "2", "2", *words]
        return subprocess.run(command, cwd=self.folder, capture_output=True)

    def test_a_check_has_the_results_of_all_states(self):
        expected = [number for x, y in zip(STATES[::2], STATES[1::2]) for number in (x + y, x - y)]
        for program in ("./lanes1.so f robot f64 1", "./lanes1.so f_single robot f32 1"):
            found = struct.unpack("8d", self.run_timer("check", program).stdout)
            self.assertEqual(list(found), expected, program)
        side_by_side = struct.unpack("8d", self.run_timer("check", "./lanes2.so f robot f64 2").stdout)
        sums, differences = expected[::2], expected[1::2]
        self.assertEqual(list(side_by_side), [*sums[:2], *differences[:2], *sums[2:], *differences[2:]])

    def test_programs_in_turns_have_a_line_each_in_their_order(self):
        # So that the order can be seen: a call of one program does a thousand times what that of the other does.
        slow = self.folder / "slow.c"
        slow.write_text("const double *f(const double *x, double *y) { for (volatile int k = 0; k < 5000; ++k); *y = *x; return y; }")
        self.compiled("slow.so", slow, "-shared", "-fPIC")
        programs = ["./lanes2.so f robot f64 2", "./slow.so f robot f64 1", "./lanes1.so f_single robot f32 1"]
        for order in (programs, programs[1:] + programs[:1]):
            lines = self.run_timer("time", *order).stdout.decode().splitlines()
            times = [float(line.split()[0]) for line in lines]
            self.assertEqual(len(times), 3)
            self.assertEqual(times.index(max(times)), order.index(programs[1]), lines)

    def test_what_does_not_take_a_robot_is_refused(self):
        refused = self.run_timer("time", "./lanes1.so f robot f64 1", "./lanes1.so f unknown f64 1")
        self.assertEqual((refused.returncode, refused.stdout), (3, b""))
        self.assertIn("./lanes1.so does not take unknown", refused.stderr.decode())
        missing = self.run_timer("check", "./lanes1.so nothing robot f64 1")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("nothing", missing.stderr.decode())
        self.assertEqual(self.run_timer("time").returncode, 2)


if __name__ == "__main__":
    unittest.main()
