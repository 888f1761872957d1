"""docs/test-numbers.md: every number has a row, and every test it names exists under its label.

usage: test_numbers_test.py BUILD_FOLDER
"""
import fnmatch
import json
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADINGS = {"## Numerics and light transport": 66, "## Bad inputs": 40}


def tests_with_labels(build):
    listing = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    result = {}
    for test in json.loads(listing.stdout)["tests"]:
        labels = [p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"]
        result[test["name"]] = "slow" if labels and "slow" in labels[0] else "default"
    return result


def rows_of(text):
    """Heading -> number -> cells; a number twice is an error."""
    result = {heading: {} for heading in HEADINGS}
    heading = None
    for line in text.splitlines():
        if line.startswith("## "):
            heading = line
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if heading in result and cells[0].isdigit():
            if int(cells[0]) in result[heading]:
                raise ValueError(f"{heading}: {cells[0]} twice")
            result[heading][int(cells[0])] = cells
    return result


def problems(text, tests):
    """What is wrong with the table, one line each."""
    found = []
    for heading, rows in rows_of(text).items():
        if sorted(rows) != list(range(1, HEADINGS[heading] + 1)):
            found.append(f"{heading}: numbers {sorted(rows)}")
        for number, (_, _, named, label, remark) in rows.items():
            patterns = re.findall(r"`([^`]+)`", named)
            if not patterns and not remark:
                found.append(f"{heading} {number}: neither a test nor a reason")
            labels = set()
            for pattern in patterns:
                matches = [name for name in tests if fnmatch.fnmatchcase(name, pattern)]
                labels.update(tests[name] for name in matches)
                if not matches:
                    found.append(f"{heading} {number}: no test {pattern}")
            if label != ", ".join(sorted(labels)):
                found.append(f"{heading} {number}: label '{label}', its tests' {sorted(labels)}")
    return found


class TestNumbers(unittest.TestCase):
    tests: dict = {}
    text = (ROOT / "docs" / "test-numbers.md").read_text()

    def test_every_number_has_tests_that_exist(self):
        self.assertEqual(problems(self.text, self.tests), [])

    def test_planted_errors_are_found(self):
        row = next(line for line in self.text.splitlines() if line.startswith("| 10 "))
        for planted in ("", row.replace("Fresnel.", "Frensel."), row.replace("default", "slow"), re.sub("`[^`]+`", "", row)):
            self.assertNotEqual(problems(self.text.replace(row, planted), self.tests), [], planted)


if __name__ == "__main__":
    TestNumbers.tests = tests_with_labels(sys.argv.pop())
    unittest.main()
