"""A real browser for tests: Debian's Chromium without a screen, driven by WebDriver, which is JSON over HTTP."""
import base64
import contextlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

PATIENCE_S = 90  # for what takes a moment on an idle computer


def missing():
    """Empty, or what is not installed."""
    return next((f"{program} is not installed (Debian: {package})" for program, package in
                 (("chromium", "chromium"), ("chromedriver", "chromium-driver")) if not shutil.which(program)), "")


def comes_true(what, patience_s=PATIENCE_S, interval_s=0.2):
    """What `what` gave when it was first true; its last value where it never was."""
    end = time.monotonic() + patience_s
    while True:
        value = what()
        if value or time.monotonic() > end:
            return value
        time.sleep(interval_s)


class Browser:
    def __init__(self, base, session):
        self.base, self.session = base, session

    def ask(self, method, path, body=None):
        request = urllib.request.Request(f"{self.base}/session/{self.session}{path}", method=method,
                                         data=None if body is None else json.dumps(body).encode(), headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{path}: {error.read().decode(errors='replace')[:600]}") from error

    def open(self, url):
        self.ask("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """The value of a script's `return`."""
        return self.ask("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def text(self, selector):
        return self.run("const found = document.querySelector(arguments[0]); return found ? found.textContent.trim() : null;", selector)

    def click(self, selector):
        """As a person does: moved into view, and only where nothing covers it."""
        found = self.ask("POST", "/element", {"using": "css selector", "value": selector})
        self.ask("POST", f"/element/{next(iter(found.values()))}/click", {})

    def write(self, selector, text):
        found = self.ask("POST", "/element", {"using": "css selector", "value": selector})
        self.ask("POST", f"/element/{next(iter(found.values()))}/value", {"text": text})

    def resize(self, width, height):
        self.ask("POST", "/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}})

    def prefer(self, scheme):
        """light or dark"""
        self.ask("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {"features": [{"name": "prefers-color-scheme", "value": scheme}]}})

    def screenshot(self, path, whole_page=False):
        taken = self.ask("POST", "/goog/cdp/execute", {"cmd": "Page.captureScreenshot", "params": {"format": "png", "captureBeyondViewport": whole_page}})
        with open(path, "wb") as file:
            file.write(base64.b64decode(taken["data"]))

    def complaints(self):
        """What the page's console was told since the last call, that is not mere information."""
        return [entry for entry in self.ask("POST", "/se/log", {"type": "browser"}) if entry["level"] in ("SEVERE", "WARNING") and not is_of_the_driver(entry["message"])]


# Software rendering speaks of itself.
def is_of_the_driver(message):
    return "GPU stall" in message or "WebGL" in message and "GL Driver Message" in message


@contextlib.contextmanager
def browser(width=1280, height=900):
    with tempfile.TemporaryDirectory() as profile, open(os.path.join(profile, "driver.log"), "w+", encoding="utf-8") as log:
        driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=log, stderr=log, start_new_session=True)
        try:
            port = comes_true(lambda: port_in(log.name))
            assert port, "chromedriver does not start: " + open(log.name, encoding="utf-8").read()
            arguments = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                         "--ignore-gpu-blocklist", "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas", "--no-proxy-server", "--disable-background-networking", "--mute-audio", f"--user-data-dir={profile}/profile", f"--window-size={width},{height}"]
            request = urllib.request.Request(f"http://127.0.0.1:{port}/session", method="POST", headers={"Content-Type": "application/json"}, data=json.dumps(
                {"capabilities": {"alwaysMatch": {"goog:chromeOptions": {"args": arguments}, "goog:loggingPrefs": {"browser": "ALL"}}}}).encode())
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as response:
                session = json.load(response)["value"]["sessionId"]
            opened = Browser(f"http://127.0.0.1:{port}", session)
            opened.resize(width, height)
            try:
                yield opened
            finally:
                with contextlib.suppress(Exception):
                    opened.ask("DELETE", "")
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(driver.pid, signal.SIGKILL)
            driver.wait()


def port_in(path):
    with open(path, encoding="utf-8") as file:
        for line in file:
            if "started successfully on port" in line:
                return int(line.rstrip().rstrip(".").split()[-1])
    return None
