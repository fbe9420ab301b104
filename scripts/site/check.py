#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks a site in a folder: every link and anchor, clicks from the start page, its size, and that
style sheets and scripts need no server.

Pages of Doxygen are entered, but their own links are Doxygen's. Usage: check.py FOLDER
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

MOST_CLICKS = 3
BY_SEARCH = ("search.html", "genindex.html", "py-modindex.html")  # reached by the field for words
MOST_BYTES = 300_000  # of the start page with all that it loads but animations (.gif)


class Page(HTMLParser):
    """Links, loaded files and anchors of a page."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loads, self.anchors = set(), set(), set()
        self.feed(file.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[key] for key in ("id", "name") if values.get(key)}
        if tag == "a" and values.get("href"):
            self.links.add(values["href"])
        if tag in ("img", "script") and values.get("src"):
            self.loads.add(values["src"])
        if tag == "link" and "stylesheet" in (values.get("rel") or ""):
            self.loads.add(values["href"])


def target(file, link):
    """The file and anchor of a link within the site; None for other sites."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    place = (file.parent / unquote(parts.path)).resolve() if parts.path else file
    return (place / "index.html" if place.is_dir() else place), unquote(parts.fragment)


def main(folder):
    root = Path(folder).resolve()
    own = [file for file in root.rglob("*.html") if "api/cpp" not in str(file.relative_to(root))]
    pages = {file: Page(file) for file in own}
    faults = []
    near = {root / "index.html": 0}
    queue = list(near)
    for file in queue:  # grows
        for link in pages[file].links:
            found = target(file, link)
            if found and found[0] in pages and found[0] not in near:
                near[found[0]] = near[file] + 1
                queue.append(found[0])
    for file, page in pages.items():
        name = file.relative_to(root)
        for link in sorted(page.links | page.loads):
            found = target(file, link)
            if found is None:
                continue
            place, anchor = found
            if not place.exists():
                faults.append(f"{name}: {link}: no such file")
            elif anchor and place in pages and anchor not in pages[place].anchors:
                faults.append(f"{name}: {link}: no such anchor")
        if near.get(file, MOST_CLICKS + 1) > MOST_CLICKS and name.name not in BY_SEARCH:
            faults.append(f"{name}: more than {MOST_CLICKS} clicks from the start page")
    for file in (root / "_static").rglob("*"):
        text = file.read_text(encoding="utf-8") if file.suffix in (".css", ".js") else ""
        if text.startswith(("@import url(/", "import ")):
            faults.append(f"{file.relative_to(root)}: works from a server alone")
    start = root / "index.html"
    loaded = {target(start, link)[0] for link in pages[start].loads if target(start, link)}
    size = sum(file.stat().st_size for file in {start, *loaded}
               if file.exists() and file.suffix != ".gif")
    if size > MOST_BYTES:
        faults.append(f"index.html: {size} bytes with all that it loads; at most {MOST_BYTES}")
    for fault in faults:
        print(fault, file=sys.stderr)
    links = sum(len(page.links) for page in pages.values())
    print(f"{len(pages)} pages, {links} links, start page {size / 1000:.0f} kB")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
