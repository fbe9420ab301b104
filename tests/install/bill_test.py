# SPDX-License-Identifier: Apache-2.0
"""An installed bill of materials is one of SPDX 2.3, and names what kelpie is known to consist of.

Usage: bill_test.py BILL VERSION NAME...   (NAME: a package that has to be there)
"""

import json
import re
import sys

# Fields of the schema of SPDX 2.3; no others are allowed.
DOCUMENT = {"spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo",
            "packages", "relationships"}
PACKAGE = {"SPDXID", "name", "versionInfo", "supplier", "filesAnalyzed", "downloadLocation",
           "licenseConcluded", "licenseDeclared", "copyrightText", "sourceInfo", "homepage",
           "externalRefs"}
REQUIRED = {"SPDXID", "name", "downloadLocation"}
KINDS = {"DESCRIBES", "DYNAMIC_LINK", "STATIC_LINK", "CONTAINS", "BUILD_DEPENDENCY_OF"}
PURL = re.compile(r"pkg:(deb/debian/[a-z0-9A-F%.+-]+@[^?\s]+\?arch=[a-z0-9]+&distro=debian-\w+"
                  r"|npm/uplot@[0-9.]+)")


def check(bill: dict, version: str, wanted: set) -> None:
    """Raises AssertionError on the first rule that the bill breaks."""
    assert set(bill) == DOCUMENT, set(bill) ^ DOCUMENT
    assert (bill["spdxVersion"], bill["dataLicense"]) == ("SPDX-2.3", "CC0-1.0")
    assert bill["SPDXID"] == "SPDXRef-DOCUMENT"
    assert re.fullmatch(r"https://[^#\s]+", bill["documentNamespace"])
    assert set(bill["creationInfo"]) == {"created", "creators"}
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", bill["creationInfo"]["created"])
    for creator in bill["creationInfo"]["creators"]:
        assert re.match(r"(Tool|Person|Organization): \S", creator), creator
    packages = {package["SPDXID"]: package for package in bill["packages"]}
    assert len(packages) == len(bill["packages"]), "two packages have one SPDXID"
    for package in bill["packages"]:
        assert REQUIRED <= set(package) <= PACKAGE, package
        assert re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", package["SPDXID"]), package["SPDXID"]
        assert package["versionInfo"] and package["filesAnalyzed"] is False
        assert package["licenseConcluded"] != "NOASSERTION", \
            f"scripts/sbom.py knows no licence of {package['name']} ({package['sourceInfo']})"
        for reference in package.get("externalRefs", []):
            assert set(reference) == {"referenceCategory", "referenceType", "referenceLocator"}
            assert PURL.fullmatch(reference["referenceLocator"]), reference
    assert packages["SPDXRef-kelpie"]["versionInfo"] == version
    others = set(packages)
    for relation in bill["relationships"]:
        ends = {relation["spdxElementId"], relation["relatedSpdxElement"]}
        assert ends <= {*packages, "SPDXRef-DOCUMENT"}, relation
        assert relation["relationshipType"] in KINDS, relation
        others -= ends
    assert not others, f"no relation says how these take part: {others}"
    missing = wanted - {package["name"] for package in bill["packages"]}
    assert not missing, f"the bill lacks {missing}"


with open(sys.argv[1], encoding="utf-8") as text:
    check(json.load(text), sys.argv[2], set(sys.argv[3:]))
