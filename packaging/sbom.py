#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the components of packages that were made on this system, with licences, as SPDX 2.3 (JSON).

Components are the packages that a .deb depends on, the libraries that a wheel contains, the headers
and the font that are compiled in, and the npm packages of the viewer's page. Versions are those that
dpkg has installed, and those of viewer/package-lock.json. Times are SOURCE_DATE_EPOCH, or the
commit's. usage: packaging/sbom.py [--cuda VERSION] FILE... > adasplats.spdx.json
"""

import datetime
import json
import os
import pathlib
import re
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMPILED_IN = ("fonts-dejavu-core", "libboost-dev", "libcli11-dev", "libstb-dev", "nlohmann-json3-dev",
               "pybind11-dev")
# The npm packages that make the page but are not in it.
PAGE_TOOLS = ("esbuild",)
# Licences of the libraries themselves, by the beginnings of their packages' names in Debian and Ubuntu.
# Releases of liblzma before 5.6 are in the public domain.
LICENCES = {
    "fonts-dejavu": "Bitstream-Vera", "libblosc": "BSD-3-Clause", "libboost": "BSL-1.0",
    "libbz2": "bzip2-1.0.6", "libc6": "LGPL-2.1-or-later", "libcli11": "BSD-3-Clause",
    "libembree": "Apache-2.0", "libgcc-s1": "GPL-3.0-or-later WITH GCC-exception-3.1",
    "libgfortran": "GPL-3.0-or-later WITH GCC-exception-3.1", "libimath": "BSD-3-Clause",
    "libjemalloc": "BSD-2-Clause", "liblog4cplus": "Apache-2.0 OR BSD-2-Clause",
    "liblz4": "BSD-2-Clause", "liblzma": "0BSD", "libopenblas": "BSD-3-Clause",
    "libopenvdb": "MPL-2.0", "libpng": "libpng-2.0", "libpugixml": "MIT",
    "libquadmath": "LGPL-2.0-or-later", "libsharpyuv": "BSD-3-Clause", "libsnappy": "BSD-3-Clause",
    "libsqlite3": "blessing", "libssl": "Apache-2.0", "libstb": "MIT OR Unlicense",
    "libstdc++6": "GPL-3.0-or-later WITH GCC-exception-3.1", "libtbb": "Apache-2.0",
    "libtomlplusplus": "MIT", "libwebp": "BSD-3-Clause", "libzstd": "BSD-3-Clause OR GPL-2.0-only",
    "nlohmann-json": "MIT", "pybind11": "BSD-3-Clause", "zlib1g": "Zlib"}


def output_of(*command):
    result = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            text=True, check=False)
    return result.stdout.strip() if result.returncode == 0 else ""


def licence_of(name):
    for beginning, licence in LICENCES.items():
        if name.startswith(beginning):
            return licence
    raise SystemExit(f"sbom: the licence of {name} is not in the table of packaging/sbom.py")


def packages_of(path):
    """Names of the Debian packages that a .deb needs, or whose libraries are in a wheel."""
    if path.suffix == ".deb":
        depends = output_of("dpkg-deb", "--field", path, "Depends")
        if not depends:
            raise SystemExit(f"sbom: {path} has no list of packages that it needs")
        return re.findall(r"(?:^|, )([^ ,|:]+)", depends)  # the first of alternatives
    with zipfile.ZipFile(path) as wheel:  # vendor_wheel.py adds LICENSE.PACKAGE of each library
        found = (re.search(r"\.dist-info/LICENSE\.(.+)$", name) for name in wheel.namelist())
        return [match.group(1) for match in found if match]


def debian_components(paths):
    for name in sorted({name for path in paths for name in packages_of(path)} | set(COMPILED_IN)):
        version = output_of("dpkg-query", "-W", "-f", "${Version}", name)
        if version:
            yield component("deb", f"debian/{name}", version, licence_of(name))
        elif name not in COMPILED_IN:
            raise SystemExit(f"sbom: {name} is not installed, so its version is unknown")


def page_components():
    lock = json.loads((ROOT / "viewer" / "package-lock.json").read_text(encoding="utf-8"))
    for path, entry in sorted(lock["packages"].items()):
        name = path.rpartition("node_modules/")[2]
        if name and name not in PAGE_TOOLS and not entry.get("dev") and not entry.get("optional"):
            yield component("npm", name, entry["version"], entry["license"])


def component(kind, name, version, licence, comment=""):
    # SPDX allows few characters in an identifier.
    identifier = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", f"{kind}-{name}")
    locator = f"pkg:{kind}/{name}@{version}".replace("/@", "/%40")
    return {"SPDXID": identifier, "name": name.rpartition("/")[2] if kind == "deb" else name,
            "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": licence, "licenseDeclared": licence, "copyrightText": "NOASSERTION",
            **({"licenseComments": comment} if comment else {}),
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": locator}]}


def document_of(components):
    commit = output_of("git", "rev-parse", "HEAD") or "unknown"
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH") or
                output_of("git", "log", "-1", "--format=%ct") or 0)
    cmake = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    version = re.search(r"project\(adasplats VERSION (\S+)", cmake).group(1)
    release = pathlib.Path("/etc/os-release").read_text(encoding="utf-8")
    system = "".join(re.search(rf'^{key}="?([^"\n]*)', release, flags=re.M).group(1)
                     for key in ("ID", "VERSION_ID"))
    name = f"adasplats-{version}-{system}"
    ours = {"SPDXID": "SPDXRef-adasplats", "name": "adasplats", "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "sourceInfo": f"commit {commit}",
            "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0",
            "copyrightText": "2026 The adasplats authors"}
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                  "relatedSpdxElement": ours["SPDXID"]}]
    relations += [{"spdxElementId": ours["SPDXID"], "relationshipType": "DEPENDS_ON",
                   "relatedSpdxElement": each["SPDXID"]} for each in components]
    created = datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc)
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
            "name": name, "documentNamespace": f"https://spdx.org/spdxdocs/{name}-{commit}",
            "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"),
                             "creators": ["Tool: adasplats-sbom"]},
            "packages": [ours, *components], "relationships": relations}


def main():
    arguments = sys.argv[1:]
    components = []
    if arguments[:1] == ["--cuda"] and len(arguments) > 2:
        components.append(component("generic", "cuda-cudart", arguments[1], "NOASSERTION",
                                    "EULA of the NVIDIA CUDA Toolkit; redistributable"))
        arguments = arguments[2:]
    if not arguments or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 64
    components += debian_components([pathlib.Path(name).resolve() for name in arguments])
    components += page_components()
    json.dump(document_of(components), sys.stdout, indent=2)
    print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
