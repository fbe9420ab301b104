#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes what a built file of kelpie consists of, as a software bill of materials (SPDX 2.3, JSON).

Usage: scripts/sbom.py BUILD FILE OUT   (FILE: the program, or the Python module; CMake calls this)

The compiler's and linker's own records are read, not a list kept by hand: packages of Debian whose
headers the sources of FILE included, packages whose shared libraries FILE asks the loader for, and
uPlot, where pages have figures. The date is $SOURCE_DATE_EPOCH, so the same build gives the same
bytes. Needs Debian's dpkg, binutils and, for a build by Ninja, ninja.
"""

import hashlib
import json
import os
import platform
import re
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import quote

ROOT = Path(__file__).resolve().parent.parent
# By Debian's source package, for the parts that programs link or include; after the files
# `copyright` of the packages. Licences of tests and tools beside such parts are left out.
LICENCES = {
    "bzip2": "bzip2-1.0.6", "cli11": "BSD-3-Clause", "cyclonedds": "EPL-2.0 OR BSD-3-Clause",
    "eigen3": "MPL-2.0", "fmtlib": "MIT", "gcc": "GPL-3.0-or-later WITH GCC-exception-3.1",
    "glibc": "LGPL-2.1-or-later", "hdf5": "BSD-3-Clause", "highway": "Apache-2.0",
    "libmatio": "BSD-2-Clause", "libmicrohttpd": "LGPL-2.1-or-later", "libzip": "BSD-3-Clause",
    "libzstd": "BSD-3-Clause OR GPL-2.0-only", "linux": "GPL-2.0-only WITH Linux-syscall-note",
    "lz4": "BSD-2-Clause", "nlohmann-json3": "MIT",
    "openssl": "Apache-2.0", "pybind11": "BSD-3-Clause", "python3": "PSF-2.0",
    "sqlite3": "blessing", "systemd": "LGPL-2.1-or-later", "tinyxml2": "Zlib",
    "tomlplusplus": "MIT", "yaml-cpp": "MIT", "zlib": "Zlib",
}
TOOLCHAIN = re.compile(r"gcc-\d+|glibc|linux|cross-toolchain-base")


def lines_of(*command: str, may_fail: bool = False) -> list[str]:
    """What a command prints."""
    done = subprocess.run(command, capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C"})
    if done.returncode != 0 and not may_fail:
        raise SystemExit(f"{' '.join(command[:4])}: {done.stderr.strip()}")
    return done.stdout.splitlines()


def headers_of(build: Path, rooms: tuple[str, ...]) -> set[str]:
    """Headers of the system that the sources of some folders included."""
    headers = set()
    if (build / ".ninja_deps").exists():
        wanted = False
        for line in lines_of("ninja", "-C", str(build), "-t", "deps"):
            if line.startswith("    "):
                if wanted:
                    headers.add(line.strip())
            elif ": #deps" in line:
                wanted = line.startswith(rooms) and "(VALID)" in line
    for room in rooms:  # of Make
        for record in (build / room).rglob("*.o.d"):
            words = record.read_text(encoding="utf-8").replace("\\\n", " ").split()
            headers.update(word for word in words if word.startswith("/"))
    return {os.path.realpath(header) for header in headers if header.startswith("/usr/")}


def libraries_of(file: Path) -> set[str]:
    """Shared libraries that a file asks the loader for."""
    machine = re.search(r"Machine:\s+(.*)", "\n".join(lines_of("readelf", "-h", str(file))))[1]
    folder = {"AArch64": "aarch64-linux-gnu"}.get(machine, "x86_64-linux-gnu")
    names = re.findall(r"\(NEEDED\).*\[(.*)\]", "\n".join(lines_of("readelf", "-d", str(file))))
    paths = (f"/usr/lib/{folder}/{name}" for name in names)
    return {os.path.realpath(path) for path in paths if os.path.exists(path)}


def packages_of(files: set[str]) -> set[str]:
    """Debian's packages that files belong to. On old roots /lib and /usr/lib are one folder."""
    both = sorted(files | {file.removeprefix("/usr") for file in files if "/lib/" in file})
    found = lines_of("dpkg-query", "--search", *both, may_fail=True) if both else []
    return {name for line in found if ": /" in line for name in line.split(": /")[0].split(", ")}


def described(package: str) -> dict:
    """A package as SPDX has it."""
    form = "${Package}\t${Version}\t${Architecture}\t${source:Package}\t${Homepage}"
    name, version, architecture, source, home = lines_of(
        "dpkg-query", "-W", "-f", form, package)[0].split("\t")
    licence = LICENCES.get(re.sub(r"^(gcc|python3)[-.]\d+(-cross)?$", r"\1", source), "NOASSERTION")
    release = platform.freedesktop_os_release().get("VERSION_ID", "sid")
    entry = {
        "SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name,
        "versionInfo": version, "supplier": "Organization: Debian", "filesAnalyzed": False,
        "downloadLocation": "NOASSERTION", "licenseConcluded": licence,
        "licenseDeclared": licence, "copyrightText": "NOASSERTION",
        "sourceInfo": f"Debian's source package {source}",
        "externalRefs": [{
            "referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
            "referenceLocator": f"pkg:deb/debian/{quote(name)}@{quote(version)}"
                                f"?arch={architecture}&distro=debian-{release}"}]}
    if home:
        entry["homepage"] = home
    return entry


def uplot(build: Path) -> list[dict]:
    """The library that draws figures, where the pages of the build have figures."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    manifest = Path(re.search(r"^KELPIE_UPLOT:\w+=(.*)$", cache, re.M)[1]) / "package.json"
    if not manifest.exists():
        return []
    told = json.loads(manifest.read_text(encoding="utf-8"))
    return [{
        "SPDXID": "SPDXRef-uplot", "name": "uplot", "versionInfo": told["version"],
        "filesAnalyzed": False, "downloadLocation": "NOASSERTION",
        "licenseConcluded": told["license"], "licenseDeclared": told["license"],
        "copyrightText": "NOASSERTION",
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": f"pkg:npm/uplot@{told['version']}"}]}]


def document(build: Path, file: Path) -> dict:
    """The bill of materials of a file of a build."""
    version = re.search(r"project\(kelpie VERSION ([0-9.]+)",
                        (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    module = file.name.startswith("_kelpie")
    rooms = ("src/library/", "src/logs/", "src/tools/", "python/" if module else "src/live/")
    linked = sorted(map(described, packages_of(libraries_of(file))), key=lambda p: p["name"])
    included = sorted(map(described, packages_of(headers_of(build, rooms))),
                      key=lambda p: p["name"])
    bundled = uplot(build)
    name = "python3-kelpie" if module else file.name
    own = {"SPDXID": "SPDXRef-kelpie", "name": name, "versionInfo": version,
           "supplier": "Organization: The kelpie developers", "filesAnalyzed": False,
           "downloadLocation": "NOASSERTION", "licenseConcluded": "Apache-2.0",
           "licenseDeclared": "Apache-2.0", "copyrightText": "The kelpie developers"}
    sources = {package["sourceInfo"] for package in linked}

    def relation(package: dict) -> dict:
        """How an included package takes part: templates without a library are compiled in."""
        if package["sourceInfo"] in sources or TOOLCHAIN.search(package["sourceInfo"]):
            return {"spdxElementId": package["SPDXID"], "relationshipType": "BUILD_DEPENDENCY_OF",
                    "relatedSpdxElement": own["SPDXID"]}
        return {"spdxElementId": own["SPDXID"], "relationshipType": "STATIC_LINK",
                "relatedSpdxElement": package["SPDXID"]}

    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                  "relatedSpdxElement": own["SPDXID"]}]
    relations += [{"spdxElementId": own["SPDXID"], "relationshipType": kind,
                   "relatedSpdxElement": package["SPDXID"]}
                  for kind, packages in (("DYNAMIC_LINK", linked), ("CONTAINS", bundled))
                  for package in packages]
    relations += map(relation, included)
    known = {package["SPDXID"]: package for package in [own, *linked, *included, *bundled]}
    content = {"packages": list(known.values()), "relationships": relations}
    mark = hashlib.sha256(json.dumps(content).encode()).hexdigest()[:32]
    date = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH") or time.time()))
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
            "name": f"{name}-{version}",
            "documentNamespace": f"https://kelpie.invalid/spdx/{name}-{version}-{mark}",
            "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", date),
                             "creators": ["Tool: kelpie-scripts/sbom.py",
                                          "Organization: The kelpie developers"]}, **content}


def main() -> None:
    """The command."""
    if len(sys.argv) != 4:
        raise SystemExit("usage: scripts/sbom.py BUILD FILE OUT")
    build, file, out = map(Path, sys.argv[1:])
    Path(out).write_text(json.dumps(document(build, file), indent=1, ensure_ascii=False) + "\n",
                         encoding="utf-8")


if __name__ == "__main__":
    main()
