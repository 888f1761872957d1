"""scripts/run-ctest counts what ctest did, and fails where it should."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

RUN_CTEST = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "run-ctest"
GOOD = 'add_test(good "true")\n'
BAD = 'add_test(bad "false")\n'
SKIPPED = 'add_test(skipped "echo" "SKIPPED")\nset_tests_properties(skipped PROPERTIES SKIP_REGULAR_EXPRESSION SKIPPED)\n'
MISSING = 'add_test(missing "/nonexistent/test")\n'
NOT_BUILT = "add_test(test_unit_NOT_BUILT NOT_AVAILABLE)\n"


def run(tests, *arguments):
    """The exit code and last line of run-ctest on a build folder with these tests."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "CTestTestfile.cmake").write_text(tests)
        done = subprocess.run([sys.executable, str(RUN_CTEST), folder, *arguments], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()[-1]


class RunCtest(unittest.TestCase):
    def test_passes_when_all_pass(self):
        self.assertEqual(run(GOOD), (0, "1 passed, 0 failed"))

    def test_fails_when_one_fails(self):
        self.assertEqual(run(GOOD + BAD), (1, "1 passed, 1 failed"))

    def test_counts_a_skipped_test_and_passes(self):
        self.assertEqual(run(GOOD + SKIPPED), (0, "1 passed, 0 failed, 1 skipped"))

    def test_fails_when_all_were_skipped(self):
        self.assertEqual(run(SKIPPED), (1, "0 passed, 0 failed, 1 skipped"))

    def test_fails_when_a_test_could_not_start(self):
        self.assertEqual(run(GOOD + MISSING), (1, "1 passed, 1 failed"))
        self.assertEqual(run(GOOD + NOT_BUILT), (1, "1 passed, 1 failed"))

    def test_fails_when_there_is_no_test(self):
        self.assertEqual(run(""), (1, "0 passed, 0 failed"))
        self.assertEqual(run(GOOD, "-R", "nothing"), (1, "0 passed, 0 failed"))


if __name__ == "__main__":
    unittest.main()
