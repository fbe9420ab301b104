# SPDX-License-Identifier: Apache-2.0
"""Debian's Chromium, driven by Selenium, as a person who reads kelpie's pages."""

import base64
import importlib.util
import shutil
import time
from contextlib import contextmanager
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
        """Until the JavaScript expression is true."""
        end = time.monotonic() + seconds
        while not self.run(f"return Boolean({condition})"):
            if time.monotonic() > end:
                raise AssertionError(f"still not true: {condition}")
            time.sleep(0.02)

    def wait_until_drawn(self) -> None:
        self.wait("performance.getEntriesByName('kelpie-all').length")

    def console(self) -> list[str]:
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def screenshot(self, file: Path) -> None:
        """Of the whole page, however long."""
        width, height = self.run(
            "return [innerWidth, document.documentElement.scrollHeight]")
        clip = {"x": 0, "y": 0, "width": width, "height": min(height, 16_000), "scale": 1}
        shot = self.cdp("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)
        file.write_bytes(base64.b64decode(shot["data"]))


@contextmanager
def browser(width: int = 1300, dark: bool = False, scripts: bool = True):
    """A function that opens pages in a window that wide."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                     f"--window-size={max(width, 500)},{HEIGHT}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    try:
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": width < 500})
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
        driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": not scripts})
        yield lambda path: Page(driver, path)
    finally:
        driver.quit()
