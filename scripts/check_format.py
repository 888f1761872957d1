#!/usr/bin/env python3
"""Fails where clang-format 14 would change a C++ or GLSL source; with --fix changes it.

Exits with 77 (skipped) where clang-format-14 is not installed, with 1 if ISOPHOTE_REQUIRE_TOOLS is set.
"""
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = ("engine", "shaders", "cli", "viewer", "tests", "bench")
SUFFIXES = {".cpp", ".hpp", ".h", ".comp", ".glsl"}


def main():
    tool = shutil.which("clang-format-14")
    if not tool:
        print("clang-format-14 is not installed")
        return 1 if os.environ.get("ISOPHOTE_REQUIRE_TOOLS") else 77
    files = sorted(str(file) for folder in FOLDERS for file in (ROOT / folder).rglob("*") if file.suffix in SUFFIXES)
    how = ["-i"] if "--fix" in sys.argv[1:] else ["--dry-run", "--Werror", "--ferror-limit=1"]
    return subprocess.run([tool, *how, *files], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
