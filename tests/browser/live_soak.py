# SPDX-License-Identifier: Apache-2.0
"""Looks at the page of a run for ten minutes: what its JavaScript holds in memory, and errors.

    KELPIE_BUILD_DIR=build/release /usr/bin/python3 tests/browser/live_soak.py [MINUTES]

The replay runs twice as quick as it was recorded, so that its window of five minutes is full
after two and a half. Memory is that of the JavaScript heap after a collection."""

import sys
import tempfile
import time
from pathlib import Path

from browser import open_page
from live_run import live_run, write_mission


def heap_mb(page) -> float:
    page.cdp("HeapProfiler.collectGarbage")
    return page.cdp("Runtime.getHeapUsage")["usedSize"] / 1e6


def elements(page) -> int:
    return page.run("return document.querySelectorAll('*').length")


def main() -> int:
    minutes = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_mission(folder / "mission.db3", 120 * minutes + 120)
        with live_run(folder, folder / "mission.db3", "2") as run:
            page = open_page(run.address)
            page.wait("live.figures().length > 0 && live.figures().every((one) => one.figure)", 120)
            page.cdp("HeapProfiler.enable")
            errors: list[str] = []
            begin = time.monotonic()
            while (past := (time.monotonic() - begin) / 60) < minutes:
                newest, samples = page.run(
                    "const [t] = live.columns(); return [t.at(-1), t.length]")
                errors += page.console()
                print(f"{past:5.1f} min: {heap_mb(page):6.2f} MB, {elements(page)} elements, "
                      f"{samples} samples up to {newest:.0f} s, {len(errors)} errors", flush=True)
                time.sleep(30)
            print("\n".join(errors), end="")
            print(f"{minutes:5.1f} min: {heap_mb(page):6.2f} MB, {elements(page)} elements, "
                  f"{len(errors)} errors")
            return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
