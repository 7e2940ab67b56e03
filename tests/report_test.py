#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""mreport's page in headless Chromium: the surface is drawn, buttons, keys and clicks lead to triangles, nothing is loaded,
and without WebGL or scripts a picture is shown. With AXE=axe.min.js, also its check of accessibility.

usage: tests/report_test.py BIN_DIR      status 77: Chromium is not installed
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
from browser import Browser  # noqa: E402

GPU = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
MOST_BYTES, MOST_SECONDS = 1.9e6, 10  # seconds: a loaded machine without a graphics card takes a multiple of one
faults = []


def expect(what, holds):
    if not holds:
        faults.append(what)
        print("failed:", what)


def make(folder, bin_dir):
    """Makes the pages and returns their paths by name."""
    commands = """
        mshape tree --triangles 4000 -q -o tree.ply
        mremesh -q --triangles 8000 tree.ply -o good.ply --html good.html
        mreport good.ply --require topology,kappa=0.95 -o failed.html
        mclean -q tree.ply | mpartition -q | mmultiscale -q | mparam -q | mreport -o charts.html
        mshape regions --nested 3 -q -o regions.ply
        mremesh -q regions.ply -o nested.ply --html nested.html
        mremesh -q --triangles 3000 --keep stages tree.ply -o stages.ply
        for stage in lines mesh2d; do mreport stages/*-$stage.ply -o $stage.html; done
        mshape body --patches 850 --triangles 20000 -q | mclean -q | mfeature -q | mreport -o dense.html
        mshape tree --triangles 100000 --noise 0.05 -q -o large.ply
        mshape tree --triangles 100000 --noise 0.05 --seed 2 -q | mreport --require topology --reference large.ply - -o large.html
        mshape tree --triangles 100000 --noise 0.2 --seed 3 -q | mreport --reference large.ply - -o faulty.html
        mshape tree --triangles 160000 -q | mreport --reference - good.ply -o beyond.html
        mreport good.ply large.ply -o two.html
    """
    env = {**os.environ, "PATH": bin_dir + ":" + os.environ["PATH"]}
    subprocess.run(["bash", "-ec", commands], cwd=folder, env=env, check=True)
    return {n[:-5]: os.path.join(folder, n) for n in os.listdir(folder) if n.endswith(".html")}


def shown(browser, path):
    """Opens a page and waits for the first picture; returns the milliseconds it took."""
    browser.open(path)
    took = float(browser.wait("document.querySelector('canvas').dataset.drawn"))
    browser.wait("!document.querySelector('button[data-t]:disabled')")
    loaded = [u for u in browser.requests() if not u.startswith(("data:", "file://" + path))]
    expect(f"{path}: nothing is loaded, but {loaded}", not loaded)
    expect(f"{path}: the console is silent, but says {browser.complaints()}", not browser.complaints())
    return took


def colors(browser, pane=0):
    """Returns the number of pixels of a pane that are not white, and of different colors."""
    return browser.run(f"""(() => {{
        const c = document.querySelectorAll('canvas')[{pane}], gl = c.getContext('webgl2');
        const p = new Uint32Array(c.width * c.height);
        gl.readPixels(0, 0, c.width, c.height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(p.buffer));
        return [p.filter(x => x !== 0xffffffff).length / p.length, new Set(p).size];
    }})()""")


def shares(browser, pane=0):
    """Returns the shares of the pixels drawn in a pane that are almost black, and orange."""
    return browser.run(f"""(() => {{
        const c = document.querySelectorAll('canvas')[{pane}], gl = c.getContext('webgl2'), p = new Uint8Array(4 * c.width * c.height);
        gl.readPixels(0, 0, c.width, c.height, gl.RGBA, gl.UNSIGNED_BYTE, p);
        let all = 0, black = 0, orange = 0;
        for (let i = 0; i < p.length; i += 4) {{
          all += p[i] + p[i + 1] + p[i + 2] < 765;
          black += p[i] < 30 && p[i + 1] < 30 && p[i + 2] < 30;
          orange += p[i] > 240 && p[i + 1] > 140 && p[i + 1] < 200 && p[i + 2] < 40;
        }}
        return [black / all, orange / all];
    }})()""")


def meshes(browser):
    """Returns what the page says of its meshes, by kind."""
    return {m["kind"]: m for m in json.loads(browser.run("document.getElementById('data').textContent"))["meshes"]}


def view(browser):
    return [float(x) for x in browser.run("document.querySelector('canvas').dataset.view").split()]


def views(browser):
    """Returns the view of both panes."""
    return [[float(x) for x in c.split()] for c in browser.run("[...document.querySelectorAll('canvas')].map(c => c.dataset.view)")]


def still(browser, find):
    """Returns the place that a script finds, once it no longer changes: a busy machine may still scroll."""
    place, last = browser.run(find), None
    while place != last:
        time.sleep(0.3)
        place, last = browser.run(find), place
    return place


def settled(browser):
    """Returns the view when the camera has arrived."""
    browser.wait("!document.body.dataset.busy")
    return view(browser)


def test_view(browser, pages):
    shown(browser, pages["good"])
    ink, count = colors(browser)
    expect(f"the tree is drawn: {ink} of the pane, {count} colors", 0.03 < ink < 0.9 and count > 50)
    facts = json.loads(browser.run("document.getElementById('report').textContent"))
    expect("the verdict is in the JSON", facts["results"][0]["met"] is True and len(facts["times"]) >= 12)
    expect("the command line is shown", "mremesh" in browser.run("document.body.innerText"))
    before = settled(browser)
    # a button leads the camera to its triangle, by a real click
    place = browser.run("""(() => {
        const b = document.querySelector('button[data-t]');
        b.scrollIntoView({block: 'center'});
        const r = b.getBoundingClientRect();
        return [r.x + r.width / 2, r.y + r.height / 2, +b.dataset.t];
    })()""")
    browser.click(place[0], place[1])
    browser.wait("document.getElementById('status').textContent.includes('triangle')")
    after = settled(browser)
    t = str(int(place[2]))
    center = browser.run(f"JSON.parse(document.getElementById('data').textContent).results[0].exact[{t}]")
    expect(f"the camera is at triangle {t}", max(abs(a - b) for a, b in zip(center, after)) < 1e-3 * before[3])
    expect("the camera is near it", after[3] < 0.2 * before[3])
    status = browser.run("document.getElementById('status').textContent")
    expect("the status names it", f"triangle {t}:" in status)
    kappa = browser.run("document.querySelector('button[data-t]').closest('tr').cells[1].textContent")
    expect(f"its kappa is {kappa}: {status}", abs(float(re.search("kappa ([0-9.]+)", status)[1]) - float(kappa)) < 0.003)
    expect("it is marked", browser.run("!document.querySelector('.mark').hidden"))
    # keys: the whole, rotate, zoom, next
    browser.run("document.querySelector('canvas').focus()")
    browser.press("Home")
    expect("Home shows the whole", settled(browser) == before)
    browser.press("-")
    expect("- zooms out", settled(browser)[3] > 1.2 * before[3])
    browser.press("n")
    browser.wait("document.getElementById('status').textContent.includes('triangle')")
    # a click on the surface names the triangle there
    browser.press("Home")
    settled(browser)
    browser.run("document.querySelector('canvas').scrollIntoView({block: 'center'})")
    find = """(() => { const c = document.querySelector('canvas'), r = c.getBoundingClientRect(),
        gl = c.getContext('webgl2'), p = new Uint8Array(4);
        for (let x = 0.3; x < 0.7; x += 0.01) {
          gl.readPixels(x * c.width, c.height / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p);
          if (p[2] < 200) return [r.x + x * r.width + 2, r.y + r.height / 2];
        } })()"""
    browser.click(*still(browser, find))
    browser.wait("document.getElementById('status').textContent.includes('kappa')")


def test_others(browser, pages):
    shown(browser, pages["failed"])
    rows = browser.run("document.querySelectorAll('table.faults tbody tr').length")
    all_of_them = int(browser.run("document.querySelector('table.faults caption').textContent").split()[-1])
    expect(f"offending triangles are listed: {rows} of {all_of_them}", 0 < rows == min(100, all_of_them))
    expect("there are more than are shown at first", all_of_them > 100)
    browser.run("document.querySelector('button[data-all]').click()")
    browser.wait(f"document.querySelectorAll('table.faults tbody tr').length === {all_of_them}")
    wrong = browser.run("""[...document.querySelectorAll('table.faults tbody tr')].map(r => r.innerHTML.trim()).filter(h => !/^<th scope="row">
        <button type="button" data-result="0" data-t="\\d+" aria-label="Show triangle \\d+">\\d+<[/]button><[/]th>
        <td class="n">0[.]\\d{4}<[/]td><td>\\S+ \\S+ \\S+<[/]td><td>kappa<[/]td>$/.test(h))""".replace("\n        ", ""))
    expect(f"all rows are alike, but {wrong[:1]}", not wrong)
    expect("the page says that the contract is missed", "is missed" in browser.run("document.body.innerText"))
    shown(browser, pages["charts"])
    browser.wait("document.querySelectorAll('canvas')[1].dataset.drawn")
    ink, _ = colors(browser, 1)
    expect(f"charts are drawn: {ink}", ink > 0.03)
    expect(f"there are no lines yet: {shares(browser)}", shares(browser)[1] == 0)
    start = views(browser)
    browser.run("document.querySelector('button[data-t]').click()")
    settled(browser)
    for before, after in zip(start, views(browser)):
        expect(f"both views come near the triangle: {before} to {after}", after[3] < 0.2 * before[3])
    shown(browser, pages["nested"])
    for i in range(10):
        t = browser.run(f"(b => (b.click(), b.dataset.t))(document.querySelectorAll('button[data-t]')[{i}])")
        settled(browser)
        browser.run("document.querySelector('canvas').scrollIntoView({block: 'center'})")
        browser.click(*still(browser, """(() => { const r = document.querySelector('canvas').getBoundingClientRect();
            return [r.x + r.width / 2, r.y + r.height / 2]; })()"""))
        browser.wait("document.getElementById('status').textContent.includes('kappa')")
        expect(f"triangle {t} is not hidden", f"triangle {t}:" in browser.run("document.getElementById('status').textContent"))
    took = shown(browser, pages["large"])
    size = os.path.getsize(pages["large"])
    print(f"100,000 triangles: {size / 1e6:.2f} MB, first picture after {took:.0f} ms")
    expect(f"100,000 triangles take {size} bytes", size <= MOST_BYTES)
    expect(f"the first picture comes after {took} ms", took < 1000 * MOST_SECONDS)
    size = os.path.getsize(pages["faulty"])
    expect(f"100,000 triangles, most of them offending, take {size} bytes", size <= 2e6)
    shown(browser, pages["two"])
    browser.run("""(() => { const s = document.querySelector('select:not(#color)');
        s.value = s.options.length - 1; s.dispatchEvent(new Event('change')); })()""")
    browser.wait("document.querySelector('canvas').getAttribute('aria-label').startsWith('large')")


def test_stages(browser, pages):
    shown(browser, pages["lines"])
    browser.wait("document.querySelectorAll('canvas')[1].dataset.drawn")
    black, orange = shares(browser)
    expect(f"lines and their points are drawn: {black}, {orange}", black > 0.02 and orange > 0.005)
    expect(f"lines are drawn in the charts: {shares(browser, 1)}", shares(browser, 1)[0] > 0.01)
    shown(browser, pages["mesh2d"])
    browser.wait("document.querySelectorAll('canvas')[1].dataset.drawn")
    label, count = browser.run("document.querySelectorAll('canvas')[1].getAttribute('aria-label')"), meshes(browser)["plane meshes"]["triangles"]
    expect(f"the plane meshes are adjacent: {label}", label.endswith(f"plane meshes: {count} triangles"))
    expect(f"they have about 3000 triangles: {count}", abs(count - 3000) < 300)
    expect(f"they are drawn, with lines: {colors(browser, 1)}, {shares(browser, 1)}",
           colors(browser, 1)[0] > 0.03 and shares(browser, 1)[0] > 0.01)
    browser.run("document.querySelector('button[data-t]').click()")
    expect("the view follows a button", settled(browser)[3] > 0)


def test_before(browser, pages):
    shown(browser, pages["good"])
    with open(os.path.join(os.path.dirname(pages["good"]), "tree.ply"), "rb") as f:
        given = int(re.search(rb"element face (\d+)", f.read(2000))[1])
    expect(f"the reference has the {given} triangles given", meshes(browser)["reference"]["triangles"] == given)
    text = browser.run("document.body.innerText")
    expect("the page says what kappa is", "Kappa measures the shape" in text and "The view leaves out" not in text)
    shown(browser, pages["beyond"])
    expect("the page says that the reference is too large", "The view leaves out" in browser.run("document.body.innerText"))
    expect("it is left out", "reference" not in meshes(browser))
    shown(browser, pages["dense"])
    browser.run("(s => (s.value = 'patch', s.dispatchEvent(new Event('change'))))(document.getElementById('color'))")
    settled(browser)
    expect(f"model edges do not hide 850 patches: {shares(browser)}", shares(browser)[0] < 0.1)


def test_accessible(browser, pages):
    """Checks what screen readers need, and all of axe where it is given."""
    for name in ("good", "failed", "charts", "mesh2d", "dense"):
        shown(browser, pages[name])
        nameless = browser.run("""[...document.querySelectorAll('img, button, select, input, canvas')].filter(e =>
            !(e.alt || e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length)).map(e => e.outerHTML)""")
        expect(f"{name}: everything has a name, but {nameless}", not nameless)
        if not os.environ.get("AXE"):
            continue
        with open(os.environ["AXE"], encoding="utf-8") as f:
            browser.run(f.read() + ";0")
        found = browser.run("""axe.run().then(r => r.violations.map(v =>
            v.impact + ': ' + v.id + ': ' + v.nodes.slice(0, 3).map(n => n.html.slice(0, 120)).join(' | ')))""")
        expect(f"{name}: axe finds nothing, but {found}", not found)


def test_without(pages):
    """Without WebGL, and without scripts."""
    browser = Browser("--disable-gpu", "--disable-3d-apis")
    browser.open(pages["good"])
    browser.wait("document.getElementById('why').textContent.includes('cannot be shown')")
    wide = browser.run("document.querySelector('#stills img').getBoundingClientRect().width")
    expect(f"without WebGL the picture is shown, {wide} wide", wide > 200)
    expect("without WebGL the viewer is not", browser.run("document.getElementById('viewer').hidden"))
    yellow = browser.run("""(async () => {
        const i = document.querySelector('#stills img'), c = document.createElement('canvas').getContext('2d');
        c.canvas.width = i.naturalWidth, c.canvas.height = i.naturalHeight;
        c.drawImage(i, 0, 0);
        const p = c.getImageData(0, 0, i.naturalWidth, i.naturalHeight).data;
        let drawn = 0, yellow = 0;
        for (let k = 0; k < p.length; k += 4) drawn += p[k + 2] < 255, yellow += p[k] > p[k + 2] + 30 && p[k + 1] > p[k + 2] + 30;
        return yellow / drawn;
    })()""")
    expect(f"its colors are the viewer's: kappa 1 is yellow, {yellow}", yellow > 0.5)
    buttons = "[...document.querySelectorAll('button[data-t]')].map(b => b.disabled)"
    expect("without WebGL the buttons are disabled", set(browser.run(buttons)) == {True})
    expect("and the page says so", "buttons" in browser.run("document.getElementById('why').textContent"))
    browser.open(pages["failed"])
    browser.wait("!document.querySelector('button[data-all]').disabled")
    browser.run("document.querySelector('button[data-all]').click()")
    browser.wait("!document.querySelector('button[data-all]')")
    expect("without WebGL all rows are shown, too, with disabled buttons", set(browser.run(buttons)) == {True})
    browser.call("Emulation.setScriptExecutionDisabled", value=True)
    browser.open(pages["good"])
    expect("without scripts the buttons are disabled", set(browser.run(buttons)) == {True})
    expect("without scripts the picture is shown", browser.run("document.querySelector('#stills img').width > 200"))
    browser.close()


def test_print(browser, pages):
    shown(browser, pages["good"])
    paper = browser.call("Page.printToPDF", printBackground=True)["data"]
    expect("the page prints", len(paper) > 20000)
    with open(pages["good"], encoding="utf-8") as f:
        text = f.read()
    expect("the page names no other file", not re.search(r"(src|href)=\"(?!data:|#)", text))


def main(bin_dir):
    if not shutil.which("chromium"):
        print("chromium is not installed: skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        pages = make(folder, os.path.abspath(bin_dir))
        browser = Browser(*GPU)
        test_view(browser, pages)
        test_others(browser, pages)
        test_stages(browser, pages)
        test_before(browser, pages)
        test_accessible(browser, pages)
        test_print(browser, pages)
        browser.close()
        test_without(pages)
    print("the page is as expected" if not faults else f"{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
