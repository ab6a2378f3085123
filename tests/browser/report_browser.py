#!/usr/bin/env python3
"""Opens the report in headless Chromium, uses it, and checks that the picture on the screen changes as it must.

usage: report_browser.py REPORT_PAGE_PROGRAM OUTPUT_FOLDER [REPORT.html]
With REPORT.html only its screenshots are taken. Exit status 77: skipped, no Chromium here.
"""
import base64
import http.client
import json
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time


class Browser:
    """The few WebDriver commands (W3C, https://www.w3.org/TR/webdriver2/) that the test needs."""

    def __init__(self, driver, chromium, width=1280, height=1500, dark=False):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.process = subprocess.Popen([driver, f"--port={self.port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--disable-background-networking", "--hide-scrollbars",
                     "--no-first-run", f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"]
        if dark:
            arguments.append("--blink-settings=preferredColorScheme=0")
        for _ in range(100):
            try:
                self.call("GET", "/status")
                break
            except OSError:
                time.sleep(0.1)
        options = {"binary": chromium, "args": arguments}
        session = self.call("POST", "/session", {"capabilities": {"alwaysMatch": {"browserName": "chrome", "goog:chromeOptions": options,
                                                                                  "goog:loggingPrefs": {"browser": "ALL"}}}})
        self.session = "/session/" + session["sessionId"]

    def call(self, method, path, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        connection.request(method, path, json.dumps(body) if body is not None else None, {"Content-Type": "application/json"})
        value = json.loads(connection.getresponse().read())["value"]
        if isinstance(value, dict) and "error" in value:
            raise RuntimeError(value["message"])
        return value

    def open(self, file):
        self.call("POST", self.session + "/url", {"url": file.resolve().as_uri()})

    def run(self, script, *arguments):
        return self.call("POST", self.session + "/execute/sync", {"script": script, "args": list(arguments)})

    def keys(self, selector, text):
        element = self.call("POST", self.session + "/element", {"using": "css selector", "value": selector})
        self.call("POST", f"{self.session}/element/{next(iter(element.values()))}/value", {"text": text})

    def click(self, selector):
        element = self.call("POST", self.session + "/element", {"using": "css selector", "value": selector})
        self.call("POST", f"{self.session}/element/{next(iter(element.values()))}/click", {})

    def drag(self, start, end):
        move = lambda place: {"type": "pointerMove", "duration": 50, "x": round(place[0]), "y": round(place[1])}
        actions = [move(start), {"type": "pointerDown", "button": 0}, move(end), {"type": "pointerUp", "button": 0}]
        self.call("POST", self.session + "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def screenshot(self, file):
        file.write_bytes(base64.b64decode(self.call("GET", self.session + "/screenshot")))

    def errors(self):
        return [entry["message"] for entry in self.call("POST", self.session + "/se/log", {"type": "browser"}) if entry["level"] == "SEVERE"]

    def close(self):
        try:
            self.call("DELETE", self.session)
        except (AttributeError, OSError, RuntimeError):
            pass
        self.process.terminate()
        self.process.wait()
        self.profile.cleanup()


SETTLED = "return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30))));"
# Mean and a hash of the canvas, in columns [from, to) as parts of its width.
PIXELS = """
const canvas = document.getElementById('canvas'), context = canvas.getContext('2d');
const from = Math.round(arguments[0] * canvas.width), to = Math.round(arguments[1] * canvas.width);
const data = context.getImageData(from, 0, to - from, canvas.height).data;
let sum = 0, hash = 0;
for (let i = 0; i < data.length; ++i) { if (i % 4 < 3) sum += data[i]; hash = (31 * hash + data[i]) | 0; }
return [sum / (data.length * 3 / 4), hash];
"""


def pixels(browser, start=0.0, end=1.0):
    browser.run(SETTLED)
    return browser.run(PIXELS, start, end)


def check(condition, text):
    print(("ok    " if condition else "FAILS ") + text)
    if not condition:
        check.failures += 1


check.failures = 0


def use(browser):
    first = pixels(browser)
    left, right = pixels(browser, 0, 0.5), pixels(browser, 0.5, 1)
    check(browser.run("return document.getElementById('canvas').width") == 256, "the canvas has the picture's size")
    check(first[0] > 20, f"the picture is not black (mean {first[0]:.1f})")

    ev = float(browser.run("return document.getElementById('exposure').value"))
    browser.run("const e = document.getElementById('exposure'); e.value = arguments[0]; e.dispatchEvent(new Event('input', {bubbles: true}));", ev - 2)
    brighter = pixels(browser)
    check(brighter[0] > 1.3 * first[0], f"two stops less are brighter ({first[0]:.1f} -> {brighter[0]:.1f})")
    browser.keys("#exposure", "\ue014" * 20)
    check(pixels(browser)[1] == first[1], "the slider's arrow keys lead back to the first picture")

    box = browser.run("const b = document.getElementById('canvas').getBoundingClientRect(), s = Math.min(b.width, b.height * 1);"
                      "return [b.left + b.width / 2, b.top + 60, s];")
    browser.drag((box[0], box[1]), (box[0] - 0.25 * box[2], box[1]))
    check(pixels(browser, 0.5, 1)[1] == right[1], "the swipe leaves the right half as it was")
    check(pixels(browser, 0, 0.5)[1] != left[1], "the swipe shows Mitsuba's noise between a quarter and a half")
    check(abs(int(browser.run("return document.getElementById('divider').getAttribute('aria-valuenow')")) - 25) <= 1, "the divider stands at a quarter")
    browser.keys("#divider", "\ue010")
    all_ours = pixels(browser)
    browser.keys("#divider", "\ue011")
    all_reference = pixels(browser)
    check(all_ours[1] != all_reference[1], "End and Home show the whole of each picture")

    for view in ("luminance", "sigma", "relative"):
        browser.click(f"#views input[value={view}]")
        now = pixels(browser)
        check(now[1] != all_reference[1], f"the view '{view}' differs from the picture")
        check(not browser.run("return document.getElementById('legend').hidden") and browser.run("return document.querySelectorAll('#legend-ticks span').length") == 5,
              f"the view '{view}' has a legend")
    one = pixels(browser)
    browser.run("const s = document.getElementById('average'); s.value = '16'; s.dispatchEvent(new Event('input', {bubbles: true}));")
    check(pixels(browser)[1] != one[1], "averaging changes the difference")
    browser.click("#views input[value=picture]")
    check(pixels(browser)[1] == all_reference[1], "back at the picture it is as before")

    browser.click("#tabs button:nth-child(4)")
    spot = pixels(browser)
    check(spot[1] != all_reference[1] and spot[0] < all_reference[0], "a light's tab shows that light alone, and is darker")
    browser.keys("#tabs button:nth-child(4)", "\ue012")
    check(browser.run("return document.querySelector('#tabs [aria-selected=true]').textContent") == "fill", "the arrow keys change tabs")
    browser.click("#tabs button:nth-child(1)")
    browser.run("const s = document.getElementById('against'); s.value = 'authored'; s.dispatchEvent(new Event('input', {bubbles: true}));")
    check(pixels(browser)[1] != all_reference[1], "the asset's own models are another picture")
    browser.run("const s = document.getElementById('against'); s.value = 'reference'; s.dispatchEvent(new Event('input', {bubbles: true}));")

    browser.drag((box[0], box[1]), (box[0], box[1]))
    read = browser.run("return ['read-pixel', 'read-ours', 'read-reference', 'read-difference', 'read-sigma'].map(id => document.getElementById(id).textContent)")
    check("cd/m²" in read[1] and "cd/m²" in read[2] and "%" in read[3] and "σ" in read[4], "the read-out under the pointer: " + "; ".join(read))
    browser.click("#flicker")
    check(browser.run("return document.getElementById('flicker').getAttribute('aria-pressed')") == "true", "flicker can be switched on")
    browser.click("#flicker")
    missing = browser.run("return [...document.querySelectorAll('input, select, button')].filter(e => !(e.labels?.length || e.textContent.trim() || e.ariaLabel)).length")
    check(missing == 0, "every control has a label")
    check(browser.run("return performance.getEntriesByType('resource').length") == 0, "the page loads nothing else")
    check(not browser.errors(), "no errors in the console")


def pictures(browser, file, folder, name):
    """The whole page, and each view."""
    browser.open(file)
    browser.run(SETTLED)
    height = browser.run("return document.documentElement.scrollHeight")
    browser.call("POST", browser.session + "/window/rect", {"width": 1280, "height": min(height + 120, 6000)})
    browser.run(SETTLED)
    browser.screenshot(folder / f"{name}.png")


def main():
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    driver = shutil.which("chromedriver")
    if not chromium or not driver:
        print("skipped: Chromium or its driver is not installed (Debian: apt-get install chromium chromium-driver)")
        return 77
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    files = [pathlib.Path(sys.argv[3])] if len(sys.argv) > 3 else []
    for kind in ("same", "differs") if not files else ():
        files.append(folder / f"report_{kind}.html")
        subprocess.run([program, kind, files[-1]], check=True)
    for dark in (False, True):
        browser = Browser(driver, chromium, dark=dark)
        try:
            if not dark and len(sys.argv) <= 3:
                browser.open(files[0])
                use(browser)
            for file in files:
                pictures(browser, file, folder, file.stem + ("_dark" if dark else ""))
        finally:
            browser.close()
    print(f"screenshots in {folder}")
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main())
