# SPDX-License-Identifier: Apache-2.0
"""How large a page is, when its figures are there, and how many frames a second it pans with:

    /usr/bin/python3 tests/browser/page_speed.py out/learn/report.html

Times are the browser's own: since navigation began, and from one animation frame to the next."""

import statistics
import sys
from pathlib import Path

from browser import open_page

FRAMES = """
const done = arguments[arguments.length - 1];
const share = arguments[0];
const figure = [...kelpie.figures][0];
const [first, last] = figure.whole;
figure.frame.scrollIntoView();
figure.showAll([first, first + share * (last - first)]);
const times = [];
const step = (now) => {
  times.push(now);
  if (times.length > 130) return done(times.slice(10));
  figure.pan((1 / share - 1) / 130);
  requestAnimationFrame(step);
};
setTimeout(() => requestAnimationFrame(step), 500);
"""

path = Path(sys.argv[1])
print(f"{path}: {path.stat().st_size / 1e6:.2f} MB")
for attempt in ("first", "again"):
    page = open_page(path)
    page.wait_until_drawn()
    drawn = page.run("return ['kelpie-figure', 'kelpie-all'].map((name) =>"
                     " performance.getEntriesByName(name)[0].startTime)")
    print(f"opened {attempt}: first figure after {drawn[0]:.0f} ms, all after {drawn[1]:.0f} ms")
for share in (0.5, 0.2, 0.02):
    times = page.driver.execute_async_script(FRAMES, share)
    steps = [b - a for a, b in zip(times, times[1:])]
    print(f"panning with {100 * share:.0f} % in view: {1000 / statistics.mean(steps):.0f} frames"
          f" a second, the longest after {max(steps):.0f} ms")
