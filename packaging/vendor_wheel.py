#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Puts the shared libraries that a wheel's module needs into the wheel, so that pip alone installs it.

Libraries get names of their own (with a part of their hash), so that those of another wheel in the
same process stay apart, and are found beside the module (RUNPATH). What every Linux has (the C and
C++ libraries of PEP 600) stays outside; the tag names the glibc of this system, for which it is all
built. Times are SOURCE_DATE_EPOCH, names are sorted: the same input gives the same bytes.

Needs patchelf, ldd and dpkg. usage: packaging/vendor_wheel.py WHEEL FOLDER
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile

# Of PEP 600: any system whose glibc is not older than the tag has these.
OUTSIDE = re.compile(r"(ld-linux-.*|lib(c|m|dl|rt|pthread|util|gcc_s|stdc\+\+))\.so(\..*)?$")
FOLDER = "adasplats.libs"


def said(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def needed_by(path):
    """{soname: where it is found} of what a library links directly, without what stays outside."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", said("ldd", path), flags=re.M))
    names = said("patchelf", "--print-needed", path).split()
    inside = [name for name in names if not OUTSIDE.match(name)]
    lacking = [name for name in inside if name not in found]
    if lacking:
        raise SystemExit(f"vendor_wheel: {path.name} needs {lacking[0]}, which is not on this system")
    return {name: pathlib.Path(found[name]).resolve() for name in inside}


def digest_of(content):
    return hashlib.sha256(content).digest()


def own_name(soname, path):
    """"libtbb.so.12" with a part of the file's hash: "libtbb-0123abcd.so.12"."""
    stem, dot, rest = soname.partition(".so")
    return f"{stem}-{digest_of(path.read_bytes()).hex()[:8]}{dot}{rest}"


def all_libraries(modules):
    """{soname: (file, name in the wheel)} of all that the modules need, whether directly or not."""
    libraries, waiting = {}, list(modules)
    while waiting:
        for soname, path in sorted(needed_by(waiting.pop()).items()):
            if soname not in libraries:
                libraries[soname] = (path, own_name(soname, path))
                waiting.append(path)
    return libraries


def rename(path, libraries, rpath):
    """Makes a file look for the wheel's libraries. In few calls, since a file grows with each, but
    not in one: patchelf 0.14 takes a library's name for the RUNPATH then."""
    names = [name for name in said("patchelf", "--print-needed", path).split() if name in libraries]
    replaced = [word for name in names for word in ("--replace-needed", name, libraries[name][1])]
    if replaced:
        said("patchelf", *replaced, path)
    said("patchelf", "--set-rpath", rpath, path)


def check(tree):
    """Refuses a wheel whose files are not linked to each other as they should be."""
    inside = {path.name for path in (tree / FOLDER).iterdir()}
    for path in [*tree.glob("adasplats/*.so"), *(tree / FOLDER).iterdir()]:
        for name in said("patchelf", "--print-needed", path).split():
            if not OUTSIDE.match(name) and name not in inside:
                raise SystemExit(f"vendor_wheel: {path.name} still needs {name}")
        if not said("patchelf", "--print-rpath", path).startswith("$ORIGIN"):
            raise SystemExit(f"vendor_wheel: {path.name} does not look beside itself")


def copy_licence(path, folder):
    """Puts the licence of a library's Debian package into the wheel, which redistributes it."""
    for known in (path, pathlib.Path(str(path).removeprefix("/usr"))):  # as before /lib was a link
        result = subprocess.run(["dpkg-query", "--search", known], stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True, check=False)
        if result.returncode == 0:
            package = result.stdout.split(":")[0]
            shutil.copyfile(f"/usr/share/doc/{package}/copyright", folder / f"LICENSE.{package}")
            return
    raise SystemExit(f"vendor_wheel: {path} is of no package, so its licence is not known")


def vendor(tree):
    """Copies the libraries into an unpacked wheel. Their number, and bytes."""
    modules = sorted(tree.glob("adasplats/*.so"))
    libraries = all_libraries(modules)
    folder = tree / FOLDER
    folder.mkdir()
    for path, name in libraries.values():
        shutil.copyfile(path, folder / name)
        copy_licence(path, next(tree.glob("*.dist-info")))
        said("strip", "--strip-unneeded", folder / name)
        said("patchelf", "--set-soname", name, folder / name)
        rename(folder / name, libraries, "$ORIGIN")
    for module in modules:
        said("strip", "--strip-unneeded", module)
        rename(module, libraries, f"$ORIGIN/../{FOLDER}")
    return len(libraries), sum(path.stat().st_size for path in folder.iterdir())


def retag(tree):
    """Names the glibc in the wheel's own description; the new platform tag and the old one."""
    version = os.confstr("CS_GNU_LIBC_VERSION").split()[1].replace(".", "_")
    path = next(tree.glob("*.dist-info/WHEEL"))
    text = path.read_text(encoding="utf-8")
    old = re.search(r"^Tag: [^-]+-[^-]+-(linux_\w+)$", text, flags=re.M).group(1)
    new = old.replace("linux", f"manylinux_{version}", 1)
    path.write_text(text.replace(old, new), encoding="utf-8")
    return old, new


def write_record(tree):
    """The hashes of all files, as PEP 376 has them."""
    record = next(tree.glob("*.dist-info")) / "RECORD"
    lines = []
    for path in sorted(path for path in tree.rglob("*") if path.is_file() and path != record):
        content = path.read_bytes()
        digest = base64.urlsafe_b64encode(digest_of(content)).rstrip(b"=").decode()
        lines.append(f"{path.relative_to(tree).as_posix()},sha256={digest},{len(content)}")
    lines.append(f"{record.relative_to(tree).as_posix()},,")
    record.write_text("\n".join(lines) + "\n", encoding="utf-8")


def pack(tree, wheel):
    """Writes the wheel under its name when it is whole."""
    epoch = max(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), 315532800)  # a ZIP begins in 1980
    when = time.gmtime(epoch)[:6]
    new = wheel.with_suffix(".new")
    with zipfile.ZipFile(new, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in sorted(path for path in tree.rglob("*") if path.is_file()):
            entry = zipfile.ZipInfo(path.relative_to(tree).as_posix(), when)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if ".so" in path.name else 0o100644) << 16
            archive.writestr(entry, path.read_bytes(), compresslevel=9)
    new.rename(wheel)


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 64
    for tool in ("patchelf", "ldd", "strip"):
        if shutil.which(tool) is None:
            print(f"vendor_wheel: {tool} is not installed", file=sys.stderr)
            return 69
    made, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        tree = pathlib.Path(name)
        with zipfile.ZipFile(made) as archive:
            archive.extractall(tree)
        count, size = vendor(tree)
        check(tree)
        old, new = retag(tree)
        write_record(tree)
        wheel = folder / made.name.replace(old, new)
        pack(tree, wheel)
    print(f"vendor_wheel: {wheel.name} with {count} libraries ({size / 1e6:.1f} MB unpacked), "
          f"{wheel.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
