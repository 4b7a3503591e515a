#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Prints what a build on this system is made of, as SPDX 2.3 (JSON).

The packages are those that scripts/setup.sh lists for the program, with the versions that dpkg has
installed, and those of the viewer's page with the versions of viewer/package-lock.json. Times are
SOURCE_DATE_EPOCH, or the commit's. usage: packaging/sbom.py > adasplats.spdx.json
"""

import datetime
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def said(*command):
    result = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            text=True, check=False)
    return result.stdout.strip() if result.returncode == 0 else ""


def debian_packages():
    """(name, version) of what setup.sh lists for the program and dpkg has."""
    text = (ROOT / "scripts" / "setup.sh").read_text(encoding="utf-8")
    listed = re.search(r"<<'LIST'\n(.*?)^LIST$", text, flags=re.M | re.S).group(1)
    for line in listed.splitlines():
        when, name = line.split()[:2]
        version = said("dpkg-query", "-W", "-f", "${Version}", name)
        if when in ("demo", "maybe") and version:
            yield name, version


def page_packages():
    """(name, version) of what the viewer's page is bundled of."""
    lock = json.loads((ROOT / "viewer" / "package-lock.json").read_text(encoding="utf-8"))
    for path, entry in sorted(lock["packages"].items()):
        if path and not entry.get("dev") and not entry.get("optional"):  # those of other systems
            yield path.rpartition("node_modules/")[2], entry["version"]


def package(name, version, kind):
    """An entry whose identifier has only what SPDX allows in one."""
    identifier = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", f"{kind}-{name}")
    locator = {"deb": f"pkg:deb/debian/{name}@{version}", "npm": f"pkg:npm/{name}@{version}"}[kind]
    return {"SPDXID": identifier, "name": name, "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": locator.replace("/@", "/%40")}]}


def main():
    commit = said("git", "rev-parse", "HEAD") or "unknown"
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH") or said("git", "log", "-1", "--format=%ct") or 0)
    cmake = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    version = re.search(r"project\(adasplats VERSION (\S+)", cmake).group(1)
    ours = {"SPDXID": "SPDXRef-adasplats", "name": "adasplats", "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "sourceInfo": f"commit {commit}",
            "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0",
            "copyrightText": "2026 The adasplats authors"}
    used = [package(*each, "deb") for each in debian_packages()]
    used += [package(*each, "npm") for each in page_packages()]
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                  "relatedSpdxElement": ours["SPDXID"]}]
    relations += [{"spdxElementId": ours["SPDXID"], "relationshipType": "DEPENDS_ON",
                   "relatedSpdxElement": each["SPDXID"]} for each in used]
    created = datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc)
    document = {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
                "name": f"adasplats-{version}",
                "documentNamespace": f"https://spdx.org/spdxdocs/adasplats-{version}-{commit}",
                "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"),
                                 "creators": ["Tool: adasplats-sbom"]},
                "packages": [ours, *used], "relationships": relations}
    json.dump(document, sys.stdout, indent=2)
    print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
