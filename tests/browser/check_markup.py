#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Parses a report page with Python's html.parser and checks that it is complete and self-contained.

usage: check_markup.py PAGE.html...      check_markup.py --sample PROGRAM
"""
import base64
import re
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path

VOID = {"meta", "img", "input", "br", "hr", "link"}
LOADING = {"script", "iframe", "object", "embed", "link", "base", "video", "audio", "source", "use"}


class Page(HTMLParser):
    """Collects errors in `faults`."""

    def __init__(self):
        super().__init__()
        self.faults, self.open, self.ids, self.targets = [], [], set(), []
        self.images, self.texts, self.widths = [], [], []

    def fault(self, text):
        self.faults.append(f"line {self.getpos()[0]}: {text}")

    def handle_starttag(self, tag, attributes):
        names = [name for name, _ in attributes]
        if len(names) != len(set(names)):
            self.fault(f"<{tag}> has a duplicate attribute")
        attributes = dict(attributes)
        if tag in LOADING:
            self.fault(f"<{tag}> may load something")
        for name, value in attributes.items():
            if name in ("src", "srcset", "href", "xlink:href", "action", "data", "poster"):
                if not (value or "").startswith(("data:image/", "#")):
                    self.fault(f"<{tag} {name}={(value or '')[:60]!r}> is outside of the page")
            elif name.startswith("on"):
                self.fault(f"<{tag}> has a handler {name}")
            elif name == "style":
                self.check_style(value)
        if tag == "img":
            self.images.append(attributes.get("src", ""))
            if not attributes.get("alt"):
                self.fault("<img> without alt")
        if "id" in attributes:
            if attributes["id"] in self.ids:
                self.fault(f"duplicate id {attributes['id']!r}")
            self.ids.add(attributes["id"])
        if tag == "a":
            self.targets.append(attributes.get("href", ""))
        self.count_cells(tag, attributes)
        if tag not in VOID:
            self.open.append(tag)

    def count_cells(self, tag, attributes):
        if tag == "table":
            self.widths = []
        elif tag == "tr":
            self.widths.append(0)
        elif tag in ("td", "th"):
            span = int(attributes.get("colspan", 1))
            rows_left = int(attributes.get("rowspan", 1))
            self.widths[-1] += span
            self.below = getattr(self, "below", 0) + (span if rows_left == 2 else 0)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open[-1] != tag:
            self.fault(f"</{tag}> closes {self.open[-1:]}")
            return
        self.open.pop()
        if tag == "table":
            self.check_widths()

    def check_widths(self):
        """All rows of a table have the width of the first; cells of two rows count in both."""
        first, second, *others = self.widths
        wrong = [w for w in [second + self.below, *others] if w != first]
        if wrong:
            self.fault(f"a table {first} columns wide has rows of {wrong}")
        self.below = 0

    def handle_data(self, data):
        if self.open and self.open[-1] == "style":
            self.check_style(data)
        else:
            self.texts.append(data)

    def check_style(self, style):
        if re.search(r"@import|url\s*\(|https?:", style):
            self.fault("a style loads something")


def check(path):
    """Returns the faults of a page and its parser."""
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    page.close()
    faults = [f"{path.name}: {fault}" for fault in page.faults]
    if page.open:
        faults.append(f"{path.name}: never closed: {page.open}")
    for source in page.images:
        head, _, data = source.partition(",")
        if head not in ("data:image/png;base64", "data:image/jpeg;base64"):
            faults.append(f"{path.name}: an image of {head!r}")
        else:
            base64.b64decode(data, validate=True)
    for target in page.targets:
        if target[1:] not in page.ids:
            faults.append(f"{path.name}: a link to {target}, which does not exist")
    return faults, page


def check_sample(program):
    """Checks the synthetic page: complete, with all pictures and unescaped texts."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([program, folder], check=True, timeout=60)
        faults, page = check(folder / "report.html")
        embedded = sorted(base64.b64decode(source.partition(",")[2]) for source in page.images)
        files = sorted(path.read_bytes() for path in (folder / "pictures").iterdir())
        if embedded != files or not files:
            faults.append(f"{len(embedded)} pictures in the page, {len(files)} in the folder")
        text = "".join(page.texts)
        for wanted in ("sample <street>", "mapping & more.ply", "limit | of 20 GB",
                       "Picture missing: pictures/semantic-beams.png"):
            if wanted not in text:
                faults.append(f"the page does not contain {wanted!r}")
        bad = folder / "bad.html"  # faults that the checks must detect
        bad.write_text("<p id=a><p id=a><img src='https://a.b/c.png'><script></script>"
                       "<a href='#x'>")
        if len(check(bad)[0]) < 6:
            faults.append("the checks do not detect faults")
        return faults


def main():
    if sys.argv[1:2] == ["--sample"] and len(sys.argv) == 3:
        faults = check_sample(sys.argv[2])
    elif len(sys.argv) > 1:
        faults = [fault for path in sys.argv[1:] for fault in check(Path(path))[0]]
    else:
        sys.exit(__doc__)
    print("\n".join(faults) or "the page is complete and loads nothing")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
