#!/usr/bin/env python3
"""Open the report of a run in a browser and use it as a person does.

    scripts/check_report.py FOLDER [PICTURE.png]      (needs: chromium, chromium-driver, pip install selenium)

Loads FOLDER/report.html in headless Chromium and checks that nothing is asked from the network, no error is logged, the
slider (by arrow key, too), the play button and the switches change the picture, everything fits widths from 900 to 1600
pixels, and a failed run says so on top. Writes a picture of the page if asked. Exit code 0 if all is well.
"""

import hashlib
import json
import sys
import tempfile
import time
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

ARGUMENTS = (
    "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
)
PROBLEMS = []


def expect(holds, what):
    if not holds:
        PROBLEMS.append(what)


def open_browser(profile):
    options = webdriver.ChromeOptions()
    for argument in [*ARGUMENTS.split(), f"--user-data-dir={profile}", "--window-size=1280,1000"]:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(options=options, service=webdriver.ChromeService("/usr/bin/chromedriver"))


def fingerprint(browser, identity):
    """What a canvas or a chart shows."""
    script = (
        "const e = document.getElementById(arguments[0]);"
        "return e.toDataURL ? e.toDataURL() : e.innerHTML;"
    )
    return hashlib.sha256(browser.execute_script(script, identity).encode()).hexdigest()


def use(browser):
    """Moves every control and looks whether the pictures follow."""
    slider = browser.find_element(By.ID, "state")
    last = int(slider.get_attribute("max"))
    shown = {name: fingerprint(browser, name) for name in ("whole", "near", "pressure", "force")}
    readout = browser.find_element(By.ID, "readout").text
    expect("mm" in readout, f"the readout says {readout!r}")
    if last > 0:
        slider.send_keys(Keys.HOME)
        slider.send_keys(Keys.ARROW_RIGHT)
        expect(slider.get_attribute("value") == "1", "the arrow key does not move the slider by one state")
        for name, before in shown.items():
            expect(fingerprint(browser, name) != before, f"the slider does not change {name}")
        browser.find_element(By.ID, "play").click()
        time.sleep(1)
        expect(int(slider.get_attribute("value")) != 1, "the play button does not play")
        slider.send_keys(Keys.END)
        expect(int(slider.get_attribute("value")) == last, "the slider does not stop the player")
    for group, value in (("field", "stress"), ("focus", "die"), ("focus", "middle")):
        before = fingerprint(browser, "near")
        browser.find_element(By.CSS_SELECTOR, f"input[name={group}][value={value}]").click()
        expect(fingerprint(browser, "near") != before, f"{group} {value} does not change the close-up")
    before = fingerprint(browser, "near")
    browser.find_element(By.ID, "whole").click()
    expect(fingerprint(browser, "near") != before, "a click does not move the close-up")


def fits(browser):
    for width in (900, 1280, 1600):
        browser.set_window_size(width, 1000)
        time.sleep(0.3)
        wide = browser.execute_script("return [document.documentElement.scrollWidth, window.innerWidth]")
        expect(wide[0] <= wide[1], f"the page is {wide[0]} pixels wide in a window of {wide[1]}")


def says(browser, summary):
    status = browser.find_element(By.ID, "status").text
    if summary["status"] == "finished":
        expect("FINISHED" in status, f"the status says {status!r}")
    else:
        expect("FAILED" in status, f"the status says {status!r}")
        failure = browser.find_element(By.ID, "failure").text
        for part in ("place", "cause"):
            expect(summary["diagnosis"][part] in failure, f"the page does not say the {part}")
        for remedy in summary["diagnosis"]["remedies"]:
            expect(remedy in failure, f"the page does not say: {remedy}")
    rows = len(browser.find_elements(By.CSS_SELECTOR, "#verdict-table tbody tr"))
    expect(rows == len(summary["verdicts"]), f"{rows} rows for {len(summary['verdicts'])} verdicts")


def logged(browser, page):
    """No error, and nothing asked for but the page itself. (The browser's own start page asks for a lot.)"""
    asked = 0
    for entry in browser.get_log("browser"):
        PROBLEMS.append(f"the browser logs: {entry['message']}")
    for entry in browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent" and message["params"]["documentURL"] == page:
            url = message["params"]["request"]["url"]
            asked += url == page
            expect(url == page or url.startswith("data:"), f"the page asks for {url}")
    expect(asked == 1, f"the page was asked for {asked} times: the requests are not seen")


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    folder = Path(sys.argv[1]).resolve()
    summary = json.loads((folder / "summary.json").read_text())
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = open_browser(profile)
        try:
            page = (folder / "report.html").as_uri()
            browser.get(page)
            says(browser, summary)
            if len(sys.argv) == 3:
                browser.save_screenshot(sys.argv[2])
            use(browser)
            fits(browser)
            logged(browser, page)
        finally:
            browser.quit()
    for problem in PROBLEMS:
        print(f"report: {problem}", file=sys.stderr)
    size = (folder / "report.html").stat().st_size / 1e6
    print(f"report.html: {size:.1f} MB, {'as it should be' if not PROBLEMS else f'{len(PROBLEMS)} problem(s)'}")
    return 1 if PROBLEMS else 0


if __name__ == "__main__":
    sys.exit(main())
