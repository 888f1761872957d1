"""The committed scenes are what scripts/make_assets.py writes."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ("*.gltf", "*.glb", "*.hdr")


class Assets(unittest.TestCase):
    def test_committed_scenes_are_those_the_script_makes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", ROOT / "scripts" / "make_assets.py", folder], check=True)
            made = {file.name: file for pattern in SCENES for file in pathlib.Path(folder).glob(pattern)}
            committed = {file.name: file for pattern in SCENES for file in (ROOT / "assets").glob(pattern)}
            self.assertEqual(sorted(made), sorted(committed))
            for name, file in made.items():
                self.assertTrue(file.read_bytes() == committed[name].read_bytes(), f"{name} differs: run scripts/make_assets.py")

    def test_every_scene_has_a_license_line(self):
        readme = (ROOT / "assets" / "README.md").read_text(encoding="utf-8")
        for pattern in SCENES:
            for file in (ROOT / "assets").glob(pattern):
                lines = [line for line in readme.splitlines() if file.name in line]
                self.assertTrue(any("CC0" in line for line in lines), f"assets/README.md: no CC0 line for {file.name}")

    def test_the_demo_stays_small(self):
        self.assertLess((ROOT / "assets" / "demo.glb").stat().st_size, 300_000)


if __name__ == "__main__":
    unittest.main()
