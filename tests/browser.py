"""A headless Chromium, driven over its DevTools pipe."""

import base64
import fcntl
import json
import os
import select
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
TIMEOUT = 20.0  # s
COMPLAINTS = ("error", "warning", "assert")
FLAGS = (
    "--headless=new",
    "--remote-debugging-pipe",
    "--no-sandbox",  # containers often run as root, which the sandbox refuses
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--force-device-scale-factor=1",
    "--hide-scrollbars",
)


def find_browser() -> str | None:
    """Path of a Chromium or Chrome, or None."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


class Page:
    """A page in the browser; `requests` are the addresses that it loaded, `complaints` its
    errors and warnings."""

    def __init__(self, send: int, receive: int) -> None:
        self._send = send
        self._receive = receive
        self._buffer = b""
        self._last = 0
        self._session: str | None = None
        self.requests: list[str] = []
        self.complaints: list[str] = []

    def open(self, url: str, width: int = 1400, height: int = 900) -> None:
        """Open an address and wait until it has loaded."""
        self._session = None
        self.requests.clear()
        self.complaints.clear()
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call(
            "Target.attachToTarget", targetId=target, flatten=True
        )["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.resize(width, height)
        self.call("Page.navigate", url=url)
        self.wait_for("document.readyState === 'complete'")

    def resize(self, width: int, height: int) -> None:
        """Set the size of the window [px]."""
        size = {"width": width, "height": height}
        size |= {"deviceScaleFactor": 1, "mobile": False}
        self.call("Emulation.setDeviceMetricsOverride", **size)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the DevTools protocol and return its result."""
        self._last += 1
        message: dict[str, Any] = {
            "id": self._last,
            "method": method,
            "params": parameters,
        }
        if self._session:
            message["sessionId"] = self._session
        os.write(self._send, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._last:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                result: dict[str, Any] = answer["result"]
                return result

    def evaluate(self, expression: str) -> Any:
        """Value of a JavaScript expression, awaited if it is a promise."""
        result = self.call(
            "Runtime.evaluate",
            expression=expression,
            returnByValue=True,
            awaitPromise=True,
        )
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, expression: str) -> None:
        """Wait until an expression is true; the page checks it before each frame."""
        look = (
            f"done => {{ const look = () => ({expression}) ? done() : "
            "requestAnimationFrame(look); look() }"
        )
        try:
            self.evaluate(f"new Promise({look})")
        except TimeoutError as error:
            error.add_note(f"{expression} did not become true: {self.complaints}")
            raise

    def settle(self) -> None:
        """Wait until the next frame is drawn."""
        self.evaluate(
            "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )

    def picture(self, **clip: float) -> bytes:
        """The window, or a part of it, as a PNG."""
        part = {"clip": clip} if clip else {}
        data: str = self.call("Page.captureScreenshot", format="png", **part)["data"]
        return base64.b64decode(data)

    def prefer(self, **features: str) -> None:
        """Set preferences of the user: prefers_color_scheme="dark"."""
        asked = [
            {"name": name.replace("_", "-"), "value": value}
            for name, value in features.items()
        ]
        self.call("Emulation.setEmulatedMedia", features=asked)

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._buffer:
            if not select.select([self._receive], [], [], TIMEOUT)[0]:
                raise TimeoutError("the browser does not answer")
            read = os.read(self._receive, 1 << 20)
            if not read:
                raise RuntimeError("the browser has ended")
            self._buffer += read
        text, _, self._buffer = self._buffer.partition(b"\0")
        message: dict[str, Any] = json.loads(text)
        self._note(message.get("method", ""), message.get("params", {}))
        return message

    def _note(self, method: str, event: dict[str, Any]) -> None:
        if method == "Network.requestWillBeSent":
            url = event["request"]["url"]
            if not url.startswith("data:"):
                self.requests.append(url)
        elif (
            method == "Runtime.exceptionThrown"
            or (method == "Runtime.consoleAPICalled" and event["type"] in COMPLAINTS)
            or (method == "Log.entryAdded" and event["entry"]["level"] in COMPLAINTS)
        ):
            self.complaints.append(str(event))


@contextmanager
def browser(path: str) -> Iterator[Page]:
    """Run a browser, and yield its page."""
    (to_browser, send), (receive, from_browser) = _pipe(), _pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        actions = [
            (os.POSIX_SPAWN_DUP2, to_browser, 3),  # the browser reads 3 and writes 4
            (os.POSIX_SPAWN_DUP2, from_browser, 4),
            *(
                (os.POSIX_SPAWN_OPEN, output, os.devnull, os.O_WRONLY, 0)
                for output in (1, 2)
            ),
        ]
        command = [path, *FLAGS, f"--user-data-dir={profile}"]
        process = os.posix_spawn(path, command, os.environ, file_actions=actions)
        os.close(to_browser)
        os.close(from_browser)
        try:
            yield Page(send, receive)
        finally:
            os.close(send)  # the browser ends when its pipe is closed
            while select.select([receive], [], [], TIMEOUT)[0] and os.read(
                receive, 1 << 20
            ):
                pass
            os.kill(process, signal.SIGKILL)  # unless it has ended
            os.waitpid(process, 0)
            os.close(receive)


def _pipe() -> list[int]:
    """Read and write end of a pipe, with numbers that leave 3 and 4 to the browser."""
    low = os.pipe()
    high = [fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in low]
    for end in low:
        os.close(end)
    return high
