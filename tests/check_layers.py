#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks that every folder includes only itself and the folders before it."""
import pathlib
import re
import sys

FOLDERS = ("base mechanics geometry quadrature discretization loads operators solvers "
           "output procedures studies").split()
root = pathlib.Path(__file__).resolve().parent.parent
errors = 0
for place in ("include/softcell", "source"):
    for folder in (root / place).iterdir():
        if not folder.is_dir():
            continue
        if folder.name not in FOLDERS:
            print(f"{folder.relative_to(root)}: not one of the folders {', '.join(FOLDERS)}")
            errors += 1
            continue
        for file in sorted(folder.rglob("*.*")):
            for number, line in enumerate(file.read_text().splitlines(), 1):
                match = re.match(r'\s*#\s*include\s*[<"]softcell/(\w+)/', line)
                if match and (match[1] not in FOLDERS
                              or FOLDERS.index(match[1]) > FOLDERS.index(folder.name)):
                    print(f"{file.relative_to(root)}:{number}: {folder.name} may not include {match[1]}")
                    errors += 1
sys.exit(1 if errors else 0)
