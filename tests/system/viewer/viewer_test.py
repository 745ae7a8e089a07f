#!/usr/bin/env python3
"""`edgeslam view` and `edgeslam run` looked at in a real browser.

usage: viewer_test.py PROGRAM SEQUENCE COVERED [FOLDER]   SEQUENCE: a slow one, so that a busy computer has the time;
COVERED: one with a covered lens; screenshots go to FOLDER
Exit code 77: skipped, as there is no browser."""
import contextlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import browser, comes_true, missing  # noqa: E402

PROGRAM, SEQUENCE, COVERED, PICTURES = "", "", "", ""


@contextlib.contextmanager
def edgeslam(*arguments):
    """The running program; its page's address and what it said so far are attributes."""
    with tempfile.TemporaryDirectory() as folder, open(folder + "/said", "w+", encoding="utf-8") as said:
        process = subprocess.Popen([PROGRAM, *arguments], stdout=said, stderr=said, cwd=folder)
        process.said = lambda: pathlib.Path(said.name).read_text(encoding="utf-8")
        try:
            found = comes_true(lambda: re.search(r"the page is at (http://\S+:\d+/)", process.said()))
            assert found, process.said()
            process.page = found.group(1)
            yield process
            process.terminate()
            assert process.wait(timeout=60) == 0, process.said()
        finally:
            process.kill()
            process.wait()


def has_picture(opened):
    """The image is not blank: greys and the tracks' colours are in it."""
    return opened.run("""
        const canvas = document.querySelector('#picture canvas');
        if (!picture.image) return false;
        const pixels = canvas.getContext('2d', {willReadFrequently: true}).getImageData(0, 0, canvas.width, canvas.height).data;
        let green = 0;
        const greys = new Set();
        for (let i = 0; i < pixels.length; i += 4) {
          const [r, g, b] = [pixels[i], pixels[i + 1], pixels[i + 2]];
          if (r === g && g === b) greys.add(r);
          if (g > r + 80 && g > b + 30) ++green;
        }
        return greys.size > 50 && green > 200;""")


def has_map(opened):
    """Points are drawn, not only counted."""
    return opened.run("""
        if (!map.shownPoints || map.shownPoints < 50) return false;
        map.renderer.render(map.scene, map.camera);
        const gl = map.renderer.getContext();
        const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
        gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        let drawn = 0;
        for (let i = 0; i < pixels.length; i += 4) if (pixels[i] !== pixels[0] || pixels[i + 1] !== pixels[1]) ++drawn;
        return drawn > 200;""")


def state(opened):
    """None while the page is on its way, as after a token was given."""
    return opened.run("const found = document.getElementById('state'); return found && found.dataset.state;")


def whole_map(opened):
    """Its number and all that the page has of it."""
    return opened.run("""return map.map && [map.map.number, JSON.stringify(['positions', 'greys', 'sigmas', 'joins', 'keyframes'].map(
        (name) => Array.from(map.map[name])))];""")


def answers(opened):
    return opened.run("return [...document.querySelectorAll('#answers li')].map((item) => item.textContent);")


def mark(opened, which, name):
    """Where there is a measured pose at the moment."""
    def marked():
        opened.click("#scale-" + which)
        return name + " at frame" in opened.text("#scale-marks")
    assert comes_true(marked), answers(opened)


class Viewer(unittest.TestCase):
    def test_a_recording_is_shown_with_its_loss_and_its_end(self):
        with edgeslam("view", COVERED, "--port", "0") as program, browser() as opened:
            opened.open(program.page)
            # States come and go: the page keeps them for its graphs. What it shows is that of the moment.
            seen = lambda name: opened.run("return frames.frames.some((frame) => frame.state === arguments[0]);", name)
            self.assertTrue(comes_true(lambda: seen("tracking")), program.said())
            self.assertTrue(comes_true(lambda: has_map(opened)))
            self.assertTrue(comes_true(lambda: state(opened) in ("predicted", "lost"), interval_s=0.05), "the lens is covered")
            self.assertRegex(opened.text("#reason"), "[a-z]{4}")
            self.assertTrue(comes_true(lambda: seen("lost") or seen("predicted")), "the camera moved on meanwhile")
            self.assertTrue(comes_true(lambda: "at its end" in opened.text("#warnings")), opened.text("#warnings"))
            self.assertTrue(comes_true(lambda: has_map(opened)), program.said() + opened.run(
                "return JSON.stringify([map.shownPoints, map.map && map.map.number, map.map && map.map.world]);"))
            self.assertGreater(whole_map(opened)[0], 2, "it came in parts")

            def last_one_came():
                number = whole_map(opened)[0]
                time.sleep(5)
                return number == whole_map(opened)[0]
            self.assertTrue(comes_true(last_one_came))
            put_together = whole_map(opened)
            opened.open(program.page)
            self.assertEqual(comes_true(lambda: whole_map(opened)), put_together, "a page that is opened now gets it whole")
            opened.click("[data-command=reset]")
            self.assertIn("Really", opened.text("[data-command=reset]"))
            opened.click("[data-command=reset]")
            self.assertTrue(comes_true(lambda: any("at its end" in answer for answer in answers(opened))), answers(opened))
            self.assertEqual(opened.complaints(), [])

    def test_it_fits_every_window_in_light_and_dark(self):
        with edgeslam("view", SEQUENCE, "--port", "0") as program, browser() as opened:
            opened.open(program.page)
            self.assertTrue(comes_true(lambda: has_picture(opened)), program.said())
            self.assertTrue(comes_true(lambda: has_map(opened)))
            for width, height in ((1366, 768), (820, 1180), (390, 844)):
                opened.resize(width, height)
                for scheme in ("light", "dark"):
                    opened.prefer(scheme)
                    wide = opened.run("return document.documentElement.scrollWidth - window.innerWidth;")
                    self.assertLessEqual(wide, 0, f"{width} px, {scheme}: the page is wider than its window")
                    cut = opened.run("""return [...document.querySelectorAll('figcaption b')].filter((value) =>
                        value.getBoundingClientRect().right > value.closest('figure').getBoundingClientRect().right + 0.5 ||
                        value.getBoundingClientRect().left < value.previousElementSibling.getBoundingClientRect().right).length;""")
                    self.assertEqual(cut, 0, f"{width} px: a graph's value is cut off, or lies over its name")
                    unnamed = opened.run("""return [...document.querySelectorAll('button, input, canvas')].filter((control) =>
                        !control.getAttribute('aria-label') && !control.closest('label') && !control.textContent.trim()).length;""")
                    self.assertEqual(unnamed, 0, "every control has a name")
                    if PICTURES:
                        opened.screenshot(f"{PICTURES}/viewer_{width}_{scheme}.png", whole_page=True)
            self.assertEqual(opened.complaints(), [])

    def test_the_map_turns_by_keys(self):
        with edgeslam("view", SEQUENCE, "--port", "0") as program, browser() as opened:
            opened.open(program.page)
            self.assertTrue(comes_true(lambda: has_map(opened)), program.said())
            before = opened.run("map.touched = true; document.querySelector('#map canvas').focus(); return map.camera.position.toArray();")
            opened.run("for (const key of ['ArrowLeft', 'ArrowUp', '+']) document.activeElement.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));")
            after = opened.run("return map.camera.position.toArray();")
            self.assertGreater(max(abs(a - b) for a, b in zip(before, after)), 1e-3)
            self.assertEqual(opened.complaints(), [])

    def test_the_map_stands_as_gravity_says(self):
        with edgeslam("view", SEQUENCE, "--port", "0") as program, browser() as opened:
            opened.open(program.page)
            self.assertTrue(comes_true(lambda: has_map(opened)), program.said())
            self.assertTrue(comes_true(lambda: "none" in opened.text("#figures")), opened.text("#figures"))
            for up in ([0, 0, 1], [0.6, 0, -0.8], None):
                above = opened.run('''
                    map.setUp(arguments[0]);
                    const offset = map.camera.position.clone().sub(map.orbit.target);
                    return offset.dot(new THREE.Vector3(...(arguments[0] || [0, -1, 0]))) / offset.length();''', up)
                self.assertGreater(above, 0.3, "it is looked at from above")
                self.assertLess(above, 0.9, "but not from right above")
                self.assertTrue(comes_true(lambda: has_map(opened)), up)
            # The position that a person chose stays.
            moved = opened.run('''
                map.touched = true;
                const before = map.camera.position.clone();
                map.setUp([0, 0, 1]);
                return map.camera.position.distanceTo(before);''')
            self.assertLess(moved, 1e-6)
            self.assertEqual(opened.complaints(), [])

    def test_commands_do_what_their_buttons_say(self):
        with tempfile.TemporaryDirectory() as folder:
            token = "0123456789abcdef"
            configuration = pathlib.Path(folder, "robot.yaml")
            configuration.write_text(f"lcm: {{url: 'memq://'}}\nmap: {{file: {folder}/robot.map}}\nviewer: {{enabled: true, port: {free_port()}, token: {token}}}\n", encoding="utf-8")
            with edgeslam("run", "--source", SEQUENCE, "--config", str(configuration)) as program, browser() as opened:
                opened.open(program.page)
                self.assertIn("token", opened.text("body"), "a stranger is asked for it")
                opened.write("input", token)
                opened.click("button")
                self.assertTrue(comes_true(lambda: state(opened) == "tracking"), program.said())
                self.assertTrue(comes_true(lambda: has_map(opened)))
                mark(opened, "from", "Start")
                opened.click("[data-command=save_map]")
                self.assertTrue(comes_true(lambda: any("saved to" in answer for answer in answers(opened))), answers(opened))
                self.assertGreater(os.path.getsize(folder + "/robot.map"), 1000)
                mark(opened, "to", "end")
                opened.write("#scale-distance", "0.5")
                opened.click("#scale-form [type=submit]")
                # Where the camera moved too little between the two, the program says so: the command was carried out.
                self.assertTrue(comes_true(lambda: any("Set the scale: " in answer for answer in answers(opened))), answers(opened))
                opened.click("[data-command=reset]")
                opened.click("[data-command=reset]")
                self.assertTrue(comes_true(lambda: any("begun anew" in answer for answer in answers(opened))), answers(opened))
                self.assertIn("begun anew", program.said())
                complaints = [entry for entry in opened.complaints() if "401" not in entry["message"]]
                self.assertEqual(complaints, [])

    def test_a_lost_connection_is_told_and_made_again(self):
        port = free_port()
        with browser() as opened:
            with edgeslam("view", SEQUENCE, "--port", str(port)) as program:
                opened.open(program.page)
                self.assertTrue(comes_true(lambda: opened.text("#connection") == "connected"))
            self.assertTrue(comes_true(lambda: "trying again" in opened.text("#connection")))
            with edgeslam("view", SEQUENCE, "--port", str(port)):
                self.assertTrue(comes_true(lambda: opened.text("#connection") == "connected"))
                self.assertTrue(comes_true(lambda: state(opened) == "tracking"))


def free_port():
    import socket
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


if __name__ == "__main__":
    if missing():
        print("skipped: " + missing())
        sys.exit(77)
    PROGRAM, SEQUENCE, COVERED = sys.argv[1:4]
    PICTURES = sys.argv[4] if len(sys.argv) > 4 else ""
    if PICTURES:
        os.makedirs(PICTURES, exist_ok=True)
    unittest.main(argv=sys.argv[:1], verbosity=2)
