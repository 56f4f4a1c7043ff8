"""Chromium without a window, driven over a pair of pipes by the DevTools protocol: no package is needed.

    with Browser("chromium") as browser:
        browser.open("file:///page.html", width=1280, height=900)
        browser.value("document.title")
"""
import base64
import json
import os
import subprocess
import tempfile
import time

# A page with a slider and nothing else, beside which others are timed.
EMPTY = ("<!DOCTYPE html><title>empty</title><input type='range' max='200' id='slider'><div id='stage'></div>"
         "<script>slider.oninput = () => stage.dataset.record = slider.value</script>")


class Browser:
    def __init__(self, program: str, downloads: str | None = None, webgl: bool = True) -> None:
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_child, self._write = os.pipe()
        self._read, from_child = os.pipe()
        for descriptor in (to_child, from_child):
            os.set_inheritable(descriptor, True)
        words = [program, "--headless", "--no-sandbox", "--disable-dev-shm-usage", "--remote-debugging-pipe", "--no-first-run",
                 *(("--use-angle=swiftshader", "--enable-unsafe-swiftshader") if webgl else ("--disable-gpu", "--disable-3d-apis")),
                 "--disable-background-networking",
                 f"--user-data-dir={self._profile.name}", "about:blank"]
        # The browser reads commands at descriptor 3 and answers at 4.
        self._process = subprocess.Popen(["sh", "-c", f'exec "$@" 3<&{to_child} 4>&{from_child}', "sh", *words],
                                         pass_fds=(to_child, from_child), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_child)
        os.close(from_child)
        self._rest, self._number, self._target, self._session, self.events = b"", 0, None, None, []
        self.downloads = downloads

    def __enter__(self) -> "Browser":
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._write)  # the browser ends when its commands do
        try:
            self._process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._read)
        self._profile.cleanup()

    def call(self, method: str, whole_browser: bool = False, **parameters: object) -> dict:
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session and not whole_browser:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def _next(self) -> dict:
        while b"\0" not in self._rest:
            part = os.read(self._read, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self._rest += part
        one, self._rest = self._rest.split(b"\0", 1)
        return json.loads(one)

    def open(self, address: str, width: int = 1280, height: int = 900, phone: bool = False, ready: str = "true") -> float:
        """Opens a page in the place of the one before and waits for it; seconds until `ready` is true."""
        before, self._target = self._target, self.call("Target.createTarget", whole_browser=True, url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", whole_browser=True, targetId=self._target, flatten=True)["sessionId"]
        if before:
            self.call("Target.closeTarget", whole_browser=True, targetId=before)
        self.events = []
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        if self.downloads:
            self.call("Browser.setDownloadBehavior", whole_browser=True, behavior="allow", downloadPath=self.downloads)
        begin = time.monotonic()
        self.call("Page.navigate", url=address)
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self._next())
        self.wait(ready)
        return time.monotonic() - begin

    def value(self, expression: str) -> object:
        """Value of an expression, or of the promise that it is."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails'].get('exception', answer['exceptionDetails'])}")
        return answer["result"].get("value")

    def wait(self, expression: str, seconds: float = 20) -> None:
        end = time.monotonic() + seconds
        while not self.value(f"Boolean({expression})"):
            if time.monotonic() > end:
                raise RuntimeError(f"not within {seconds} s: {expression}; {self.complaints()}")
            time.sleep(0.02)

    def mouse(self, kind: str, x: float, y: float, **more: object) -> None:
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x: float, y: float) -> None:
        self.mouse("mouseMoved", x, y)
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, x, y, button="left", clickCount=1)

    def press(self, key: str) -> None:
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key,
                      windowsVirtualKeyCode={"ArrowLeft": 37, "ArrowRight": 39, "Tab": 9}.get(key, 0))

    def picture(self, path: str, whole: bool = False) -> bytes:
        """A PNG of what is in sight, or of the whole page."""
        content = base64.b64decode(self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
                                   if not whole else self._whole())
        with open(path, "wb") as file:
            file.write(content)
        return content

    def _whole(self) -> str:
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
        return self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)["data"]

    def answers_to_drags(self) -> list:
        """Milliseconds from each of 30 movements of the slider of a report with 200 states to the next picture."""
        return self.value("""(async () => { const slider = document.getElementById('slider'), times = [];
          const stage = document.getElementById('stage');
          for (let k = 0; k < 30; ++k) { slider.value = 5 + 6 * k; const begin = performance.now();
            slider.dispatchEvent(new Event('input'));
            while (stage.dataset.record != slider.value) await new Promise(done => setTimeout(done, 0));
            await new Promise(done => requestAnimationFrame(() => setTimeout(done, 0)));
            times.push(performance.now() - begin); }
          return times; })()""")

    def complaints(self) -> list:
        """Errors and warnings of the page's console."""
        found = []
        for event in self.events:
            method, more = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(str(more["exceptionDetails"].get("exception", {}).get("description", more["exceptionDetails"]["text"])))
            elif method == "Log.entryAdded" and more["entry"]["level"] in ("error", "warning"):
                found.append(more["entry"]["text"])
            elif method == "Runtime.consoleAPICalled" and more["type"] in ("error", "warning", "assert"):
                found.append(" ".join(str(each.get("value", each.get("description"))) for each in more["args"]))
        return found

    def requests(self) -> list:
        """Addresses that the page asked for, itself and what it holds (data:, blob:) left out."""
        asked = [event["params"]["request"]["url"] for event in self.events
                 if event.get("method") == "Network.requestWillBeSent" and event["params"].get("type") != "Document"]
        return [address for address in asked if not address.startswith(("data:", "blob:"))]
