# SPDX-License-Identifier: Apache-2.0
"""The page of kelpie live while a replay runs. Screenshots are kept in $KELPIE_SCREENSHOTS."""

import json
import subprocess
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from browser import missing, open_page
from live_run import BUILD_DIR, EVIL, live_run, write_mission

if missing():
    pytest.skip(f"no browser to look at pages with: {missing()} isn't installed "
                "(scripts/setup.sh installs it)", allow_module_level=True)
if b"has no page" in (BUILD_DIR / "kelpie").read_bytes():
    pytest.skip("kelpie was built without libmicrohttpd and has no page", allow_module_level=True)

NEWEST = "live.columns()[0].at(-1)"
STATE = "document.getElementById('state').textContent"


@pytest.fixture(scope="module")
def mission(tmp_path_factory) -> Path:
    file = tmp_path_factory.mktemp("mission") / "mission.db3"
    write_mission(file, 900.0)
    return file


@pytest.fixture
def running(mission, tmp_path):
    with live_run(tmp_path, mission, "16") as run:
        yield run


def wait_for_model(page) -> None:
    page.wait(f"{STATE}.includes('Learning') && live.figures().every((one) => one.figure) && "
              "document.querySelectorAll('#coefficients tbody tr').length > 2", 60)


def said(page) -> str:
    return page.run("return document.getElementById('said').textContent")


def click(page, name: str) -> None:
    page.driver.find_element("id", name).click()


def test_it_fits_and_says_nothing_on_the_console(mission, tmp_path):
    with live_run(tmp_path, mission, "16") as run:
        for width, dark in ((1300, False), (400, True), (1300, True), (400, False)):
            page = open_page(run.address, width, dark)
            wait_for_model(page)
            page.wait(f"{NEWEST} > 140 && document.querySelectorAll('#said li').length > 2", 60)
            wide, paper = page.run("return [document.documentElement.scrollWidth,"
                                   "getComputedStyle(document.body).backgroundColor]")
            assert wide <= width
            assert (paper == "rgb(255, 255, 255)") == (not dark)
            assert not page.run("return window.hacked")
            assert EVIL in page.run("return document.getElementById('curves').textContent")
            assert page.console() == []
            page.screenshot(f"live_{width}_{'dark' if dark else 'light'}")


def test_curves_move_and_hold_what_was_learned(running):
    page = open_page(running.address)
    wait_for_model(page)
    first = page.run(f"return {NEWEST}")
    page.wait(f"{NEWEST} > {first} + 20")
    times, measured, predicted, low, high = page.run("""
        const [t, y, p, middle, half] = live.columns();
        const { figure } = live.figures()[0];
        return [t, y, p, figure.plot.scales.x.min, figure.plot.scales.x.max]""")
    assert times == sorted(times) and len(set(times)) == len(times)
    assert low == pytest.approx(times[0], abs=5) and high > first
    both = [(y, p) for y, p in zip(measured[-100:], predicted[-100:]) if p is not None]
    assert len(both) > 50
    assert sum(abs(y - p) for y, p in both) < 0.5 * sum(abs(y) for y, _ in both)
    assert page.console() == []


def test_a_client_that_comes_late_or_again_has_the_last_minutes(running):
    page = open_page(running.address)
    wait_for_model(page)
    page.wait(f"{NEWEST} > 60")
    page = open_page(running.address)
    page.wait("live.columns().length > 1 && live.columns()[0].length > 100")
    assert page.run("return live.columns()[0][0]") < 5


def test_the_cursor_is_in_all_figures_and_a_window_stays(running):
    page = open_page(running.address)
    wait_for_model(page)
    page.wait(f"{NEWEST} > 40")
    frame = page.driver.find_element("css selector", ".frame")
    frame.send_keys("\ue014")  # arrow right
    page.wait("live.figures().every(({ figure }) => figure.plot.cursor.left > 0)")
    frame.send_keys("+")
    window = ("live.figures().map(({ figure }) => [figure.plot.scales.x.min,"
              "figure.plot.scales.x.max])")
    page.wait(f"{window}[0][0] > 1")
    before = page.run(f"return {window}")
    now = page.run(f"return {NEWEST}")
    page.wait(f"{NEWEST} > {now} + 10")
    assert page.run(f"return {window}") == before and before[0] == before[1]
    frame.send_keys("0")  # everything, and it moves again
    page.wait(f"{window}[0][1] > {now} + 10")


def test_buttons_do_what_they_say(running, tmp_path):
    page = open_page(running.address)
    wait_for_model(page)
    click(page, "save")
    page.wait("document.getElementById('said').textContent.includes('saved, after')")
    assert (tmp_path / "out/checkpoint.kelpie").exists()
    assert json.loads((tmp_path / "out/model.json").read_text())["axes"]
    click(page, "freeze")
    page.wait(f"{STATE}.includes('Learning is frozen')")
    page.wait("document.getElementById('freeze').textContent === 'Resume learning'")
    frozen = page.run(f"return {NEWEST}")
    page.wait(f"{NEWEST} > {frozen} + 2")  # curves go on, the model stays
    click(page, "freeze")
    page.wait(f"{STATE}.includes('▶ Learning')")
    page.wait(f"{NEWEST} > {frozen} + 2")
    click(page, "reset")  # asks first
    page.wait("document.getElementById('ask').open")
    assert page.run("return document.activeElement.id") == "no"
    click(page, "no")
    assert "begins anew" not in said(page)
    click(page, "reset")
    click(page, "yes")
    page.wait("document.getElementById('said').textContent.includes('the model begins anew')")
    assert page.console() == []


def test_a_silence_is_said_and_shown(running):
    page = open_page(running.address)
    page.wait(f"{NEWEST} > 131", 60)
    page.wait("document.getElementById('said').textContent.includes('is silent')")
    page.wait("document.getElementById('said').textContent.includes('speaks')")
    page.wait("document.querySelector('#signals tbody').textContent.includes('1 silence')")
    assert page.run("return live.columns()[1].includes(null)")  # a gap, not a line across it


def test_the_first_screen_holds_source_quality_and_alarms(running):
    page = open_page(running.address, 1400)
    wait_for_model(page)
    page.wait(f"{NEWEST} > 123", 60)
    page.wait("!document.getElementById('alarm').hidden", 30)
    assert "is silent" in page.run("return document.getElementById('alarm').textContent")
    assert page.run("return document.title").startswith("⚠ kelpie live: live")
    for name in ("source", "alarm", "state", "good"):
        assert page.run("return document.getElementById(arguments[0]).getBoundingClientRect()"
                        ".bottom", name) <= 900, name
    assert "/odom" in page.run("return document.getElementById('source').textContent")
    assert "R²" in page.run("return document.getElementById('good').textContent")
    assert not page.run("return document.getElementById('coefficients').closest('details').open")
    page.wait("document.getElementById('alarm').hidden", 60)


def test_an_alarm_of_several_axes_is_one_line_with_their_names(running):
    page = open_page(running.address)
    wait_for_model(page)
    lines = page.run("""
        const changed = { level: "warn", key: "changes", text: "the vehicle has changed" };
        live.show({ ...live.health(), alerts: [
          ...["udot", "rdot"].map((subject) => ({ ...changed, subject })),
          { level: "warn", key: "is_silent", subject: "n", text: "n is silent" },
          { level: "warn", key: "vehicle", subject: "", text: "the vehicle has changed: th2" }] });
        return [...document.querySelectorAll("#alarm p")].map((p) => p.textContent);""")
    assert lines == ["⚠ the vehicle has changed: th2", "⚠ the vehicle has changed: udot, rdot",
                     "⚠ n is silent"]


def test_after_a_replay_the_figures_stay_and_the_end_is_said(mission, tmp_path):
    with live_run(tmp_path, mission, "60") as run:
        page = open_page(run.address)
        wait_for_model(page)
        run.process.wait(timeout=120)
        page.wait(f"{STATE}.includes('The run has ended')", 20)
        assert page.run(f"return {NEWEST}") > 880
        assert page.run("return live.figures().every(({ figure }) => figure.plot.width > 0)")
        assert page.run("return document.getElementById('save').disabled")
        assert page.run("return document.getElementById('alarm').hidden"), "silence is no alarm now"
        signals = page.run("return document.querySelector('#signals tbody').textContent")
        assert "well" in signals and "is silent" not in signals
        good = page.run("return [...document.querySelectorAll('#good td')]"
                        ".map((td) => td.textContent)")
        assert {len(text.split(".")[1]) for text in good if "." in text and "%" not in text} == {3}
        assert page.console() == []


def test_it_says_that_kelpie_is_gone_and_finds_it_again(mission, tmp_path):
    with live_run(tmp_path, mission, "8") as run:
        page = open_page(run.address)
        wait_for_model(page)
        run.process.kill()
        page.wait(f"{STATE}.includes('No connection')")
        run.process.wait()
        again = [BUILD_DIR / "kelpie", "live", "--config", tmp_path / "live.toml", "--replay",
                 mission, "--speed", "8", "--out", tmp_path / "out"]
        run.process = subprocess.Popen(again, stdout=run.said, stderr=run.said)
        page.wait(f"{STATE}.includes('Learning')", 60)


def test_with_a_token_the_address_is_enough_for_everything(mission, tmp_path):
    token = "sixteen-letters-"
    with live_run(tmp_path, mission, "8", f'token = "{token}"') as run:
        with pytest.raises(urllib.error.HTTPError):
            urllib.request.urlopen(run.address)
        page = open_page(f"{run.address}?token={token}")
        wait_for_model(page)
        assert token not in page.driver.current_url
        click(page, "save")
        page.wait("document.getElementById('said').textContent.includes('saved, after')")
        assert page.console() == []
