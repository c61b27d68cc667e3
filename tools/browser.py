"""A headless Chromium driven through its debugging pipe, for pictures and tests of pages. Python's own library only."""

import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# WebGL by software, nothing from the network, and what containers do not have.
FLAGS = (
    "--headless --no-sandbox --disable-gpu --use-angle=swiftshader --enable-unsafe-swiftshader --disable-dev-shm-usage "
    "--disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync "
    "--disable-extensions --hide-scrollbars --force-color-profile=srgb --remote-debugging-pipe"
).split()


def find_chromium():
    """Path of a Chromium or Chrome, or None."""
    named = os.environ.get("CERTA_CHROMIUM")
    return named or next((path for path in map(shutil.which, NAMES) if path), None)


class Browser:
    """`with Browser() as browser:` one page at a time; `errors` collects what pages complain about."""

    def __init__(self, width=1280, height=860, scale=1, timeout=240):
        self.timeout = timeout
        self.errors = []
        self.buffer = b""
        self.last_id = 0
        self.folder = tempfile.mkdtemp(prefix="certa-browser-")
        ours, theirs = [], []
        for _ in range(2):
            read, write = os.pipe()
            ours.append((read, write))
        # Above 9, so that the shell below cannot overwrite one by the other.
        to_read, self.to_write = (fcntl.fcntl(fd, fcntl.F_DUPFD_CLOEXEC, 10) for fd in ours[0])
        self.to_read, from_write = (fcntl.fcntl(fd, fcntl.F_DUPFD_CLOEXEC, 10) for fd in ours[1])
        for fd in (*ours[0], *ours[1]):
            os.close(fd)
        theirs = (to_read, from_write)
        command = [find_chromium(), *FLAGS, f"--user-data-dir={self.folder}", f"--window-size={width},{height}"]
        # Chromium reads commands from descriptor 3 and answers on 4.
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{to_read} 4>&{from_write}', "bash", *command, "about:blank"],
            pass_fds=theirs, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for fd in theirs:
            os.close(fd)
        try:
            target = self.call("Target.createTarget", {"url": "about:blank"}, page=False)["targetId"]
            self.session = None
            self.session = self.call("Target.attachToTarget", {"targetId": target, "flatten": True}, page=False)["sessionId"]
            for domain in ("Page", "Runtime", "Log"):
                self.call(f"{domain}.enable")
            self.resize(width, height, scale)
        except BaseException:
            self.process.kill()
            self.__exit__()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close", page=False)
            self.process.wait(timeout=10)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        os.close(self.to_read)
        os.close(self.to_write)
        shutil.rmtree(self.folder, ignore_errors=True)

    def receive(self, deadline):
        while b"\0" not in self.buffer:
            ready = select.select([self.to_read], [], [], max(0, deadline - time.monotonic()))[0]
            part = os.read(self.to_read, 1 << 20) if ready else None
            if not part:
                raise RuntimeError("Chromium does not answer" if part is None else "Chromium ended")
            self.buffer += part
        text, self.buffer = self.buffer.split(b"\0", 1)
        message = json.loads(text)
        parameters = message.get("params", {})
        if message.get("method") == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        if message.get("method") == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.errors.append(" ".join(str(one.get("value", one.get("description"))) for one in parameters["args"]))
        if message.get("method") == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            self.errors.append(parameters["entry"]["text"])
        return message

    def call(self, method, parameters=None, page=True):
        """One command of the protocol; its result."""
        self.last_id += 1
        message = {"id": self.last_id, "method": method, "params": parameters or {}}
        if page:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.to_write, data):]
        deadline = time.monotonic() + self.timeout
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == self.last_id:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def evaluate(self, expression):
        """The value of a JavaScript expression, promises awaited."""
        answer = self.call("Runtime.evaluate", {"expression": expression, "returnByValue": True, "awaitPromise": True})
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description") or details["text"])
        return answer["result"].get("value")

    def resize(self, width, height, scale=1):
        self.call("Emulation.setDeviceMetricsOverride",
                  {"width": width, "height": height, "deviceScaleFactor": scale, "mobile": False})

    def open(self, path, fragment="", ready="window.certa || document.documentElement.dataset.certa"):
        """Opens a file anew and waits until it has drawn, or has said why it does not."""
        self.call("Page.navigate", {"url": "about:blank"})
        url = "file://" + os.path.abspath(path) + ("#" + fragment.lstrip("#") if fragment else "")
        self.call("Page.navigate", {"url": url})
        deadline = time.monotonic() + self.timeout
        while not self.evaluate("document.readyState === 'complete' && Boolean(" + ready + ")"):
            if self.errors or time.monotonic() > deadline:
                raise RuntimeError(f"{path} does not show anything: {self.errors}")
            time.sleep(0.05)
        self.settle()

    def enter_frame(self):
        """Makes calls go to the only frame of the page that has a process of its own, as sandboxed ones have."""
        deadline = time.monotonic() + self.timeout
        while True:
            targets = self.call("Target.getTargets", page=False)["targetInfos"]
            frames = [target["targetId"] for target in targets if target["type"] == "iframe"]
            if len(frames) == 1:
                break
            if time.monotonic() > deadline:
                raise RuntimeError(f"{len(frames)} frames of their own")
            time.sleep(0.05)
        self.session = self.call("Target.attachToTarget", {"targetId": frames[0], "flatten": True}, page=False)["sessionId"]
        for domain in ("Runtime", "Log"):
            self.call(f"{domain}.enable")

    def settle(self):
        """Waits for two frames: what was asked for is on the screen."""
        self.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def report(self):
        """What the page says that it drew."""
        return self.evaluate("certa.report()")

    def screenshot(self, path):
        self.settle()
        data = base64.b64decode(self.call("Page.captureScreenshot", {"format": "png"})["data"])
        with open(path, "wb") as file:
            file.write(data)

    def mouse(self, kind, x, y, button="none", buttons=0, **more):
        self.call("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, "button": button, "buttons": buttons, **more})

    def key(self, text):
        typed = {"text": text} if len(text) == 1 else {}  # arrows and the like type nothing
        self.call("Input.dispatchKeyEvent", {"type": "keyDown", "key": text, **typed})
        self.call("Input.dispatchKeyEvent", {"type": "keyUp", "key": text})
