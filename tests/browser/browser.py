# SPDX-License-Identifier: Apache-2.0
"""Debian's Chromium, driven by Selenium, as a person who reads kelpie's pages."""

import atexit
import base64
import functools
import importlib.util
import os
import shutil
import time
from pathlib import Path

HEIGHT = 900


def missing() -> str:
    """What a browser test lacks on this machine; empty where nothing is."""
    absent = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    if importlib.util.find_spec("selenium") is None:
        absent.append("python3-selenium")
    return ", ".join(absent)


class Page:
    """A page in a window."""

    def __init__(self, driver, path: Path | str) -> None:
        self.driver = driver
        driver.get(path if isinstance(path, str) else path.resolve().as_uri())

    def run(self, script: str, *arguments):
        return self.driver.execute_script(script, *arguments)

    def cdp(self, command: str, **parameters):
        return self.driver.execute_cdp_cmd(command, parameters)

    def wait(self, condition: str, seconds: float = 120.0) -> None:
        """Until the JavaScript expression is true: one that throws, as before all is there, is not."""
        end = time.monotonic() + seconds
        tried = f"try {{ return Boolean({condition}); }} catch {{ return false; }}"
        while not self.run(tried):
            if time.monotonic() > end:
                raise AssertionError(f"still not true: {condition}")
            time.sleep(0.1)

    def wait_until_drawn(self) -> None:
        self.wait("performance.getEntriesByName('kelpie-all').length")

    def console(self) -> list[str]:
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def screenshot(self, name: str) -> None:
        """Of the whole page, however long, into $KELPIE_SCREENSHOTS, where somebody wants it."""
        if "KELPIE_SCREENSHOTS" not in os.environ:
            return
        width, height = self.run(
            "return [innerWidth, document.documentElement.scrollHeight]")
        clip = {"x": 0, "y": 0, "width": width, "height": min(height, 16_000), "scale": 1}
        shot = self.cdp("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)
        folder = Path(os.environ["KELPIE_SCREENSHOTS"])
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}.png").write_bytes(base64.b64decode(shot["data"]))


@functools.cache
def chromium():
    """The one Chromium of a process, for starting one takes longer than most tests."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                     f"--window-size=1300,{HEIGHT}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    atexit.register(driver.quit)
    return driver


def open_page(path: Path | str, width: int = 1300, dark: bool = False,
              scripts: bool = True) -> Page:
    """A page in a window that wide; the page before is gone then, and all it left behind."""
    driver = chromium()
    driver.get("about:blank")
    for command, parameters in (
            ("Network.clearBrowserCookies", {}),
            ("Emulation.setDeviceMetricsOverride", {
                "width": width, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": width < 500}),
            ("Emulation.setEmulatedMedia", {"features": [
                {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]}),
            ("Emulation.setTouchEmulationEnabled", {"enabled": False}),
            ("Emulation.setScriptExecutionDisabled", {"value": not scripts})):
        driver.execute_cdp_cmd(command, parameters)
    driver.get_log("browser")
    return Page(driver, path)
