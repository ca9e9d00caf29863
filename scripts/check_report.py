#!/usr/bin/env python3
"""Open the report of a run in a browser and use it as a person does.

    scripts/check_report.py FOLDER [PICTURE.png]      (needs: chromium, chromium-driver, pip install selenium)
    scripts/check_report.py FOLDER --pictures FOLDER  of the whole page, in three widths, light and dark
    scripts/check_report.py --self-test               whether it finds what is wrong with scripts/check_report_pages.py

Loads FOLDER/report.html in headless Chromium and checks that nothing is asked from the network, no error is logged, the
slider (by arrow key, too), the play button and the switches change the picture, everything fits widths from 390 to 1600
pixels, in light and dark every text has the contrast of WCAG AA, every control has a name and can be reached by the
keyboard, pictures have a text, the page prints, and a failed run says so on top. FOLDER may hold a comparison.html instead.
Writes a picture of the page if asked. Exit code 0 if all is well.
"""

import base64
import hashlib
import json
import sys
import tempfile
import time
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from check_report_pages import PAGES

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


def use(browser, patience=20.0):
    """Moves every control and looks whether the pictures follow; the player has some seconds to begin."""
    slider = browser.find_element(By.ID, "state")
    last = int(slider.get_attribute("max"))
    readout = browser.find_element(By.ID, "readout").text
    expect("mm" in readout, f"the readout says {readout!r}")
    # There may be one state, of a run that failed at once, or two.
    if last > 0:
        shown = {}
        for key in (Keys.HOME, Keys.END):
            slider.send_keys(key)
            shown[key] = {name: fingerprint(browser, name) for name in ("whole", "near", "pressure", "force")}
        for name, first in shown[Keys.HOME].items():
            expect(shown[Keys.END][name] != first, f"the slider does not change {name}")
        slider.send_keys(Keys.HOME)
        slider.send_keys(Keys.ARROW_RIGHT)
        expect(slider.get_attribute("value") == "1", "the arrow key does not move the slider by one state")
        slider.send_keys(Keys.HOME)
        browser.find_element(By.ID, "play").click()
        until = time.monotonic() + patience
        while slider.get_attribute("value") == "0" and time.monotonic() < until:
            time.sleep(0.05)
        expect(slider.get_attribute("value") != "0", "the play button does not play")
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
    for width in (390, 768, 900, 1280, 1600):
        metrics = {"width": width, "height": 1000, "deviceScaleFactor": 1, "mobile": width < 500}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        time.sleep(0.3)
        # A telephone's window says that it is as wide as what is too wide for it.
        wide = browser.execute_script("return document.documentElement.scrollWidth")
        expect(wide <= width, f"the page is {wide} pixels wide in a window of {width}")


# Ratios of contrast (WCAG 2.1, 1.4.3): 4.5, or 3 for large text. A text is where an element has some of its own. What lets the colour
# behind it through is mixed with it, ink as well as backgrounds, and so is what fades with its box.
CONTRAST = """
const paper = arguments[0] ? [20, 24, 30] : [255, 255, 255];
const rgba = text => { const c = (text.match(/[\\d.]+/g) || [0, 0, 0, 0]).map(Number); return c.length < 4 ? [...c, 1] : c; };
const mix = (c, below, share) => below.map((b, i) => b + (c[i] - b) * share);
const light = ([r, g, b]) => { const f = c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; return 0.2126 * f(r) + 0.7152 * f(g) + 0.0722 * f(b); };
const under = e => { if (!e) return paper; const below = under(e.parentElement), c = rgba(getComputedStyle(e).backgroundColor); return mix(c, below, c[3]); };
const faded = e => e ? Number(getComputedStyle(e).opacity) * faded(e.parentElement) : 1;
const low = [];
for (const e of document.querySelectorAll("body *")) {
  if (![...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()) || !e.getClientRects().length || e.closest("noscript, script, style")) continue;
  const style = getComputedStyle(e), ink = rgba(e instanceof SVGElement ? style.fill : style.color), below = under(e);
  const a = light(mix(ink, below, ink[3] * faded(e))), b = light(below);
  const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), size = parseFloat(style.fontSize), large = size >= 24 || size >= 18.66 && style.fontWeight >= 700;
  if (ratio < (large ? 3 : 4.5)) low.push(`${e.tagName.toLowerCase()} "${e.textContent.trim().slice(0, 40)}": ${ratio.toFixed(2)}`);
}
return [...new Set(low)];
"""
# Controls and pictures without a name, headings that leave out a level, and identities that are there twice.
NAMES = """
const named = e => (e.getAttribute("aria-label") || e.labels?.length && e.labels[0].textContent || e.textContent || "").trim();
const wrong = [];
for (const e of document.querySelectorAll("button, input, select, summary, [tabindex='0'], [role=img], canvas:not([aria-hidden]), table")) if (!named(e)) wrong.push(`${e.tagName.toLowerCase()}#${e.id} has no name`);
let level = 0;
for (const h of document.querySelectorAll("h1, h2, h3, h4")) { const l = Number(h.tagName[1]); if (l > level + 1) wrong.push(`h${l} behind h${level}`); level = l; }
const ids = [...document.querySelectorAll("[id]")].map(e => e.id);
ids.filter((id, i) => ids.indexOf(id) !== i).forEach(id => wrong.push(`#${id} is there twice`));
for (const th of document.querySelectorAll("th")) if (!th.textContent.trim()) wrong.push("a column has no heading");
if (!document.documentElement.lang || !document.title || !document.querySelector("main")) wrong.push("language, title or main part is missing");
return wrong;
"""


def accessible(browser):
    for scheme in ("dark", "light"):
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        time.sleep(0.2)
        for text in browser.execute_script(CONTRAST, scheme == "dark"):
            PROBLEMS.append(f"too little contrast ({scheme}): {text}")
    for text in browser.execute_script(NAMES):
        PROBLEMS.append(text)
    # With the keyboard alone every control is reached, and shows that it is.
    wanted = set(browser.execute_script("return [...document.querySelectorAll('button, select, input, summary')].filter(e => e.getClientRects().length && e.type !== 'radio').map(e => e.id || e.tagName)"))
    reached, unseen, left = [], set(), 0
    for _ in range(200):
        browser.switch_to.active_element.send_keys(Keys.TAB)
        at, name, outline = browser.execute_script("const e = document.activeElement; return [[...document.querySelectorAll('*')].indexOf(e), e.id || e.tagName, getComputedStyle(e).outlineStyle]")
        left += name == "BODY"
        if left > 2 or at in [seen for seen, _ in reached]:
            break
        if name == "BODY":
            continue
        reached.append((at, name))
        if outline == "none":
            unseen.add(name)
    for name in sorted(unseen):
        PROBLEMS.append(f"{name} does not show that it has the keyboard")
    reached = {name for _, name in reached}
    expect(wanted <= reached, f"the keyboard does not reach {sorted(wanted - reached)}")


def prints(browser):
    """On white paper, also from a dark screen."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
    page = browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "paperWidth": 8.27, "paperHeight": 11.69})
    expect(len(page["data"]) > 50_000, "the page prints as next to nothing")
    browser.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    paper = browser.execute_script("return getComputedStyle(document.documentElement).getPropertyValue('--page').trim()")
    browser.execute_script("window.dispatchEvent(new Event('afterprint'))")
    expect(paper == "#fff", f"the page prints on {paper}")
    # A4 less margins of 14 mm, where nobody can scroll.
    sheet = {"width": 688, "height": 1000, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", sheet)
    cut = browser.execute_script(
        "const wide = e => e.scrollWidth > e.clientWidth + 1, rolls = e => ['auto', 'scroll'].includes(getComputedStyle(e).overflowX);"
        "return [...document.querySelectorAll('body *')].filter(e => wide(e) && rolls(e)).map(e => e.id || e.className || e.tagName)"
        ".concat(document.documentElement.scrollWidth > 688 ? ['the page'] : [])"
    )
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    expect(not cut, f"wider than a sheet of paper: {cut}")


def says(browser, summary):
    status = browser.find_element(By.ID, "status").text
    if summary["status"] == "finished":
        expect("FINISHED" in status, f"the status says {status!r}")
    elif summary["status"] == "interrupted":
        expect("INTERRUPTED" in status, f"the status says {status!r}")
        expect("-restart" in browser.find_element(By.ID, "failure").text, "the page does not say how to go on")
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


def self_test():
    """Looks at pages whose faults are known."""
    wrong = 0
    deeds = {"used": lambda browser: use(browser, patience=2.0), "printed": prints, "measured": fits, "read": accessible}
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = open_browser(f"{folder}/profile")
        try:
            for number, (name, text, what, wanted) in enumerate(PAGES):
                file = Path(folder) / f"{number}.html"
                file.write_text(text)
                PROBLEMS.clear()
                browser.get_log("browser"), browser.get_log("performance")
                browser.get(file.as_uri())
                if what != "loaded":
                    deeds[what](browser)
                logged(browser, file.as_uri())
                left = list(PROBLEMS)
                missed = [part for part in wanted if not any(part in problem and (left.remove(problem) or True) for problem in list(left))]
                wrong += bool(missed or left)
                if missed or left:
                    print(f"report: {name}: not found: {missed}, and found: {left}", file=sys.stderr)
        finally:
            browser.quit()
    print(f"check_report.py finds what it has to in {len(PAGES) - wrong} of {len(PAGES)} pages")
    return 1 if wrong else 0


def take_pictures(browser, page, folder):
    """The whole page, in three widths, light and dark."""
    folder.mkdir(parents=True, exist_ok=True)
    for width in (1440, 768, 390):
        for scheme in ("light", "dark"):
            browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            metrics = {"width": width, "height": 1000, "deviceScaleFactor": 1, "mobile": width < 500}
            browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
            browser.get(page)
            time.sleep(0.5)
            picture = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True})
            (folder / f"{width}-{scheme}.png").write_bytes(base64.b64decode(picture["data"]))


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    words = sys.argv[1:]
    pictures = Path(words[2]) if len(words) == 3 and words[1] == "--pictures" else None
    if not pictures and len(words) not in (1, 2) or words[0].startswith("-"):
        print(__doc__)
        return 0 if words in (["-h"], ["--help"]) else 2
    folder = Path(words[0]).resolve()
    report = folder / "report.html"
    if not report.exists():
        report = folder / "comparison.html"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = open_browser(profile)
        try:
            page = report.as_uri()
            if pictures:
                take_pictures(browser, page, pictures)
                return 0
            browser.get(page)
            if report.name == "report.html":
                says(browser, json.loads((folder / "summary.json").read_text()))
            if len(words) == 2:
                browser.save_screenshot(words[1])
            if report.name == "report.html":
                use(browser)
            accessible(browser)
            fits(browser)
            prints(browser)
            logged(browser, page)
        finally:
            browser.quit()
    for problem in PROBLEMS:
        print(f"report: {problem}", file=sys.stderr)
    size = report.stat().st_size / 1e6
    print(f"{report.name}: {size:.1f} MB, {'as it should be' if not PROBLEMS else f'{len(PROBLEMS)} problem(s)'}")
    return 1 if PROBLEMS else 0


if __name__ == "__main__":
    sys.exit(main())
