# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Class maps of `adasplats segment --class-map` (docs/segmentation.md, "Class maps"), read in reverse:
from your numbers to classes."""
import numpy as np

from classes import IGNORED, NAMES

NO_CLASS = ("unknown", "unlabeled")


def numbers_by_class(file):
    """{class: its numbers}, in file order."""
    found = {}
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        line = line.partition("#")[0].strip()
        if not line:
            continue
        name, equals, words = (part.strip() for part in line.partition("="))
        if not equals or not name or len(name.split()) != 1:
            raise SystemExit(f"{file}:{number}: expected CLASS = NUMBER [NUMBER...] [NAME]")
        if name in found:
            raise SystemExit(f"{file}:{number}: '{name}' for the second time")
        words = words.split()
        named = bool(words) and not words[-1].isdecimal()
        numbers = words[:-1] if named else words
        if not numbers or not all(word.isdecimal() and int(word) < 1 << 16 for word in numbers):
            raise SystemExit(f"{file}:{number}: expected numbers from 0 to 65535 for '{name}'")
        found[name] = [int(word) for word in numbers]
    return found


def read_class_map(file):
    """(names of the classes, table: number -> class). The names are the 19 if those include all."""
    numbers = {name: own for name, own in numbers_by_class(file).items() if name not in NO_CLASS}
    names = list(NAMES) if set(numbers) <= set(NAMES) else list(numbers)
    if not numbers or len(names) >= IGNORED:
        raise SystemExit(f"{file}: {len(names) if numbers else 0} classes, expected 1 to 254")
    table = np.full(1 << 16, IGNORED, np.uint8)
    for name, own in numbers.items():
        for number in own:
            if table[number] != IGNORED:
                raise SystemExit(f"{file}: number {number} is '{names[table[number]]}' and '{name}'")
            table[number] = names.index(name)
    return names, table
