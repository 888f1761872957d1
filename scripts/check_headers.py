#!/usr/bin/env python3
"""Fails where a public header does not compile alone.

usage: scripts/check_headers.py COMPILER [ROOT]
"""
import pathlib
import subprocess
import sys


def main():
    compiler = sys.argv[1]
    root = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else pathlib.Path(__file__).parents[1])
    headers = sorted((root / "engine" / "include").rglob("*.hpp"))
    failed = 0
    for header in headers:
        name = header.relative_to(root / "engine" / "include").as_posix()
        command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                   f"-I{root / 'engine' / 'include'}", f"-I{root / 'shaders'}", "-x", "c++", "-"]
        # Twice, so that a missing include guard is seen too.
        done = subprocess.run(command, input=f'#include "{name}"\n' * 2, text=True, check=False)
        if done.returncode != 0:
            print(f"{name} does not compile alone")
            failed += 1
    if not headers:
        print(f"no header under {root / 'engine' / 'include'}")
    return 0 if headers and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
