#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Packs what git has of the commit that is checked out as a source distribution (PEP 517, 625).

Everything that a build needs is in git, so the archive is git's, with PKG-INFO of setuptools and
with the commit's name in a file COMMIT, since the sources are no clone then. Times are
SOURCE_DATE_EPOCH. usage: packaging/make_sdist.py FOLDER
"""

import contextlib
import gzip
import io
import os
import pathlib
import subprocess
import sys
import tarfile
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def metadata():
    """What setuptools makes of pyproject.toml."""
    from setuptools import build_meta
    # It prints each step.
    with tempfile.TemporaryDirectory() as name, contextlib.redirect_stdout(sys.stderr):
        folder = build_meta.prepare_metadata_for_build_wheel(name)
        return (pathlib.Path(name) / folder / "METADATA").read_bytes()


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], check=True, stdout=subprocess.PIPE).stdout


def version_of(info):
    return next(line.split()[1] for line in info.decode().splitlines()
                if line.startswith("Version: "))


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 64
    folder = pathlib.Path(sys.argv[1]).resolve()
    os.chdir(ROOT)
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", git("log", "-1", "--format=%ct")))
    info = metadata()
    name = f"adasplats-{version_of(info)}"
    path = folder / f"{name}.tar.gz"
    written = io.BytesIO()
    # Without the name of the file and with a fixed time in the header of gzip.
    with gzip.GzipFile("", "wb", 9, written, mtime=epoch) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for more, content in (("PKG-INFO", info), ("COMMIT", git("rev-parse", "HEAD"))):
            entry = tarfile.TarInfo(f"{name}/{more}")
            entry.size, entry.mtime, entry.mode = len(content), epoch, 0o644
            archive.addfile(entry, io.BytesIO(content))
        sources = io.BytesIO(git("archive", "--format=tar", f"--prefix={name}/", "HEAD"))
        with tarfile.open(fileobj=sources) as all_sources:
            for entry in all_sources:
                entry.mtime, entry.pax_headers = epoch, {}
                archive.addfile(entry, all_sources.extractfile(entry) if entry.isfile() else None)
    path.write_bytes(written.getvalue())
    print(f"make_sdist: {path.name}, {path.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
