#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Tests a report page in headless Chromium: not blank, loads nothing, fits its window.

usage: check_page.py PAGE.html [--shots FOLDER]      check_page.py --sample PROGRAM

--shots keeps the screenshots light.png and dark.png in FOLDER. Exits with code 77 and a message
without Chromium; CHROMIUM names another browser.
"""
import os
import re
import shutil
import socketserver
import struct
import subprocess
import sys
import tempfile
import threading
import zlib
from pathlib import Path

# No settings, updates or extensions. The browser still contacts some hosts itself, depending on its
# version; requests of a page are recognized by the host names in its text.
QUIET = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-extensions", "--no-first-run",
         "--disable-default-apps", "--no-default-browser-check", "--hide-scrollbars",
         "--disable-domain-reliability", "--disable-client-side-phishing-detection",
         "--disable-features=OptimizationHints,MediaRouter,Translate,AutofillServerCommunication"]
DARK, LIGHT = 0, 1  # Blink's PreferredColorScheme


def find_browser():
    names = [os.environ.get("CHROMIUM", ""), "chromium", "chromium-browser", "google-chrome"]
    return next(filter(None, map(shutil.which, filter(None, names))), None)


class Trap(socketserver.ThreadingTCPServer):
    """A proxy that rejects all requests and records their addresses."""
    daemon_threads = True

    class Handler(socketserver.StreamRequestHandler):
        def handle(self):
            line = self.rfile.readline(2000).decode("latin-1").split()
            if len(line) > 1:
                self.server.asked.append(line[1])
            self.wfile.write(b"HTTP/1.1 503 No\r\nContent-Length: 0\r\n\r\n")

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Trap.Handler)
        self.asked = []
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Browser:
    def __init__(self, program, folder, shots):
        self.program, self.folder, self.shots = program, Path(folder), Path(shots)

    def open(self, page, *options, scheme=LIGHT):
        """Returns the browser's output and the requested addresses."""
        with Trap() as trap:
            done = subprocess.run(
                [self.program, *QUIET, f"--proxy-server=127.0.0.1:{trap.server_address[1]}",
                 f"--user-data-dir={self.folder / 'profile'}",
                 f"--blink-settings=preferredColorScheme={scheme}", *options,
                 Path(page).resolve().as_uri()],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=True)
            trap.shutdown()
            return done.stdout.decode("utf-8"), list(trap.asked)

    def shoot(self, page, name, scheme, size="1400,6000"):
        shot = self.shots.resolve() / name
        _, asked = self.open(page, f"--screenshot={shot}", f"--window-size={size}", scheme=scheme)
        return shot, asked

    def widths(self, page, window):
        """Widths of content and window, measured by a script in a copy of the page."""
        text = Path(page).read_text(encoding="utf-8")
        text = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", text)
        script = ("<script>addEventListener('load',()=>{const e=document.documentElement;"
                  "document.title='widths '+e.scrollWidth+' '+innerWidth})</script>")
        copy = self.folder / "measured.html"
        copy.write_text(text.replace("</body>", script + "</body>"), encoding="utf-8")
        dom, _ = self.open(copy, "--dump-dom", f"--window-size={window},900")
        return tuple(map(int, re.search(r"<title>widths (\d+) (\d+)</title>", dom).groups()))


def rows_of(png):
    """Rows of a PNG as stored: filtered, so only suitable for comparing rows."""
    data, at, packed = Path(png).read_bytes(), 8, b""
    width, _, depth, color = struct.unpack(">IIBB", data[16:26])
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    bytes_a_row = 1 + width * {2: 3, 6: 4}[color] * depth // 8
    pixels = zlib.decompress(packed)
    return [pixels[k:k + bytes_a_row] for k in range(0, len(pixels), bytes_a_row)]


def is_blank(png):
    """Rows of one colour have few encodings; a page of text has hundreds of different rows."""
    return len(set(rows_of(png))) < 100


def host_of(address):
    return re.split("[/:]+", address.removeprefix("http://"))[0]


def check(browser, page):
    faults, shots = [], []
    text = Path(page).read_text(encoding="utf-8")
    for name, scheme in (("light.png", LIGHT), ("dark.png", DARK)):
        shot, asked = browser.shoot(page, name, scheme)
        shots.append(shot.read_bytes())
        faults += [f"the page requested {address}" for address in asked
                   if host_of(address) in text]
        if is_blank(shot):
            faults.append(f"{name} is blank")
    if shots[0] == shots[1]:
        faults.append("light and dark look the same")
    for window in (1400, 500):
        content, inside = browser.widths(page, window)
        if content > inside:
            faults.append(f"in a window of {inside} pixels the page is {content} wide")
    return faults


def check_itself(browser):
    """Tests that the checks detect a blank page, network requests and a page that is too wide."""
    page = browser.folder / "bad.html"
    page.write_text("<!DOCTYPE html><body><img src='http://picture.invalid/a.png'>"
                    "<p style='width:3000px'>.</body>")
    faults = check(browser, page)
    wanted = ("picture.invalid", "blank", "look the same", "the page is 30")
    return [f"the checks do not detect: {text}" for text in wanted
            if not any(text in fault for fault in faults)]


def main():
    program = find_browser()
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if program is None:
        print("skipped: Chromium not found")
        return 77
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        browser = Browser(program, name, sys.argv[3] if sys.argv[2:3] == ["--shots"] else name)
        if sys.argv[1] == "--sample":
            subprocess.run([sys.argv[2], name], check=True, timeout=60)
            faults = check_itself(browser) + check(browser, Path(name) / "report.html")
        else:
            faults = check(browser, sys.argv[1])
    print("\n".join(faults) or "the page is shown in light and dark mode and loads nothing")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
