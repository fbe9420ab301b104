# SPDX-License-Identifier: Apache-2.0
"""Every page that kelpie writes, in a browser. Screenshots are kept in $KELPIE_SCREENSHOTS."""

import functools
import math
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from browser import missing, open_page

if missing():
    pytest.skip(f"no browser to look at pages with: {missing()} isn't installed "
                "(scripts/setup.sh installs it)", allow_module_level=True)

from selenium.webdriver import ActionChains, Keys  # noqa: E402

SOURCE_DIR = Path(__file__).resolve().parents[2]
BUILD_DIR = Path(os.environ["KELPIE_BUILD_DIR"])
EVIL = "<script>window.hacked=1</script>\"'&\u202e"
SCENARIO = f"""
vehicle = '{SOURCE_DIR / "vehicles/dagon.toml"}'
rate_hz = 1.0
[[configurations]]
name = 'a'
[[phases]]
configuration = 'a'
duration_s = 8100.0
"""
# A thruster loses 40 % of its thrust. Short: what counts is what the pages make of that.
DAMAGE_S = 500
DAMAGED = f"""
vehicle = '{SOURCE_DIR / "vehicles/dagon.toml"}'
rate_hz = 4.0
noise = 'as_recorded'
[[configurations]]
name = 'nominal'
[[configurations]]
name = 'damaged'
effectiveness = {{ surge_right = 0.6 }}
[[phases]]
configuration = 'nominal'
duration_s = {DAMAGE_S}.0
[[phases]]
configuration = 'damaged'
duration_s = 250.0
"""
# Pages show alike what was learned of few samples and of many.
FEW_SAMPLES = ["--set", "buffer=60", "--set", "anchors=20"]
UNITS = "u=m/s,v=m/s,r=rad/s,udot=m/s^2,vdot=m/s^2,rdot=rad/s^2"
STUDY = """
name = 'two missions'
[[vehicle]]
name = 'small'
logs = ['short.csv']
[[vehicle]]
name = 'damaged'
logs = ['damaged.csv']
"""


# The real log of this machine has no place here: its figures are those of any stream.
WITHOUT_DATA = {name: value for name, value in os.environ.items() if name != "KELPIE_DATA_DIR"}


def call(program: str, *arguments, folder: Path) -> None:
    run = subprocess.run([BUILD_DIR / program, *arguments], cwd=folder, text=True,
                         capture_output=True, env=WITHOUT_DATA)
    assert run.returncode == 0, run.stderr


def evil_log(log: Path) -> str:
    """The log again, with columns of names that attack a page."""
    lines = log.read_text().splitlines()
    names = lines[0].split(",")
    for old, new in (("udot", "udot" + EVIL), ("vdot", "vdot" + 10_000 * "x")):
        names[names.index(old)] = '"' + new.replace('"', '""') + '"'
    return "\n".join([",".join(names), *lines[1:]])


@pytest.fixture(scope="session")
def pages(tmp_path_factory) -> dict[str, Path]:
    """One of each kind; two at a time are written."""
    folder = tmp_path_factory.mktemp("pages")
    kelpie = functools.partial(call, "kelpie", folder=folder)
    kelpie("simulate", SOURCE_DIR / "scenarios/small.toml", "--out", "log.csv")
    short = (folder / "log.csv").read_text().splitlines()[:1201]
    (folder / "short.csv").write_text("\n".join([*short, ""]))
    (folder / "damaged.toml").write_text(DAMAGED)
    kelpie("simulate", "damaged.toml", "--out", "damaged.csv")
    hostile = folder / f"{EVIL.replace('/', ' ')}.csv"
    hostile.write_text(evil_log(folder / "short.csv"))
    (folder / "study.toml").write_text(STUDY)
    scenarios = folder / "scenarios"
    scenarios.mkdir()
    (scenarios / "tiny.toml").write_text(SCENARIO)

    def learn() -> None:
        kelpie("learn", "log.csv", *FEW_SAMPLES, "--out", "learn")
        kelpie("rollout", "log.csv", "--model", "learn/model.json", "--out", "rollout")
        kelpie("learn", "log.csv", "--targets", "udot", *FEW_SAMPLES, "--out", "axis")

    def reproduce() -> None:
        call("kelpie-lab", "reproduce", "--quick", "--scenario", "tiny", "--out", "reproduce",
             folder=folder)

    steps = [
        learn,
        lambda: kelpie("study", "study.toml", "--out", "study"),
        lambda: kelpie("learn", "damaged.csv", "--units", UNITS, *FEW_SAMPLES, "--out", "damaged"),
        lambda: kelpie("tune", "short.csv", "--candidates", "4", "--set", "terms=none",
                       *FEW_SAMPLES, "--threads", "1", "--out", "tune"),
        lambda: kelpie("compare", "short.csv", *FEW_SAMPLES, "--threads", "1", "--out",
                       "compare"),
        lambda: kelpie("learn", hostile, "--targets", "udot" + EVIL, "--targets",
                       "vdot" + 10_000 * "x", "--set", "learner=svr", *FEW_SAMPLES, "--out",
                       "hostile"),
        lambda: kelpie("identify", "log.csv", "--out", "identify")]
    found = {"damaged": "damaged/report.html", "identify": "identify/identify.html",
             "study": "study/study.html", "learn": "learn/report.html", "axis": "axis/report.html",
             "rollout": "rollout/report.html", "tune": "tune/tune.html",
             "compare": "compare/compare.html", "hostile": "hostile/report.html"}
    if (BUILD_DIR / "kelpie-lab").exists():
        steps.insert(0, reproduce)
        found |= {"reproduce": "reproduce/reproduction.html"}
    with ThreadPoolExecutor(2) as pool:
        for done in [pool.submit(step) for step in steps]:
            done.result()
    return {name: folder / path for name, path in found.items()}


@pytest.fixture
def learned(pages):
    """The page of `kelpie learn` of one axis, drawn afresh."""
    page = open_page(pages["axis"])
    page.wait_until_drawn()
    yield page
    assert page.console() == []


def windows(page) -> list[list[float]]:
    """What of time each figure over time shows."""
    return page.run("return [...kelpie.figures].filter((f) => f.group === 'time' && f.visible)"
                    ".map((f) => [f.plot.scales.x.min, f.plot.scales.x.max])")


def settle(page) -> None:
    page.driver.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => "
        "setTimeout(done)));")


def show_all(page) -> None:
    """Of the samples; a minute is shown first."""
    page.run("const [first] = kelpie.figures; first.showAll(first.whole)")
    settle(page)


def plot_of(page, number: int = 0):
    plot = page.driver.find_elements("css selector", ".u-over")[number]
    page.run("arguments[0].scrollIntoView({block: 'center'})", plot)
    settle(page)
    return plot


# Wide and dark, narrow and light are looked at where somebody does.
LOOKS = [(1300, False), (400, True)]
if "KELPIE_SCREENSHOTS" in os.environ:
    LOOKS += [(1300, True), (400, False)]


@pytest.mark.parametrize(("width", "dark"), LOOKS)
def test_every_page_is_drawn_without_a_word_on_the_console(pages, width, dark):
    for name, path in pages.items():
        page = open_page(path, width, dark)
        page.wait_until_drawn()
        assert page.console() == [], name
        figures, drawn, wide, paper = page.run(
            "const all = [...document.querySelectorAll('figure.chart')];"
            "return [all.length, all.filter((one) => one.querySelector('.uplot')).length,"
            "document.documentElement.scrollWidth,"
            "getComputedStyle(document.body).backgroundColor]")
        assert drawn == figures > 0, name
        assert wide <= width, f"{name} is wider than its window"
        assert (paper == "rgb(255, 255, 255)") == (not dark), name
        assert not page.run("return window.hacked"), name
        assert "\u202e" not in page.run("return document.documentElement.textContent"), name
        page.screenshot(f"{name}_{width}_{'dark' if dark else 'light'}")


FIRST_SCREEN = """
const box = (node) => node.getBoundingClientRect();
const texts = [...document.querySelectorAll("h1, p, td, th, code, figcaption")]
    .filter((node) => box(node).height > 0 && box(node).bottom <= 900)
    .map((node) => node.textContent);
return [texts.join(" | "), document.documentElement.scrollHeight];
"""


def first_screen(page_path) -> tuple[str, int]:
    """What stands in the first 900 pixels of a wide window, and how high the page is."""
    page = open_page(page_path, 1400)
    page.wait_until_drawn()
    text, height = page.run(FIRST_SCREEN)
    assert page.console() == []
    return text, height


@pytest.mark.parametrize(("name", "words"), [
    ("learn", ["Predictions of", "very good", "No change of the vehicle", "velocities", "u, v, r",
               "commands", "th1, th2, th3", "least squares", "kelpie rollout log.csv"]),
    ("damaged", ["th2 gives 60", f"since {DAMAGE_S} s", "Predictions of", "velocities", "commands",
                 f"at {DAMAGE_S} s"]),
    ("compare", ["kelpie beside simpler models", "mean of the axes", "least squares",
                 "behind the best"]),
    ("rollout", ["After 10 s surge is within", "velocity held", "Root mean square errors"]),
    ("tune", ["gain", "least squares", "Score: each stretch"]),
    ("identify", ["parameters identified", "90 % interval", "surge_inertia"]),
    ("study", ["Changes were found on damaged", "th2 gives"]),
])
def test_the_first_screen_holds_the_message(pages, name, words):
    text, _ = first_screen(pages[name])
    assert [word for word in words if word not in text] == [], text


def test_the_headline_comes_first_and_units_are_as_people_write_them(pages):
    page = open_page(pages["damaged"], 1400)
    page.wait_until_drawn()
    assert page.run("return document.querySelector('h1').textContent").startswith("th2 gives 60")
    assert page.run("return [...kelpie.figures][0].description.y.label") == "udot in m/s²"
    assert "m/s from ahead" in page.run("return document.body.textContent")
    marks = page.run("return [...kelpie.figures][0].description.marks.map(({ x }) => x)")
    assert all(abs(mark - DAMAGE_S) < 1 for mark in marks), "changes stand where they happened"
    page.run("[...kelpie.figures][0].frame.scrollIntoView()")
    page.wait("[...kelpie.figures][0].visible")
    first, last = windows(page)[0]
    assert last - first == pytest.approx(60) and first < DAMAGE_S < last


@pytest.mark.parametrize("name", ["learn", "damaged"])
def test_the_page_of_a_run_is_no_scroll(pages, name):
    assert first_screen(pages[name])[1] <= 5000


def test_the_errors_stand_below_the_curves(learned):
    above, below = learned.run("""return [...kelpie.figures].slice(0, 2).map((f) =>
        [f.description.series.map((one) => one.name), f.frame.getBoundingClientRect().top,
         f.plot.scales.x.min])""")
    assert "measured" in above[0] and below[0][-1] == "measured less predicted"
    assert above[1] < below[1] and above[2] == below[2]
    wrong = learned.run("""
        const [curve, error] = [...kelpie.figures];
        const row = (f, name) => f.table[1 + f.rows.findIndex((one) => one.name === name)];
        const measured = row(curve, "measured"), predicted = row(curve, "predicted");
        return row(error, "measured less predicted").filter((e, i) =>
            e !== null && Math.abs(e - (measured[i] - predicted[i])) > 1e-9).length""")
    assert wrong == 0


TICKS = """
document.querySelectorAll("details").forEach((one) => { one.open = true; });
return new Promise((done) => setTimeout(() => done([...kelpie.figures]
    .filter(({ description }) => !description.x.names && !description.x.log && !description.y.log)
    .map(({ plot, description }) => [description.label, ...[0, 1].map((axis) =>
        plot.axes[axis]._values.filter((text) => text).length)])), 500));
"""


@pytest.mark.parametrize("width", [1300, 400])
def test_every_figure_has_a_scale_and_data_in_view(pages, width):
    for name in ("learn", "damaged", "rollout"):
        page = open_page(pages[name], width)
        page.wait_until_drawn()
        ticks = page.run(TICKS)
        assert len(ticks) >= 3
        assert [one for one in ticks if min(one[1:]) < 2] == [], name


def test_labels_of_marks_close_together_stand_beside_each_other(learned):
    told = learned.run("""
        const told = [];
        const draw = CanvasRenderingContext2D.prototype.fillText;
        CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
          told.push(text);
          draw.call(this, text, ...place);
        };
        new kelpie.Figure(document.body, { label: "", x: { label: "x" }, y: { label: "y" },
          marks: [0.5, 0.53, 0.531].map((x, i) => ({ x, name: `mark ${i}` })), guides: [],
          series: [{ kind: "line", name: "a", style: 0, x: 0, y: 1 }] }, [[0, 1], [0, 1]]);
        return new Promise((done) => setTimeout(() => {
          CanvasRenderingContext2D.prototype.fillText = draw;
          done([...new Set(told.filter((text) => text.startsWith("mark")))]);
        }, 200));""")
    assert told == ["mark 0", "mark 1"]


def test_a_link_opens_the_folded_part_and_its_figures_fill_it(pages):
    page = open_page(pages["learn"])
    page.wait_until_drawn()
    assert page.run("return document.querySelectorAll('details[open]').length") == 0
    page.driver.find_element("link text", "Details").click()
    page.wait("document.querySelectorAll('details.section[open]').length === 1")
    page.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    settle(page)
    narrow = page.run("""return [...kelpie.figures].filter((f) =>
        f.plot.width < f.parent.clientWidth - 1 && !f.description.square).length""")
    assert narrow == 0


def test_on_a_phone_a_shadow_says_that_there_is_more(pages):
    page = open_page(pages["learn"], 400)
    page.wait_until_drawn()
    page.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    wide = page.run("""return [...document.querySelectorAll('.scroll')].filter((one) =>
        one.scrollWidth > one.clientWidth).map((one) =>
        [getComputedStyle(one).backgroundAttachment, getComputedStyle(one).backgroundImage])""")
    assert len(wide) > 0
    assert all("scroll" in attached and "gradient" in image for attached, image in wide)


def test_every_logarithmic_axis_says_where_it_is(pages):
    for name in ("learn", "rollout", "tune"):
        page = open_page(pages[name])
        page.wait_until_drawn()
        words = page.run("""return [...kelpie.figures].flatMap(({ plot, description }) =>
            [["x", 0], ["y", 1]].filter(([axis]) => description[axis].log)
            .map(([, i]) => plot.axes[i]._values.filter((text) => text).length))""")
        assert len(words) > 0 and min(words) >= 1, name


def test_bars_begin_at_zero(learned):
    lows = learned.run("""return [...kelpie.figures].filter(({ description }) =>
        description.series.some(({ kind }) => kind === "bars"))
        .map(({ plot }) => plot.scales.y.min)""")
    assert len(lows) > 0 and set(lows) == {0}


DENSE = """
const [values, holes] = [arguments[0], arguments[1]];
const xs = values.map((_, i) => i);
const line = (x, style) => ({ kind: "line", name: String(style), style, x, y: 1 });
const figure = new kelpie.Figure(document.body, { label: "", x: { label: "x" }, y: { label: "y" },
  marks: [], guides: [], series: holes ? [line(0, 0), line(2, 1)] : [line(0, 0)] },
  [xs, values, xs.map((x) => x + 0.5)]);
const { plot } = figure;
const { data, width } = plot.ctx.getImageData(0, 0, plot.ctx.canvas.width, plot.ctx.canvas.height);
const isBlue = ([x, y]) => {
  const at = 4 * (Math.round(plot.valToPos(y, "y", true)) * width + Math.round(plot.valToPos(x, "x", true)));
  return data[at + 3] > 200 && data[at] < 60 && data[at + 2] > 100;
};
return [plot.data.slice(1).some((column) => column.includes(null)),
  Math.max(...plot.data[1].filter(Number.isFinite)), ...arguments[2].map(isBlue)];
"""


def test_where_samples_are_denser_than_pixels_each_counts_and_gaps_stay(learned):
    values = [0.1 * (i % 2) for i in range(50_000)]
    values[33_333] = 1.0
    values[20_000:22_000] = 2_000 * [None]
    gap, highest, spike, line, missing = learned.run(
        DENSE, values, False, [(33_333, 0.7), (40_000, 0.05), (21_000, 0.05)])
    assert gap and highest == 1.0
    assert (spike, line, missing) == (True, True, False)


def test_lines_with_times_of_their_own_have_no_gaps(learned):
    values = [math.sin(0.001 * i) for i in range(20_000)]
    assert not learned.run(DENSE, values, True, [])[0]


def test_dragging_zooms_all_figures_over_time_and_a_double_click_undoes_it(learned):
    plot = plot_of(learned)
    show_all(learned)
    whole = windows(learned)
    assert len(whole) >= 2
    width = plot.size["width"]
    ActionChains(learned.driver).move_to_element_with_offset(plot, -width // 4, 0).click_and_hold(
    ).move_by_offset(width // 4, 5).release().perform()
    settle(learned)
    zoomed = windows(learned)
    assert all(window == zoomed[0] for window in zoomed)
    first, last = whole[0]
    assert zoomed[0][0] == pytest.approx(first + 0.25 * (last - first), abs=0.01 * (last - first))
    assert zoomed[0][1] == pytest.approx(first + 0.5 * (last - first), abs=0.01 * (last - first))
    ActionChains(learned.driver).double_click(plot).perform()
    settle(learned)
    assert windows(learned) == whole


def test_figures_out_of_sight_follow_when_they_are_scrolled_to(learned):
    learned.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    settle(learned)
    learned.run("[...kelpie.figures].find((f) => f.group === 'stream').showAll([100, 200])")
    last = "[...kelpie.figures].findLast((f) => f.group === 'stream')"
    learned.run(f"{last}.frame.scrollIntoView()")
    learned.wait(f"{last}.plot.scales.x.min === 100")


def test_the_cursor_tells_the_same_moment_in_all_figures(learned):
    plot = plot_of(learned)
    ActionChains(learned.driver).move_to_element_with_offset(plot, 30, 0).perform()
    settle(learned)
    told = learned.run("return [...kelpie.figures].filter((f) => f.group === 'time' && f.visible)"
                       ".map((f) => f.when.textContent)")
    assert len(told) >= 2 and "(time in s)" in told[0]
    moments = [float(text.split()[0].replace("−", "-")) for text in told]
    assert max(moments) - min(moments) < 5.0  # rows of the nearest sample each
    value = learned.run("return [...kelpie.figures][0].entries[1].value.textContent")
    assert math.isfinite(float(value.replace("−", "-")))


def test_a_zoom_shows_every_sample(learned):
    plot_of(learned)
    learned.run("[...kelpie.figures][0].showAll([100, 110])")
    settle(learned)
    rows = learned.run("return [...kelpie.figures][0].plot.data[0]"
                       ".filter((t) => t >= 100 && t <= 110).length")
    assert rows > 30  # ten seconds at 4 Hz, some of them held out


def test_a_series_is_hidden_and_shown_from_the_legend(learned):
    button = learned.driver.find_element("css selector", ".legend button[aria-pressed]")
    plot_of(learned)
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    assert learned.run("return [...kelpie.figures][0].plot.series.filter((s) => !s.show).length") > 0
    button.send_keys(Keys.ENTER)
    assert button.get_attribute("aria-pressed") == "true"


def test_the_keyboard_zooms_pans_and_moves_the_cursor(learned):
    plot_of(learned)
    frame = learned.driver.find_element("css selector", ".frame")
    show_all(learned)
    first, last = windows(learned)[0]
    frame.send_keys("+")
    settle(learned)
    low, high = windows(learned)[0]
    assert high - low == pytest.approx((last - first) / 2)
    frame.send_keys(Keys.SHIFT, Keys.ARROW_RIGHT)
    settle(learned)
    assert windows(learned)[0][0] == pytest.approx(low + 0.2 * (high - low))
    frame.send_keys(Keys.ARROW_RIGHT)
    settle(learned)
    assert "time" in learned.run("return [...kelpie.figures][0].when.textContent")
    frame.send_keys("0")
    settle(learned)
    assert windows(learned)[0] == [first, last]


def touch(page, kind: str, *points) -> None:
    page.cdp("Input.dispatchTouchEvent", type=kind,
             touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])


def test_fingers_pan_and_zoom(pages):
    page = open_page(pages["learn"], 400)
    page.cdp("Emulation.setTouchEmulationEnabled", enabled=True)
    page.wait_until_drawn()
    plot = plot_of(page)
    box = page.run("const b = arguments[0].getBoundingClientRect(); return [b.x, b.y, b.width,"
                   " b.height]", plot)
    x, y = box[0] + box[2] / 2, box[1] + box[3] / 2
    show_all(page)
    first, last = windows(page)[0]
    touch(page, "touchStart", (x - 30, y), (x + 30, y))
    for reach in (40, 50, 60):
        touch(page, "touchMove", (x - reach, y), (x + reach, y))
    touch(page, "touchEnd")
    settle(page)
    low, high = windows(page)[0]
    assert high - low == pytest.approx((last - first) / 2, rel=0.05)
    touch(page, "touchStart", (x, y))
    for step in (20, 40, 60):
        touch(page, "touchMove", (x - step, y))
    touch(page, "touchEnd")
    settle(page)
    assert windows(page)[0][0] > low
    assert page.console() == []


def test_without_javascript_tables_and_sentences_remain(pages):
    page = open_page(pages["learn"], scripts=False)
    page.driver.find_element("xpath", "//summary[text()='Solver']").click()  # folds need none
    text = page.driver.find_element("css selector", "body").text
    assert "over time in s: measured from" in text
    assert "least squares" in text and "KKT" in text


def test_printed_the_page_is_light_and_whole(pages):
    page = open_page(pages["learn"], dark=True)
    page.wait_until_drawn()
    page.run("dispatchEvent(new Event('beforeprint'))")
    assert page.run("return Math.max(...[...document.querySelectorAll('.uplot')]"
                    ".map((plot) => plot.offsetWidth))") <= 700
    assert page.run("return getComputedStyle(document.documentElement)"
                    ".getPropertyValue('--paper').trim()") == "#ffffff"
    page.run("dispatchEvent(new Event('afterprint'))")
    assert page.cdp("Page.printToPDF", printBackground=False)["data"].startswith("JVBER")
