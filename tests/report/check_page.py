#!/usr/bin/python3
"""Opens report pages in a headless Chromium, turns the 3-D view, and clicks its legend.

    check_page.py PROGRAM CASES WORK_FOLDER BUNDLE

BUNDLE is the script of the 3-D view; where the build left none, the pages must say that they have no such view.
The pages are those of `fppg compare`, `fppg batch` and `fppg report` of a small case. None may ask the network for
anything or log an error or a warning. Ends with 77 where there is no Chromium.
"""

import os
import shutil
import subprocess
import sys

import browser


def run(program, work, *arguments, codes=(0,)):
    done = subprocess.run([program, *arguments], cwd=work, check=False, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    assert done.returncode in codes, f"{arguments} ended with {done.returncode}:\n{done.stdout}"
    return done.stdout


def check_view(page, work, name):
    canvas = "#fppg-view .canvas"
    page.open(os.path.join(work, name + ".html"))
    page.drawn()
    assert page.box("#fppg-view canvas"), page.evaluate("document.getElementById('fppg-view').textContent")
    before = page.picture(canvas, os.path.join(work, name + "_view.png"))
    assert page.picture(canvas) == before, f"{name}: the view changes by itself"

    page.drag(canvas, 150, 60)
    turned = page.picture(canvas, os.path.join(work, name + "_turned.png"))
    assert turned != before, f"{name}: dragging does not turn the view"

    page.click("#fppg-view .legend button")
    hidden = page.picture(canvas, os.path.join(work, name + "_hidden.png"))
    assert hidden != turned, f"{name}: the legend does not hide an mk"
    assert page.evaluate("document.querySelector('#fppg-view .legend button').ariaPressed") == "false"
    page.click("#fppg-view .legend button")
    assert page.picture(canvas) == turned, f"{name}: the legend does not show an mk again"

    page.evaluate("""(() => { const s = document.querySelector('#fppg-view input[type=range]');
        s.value = 0.5; s.dispatchEvent(new Event('input')); })()""")
    page.drawn()
    assert page.picture(canvas, os.path.join(work, name + "_cut.png")) != turned, f"{name}: the cut cuts nothing"


def check_choice(page, work, name):
    """Another view by the list, and by the picture of a run."""
    canvas = "#fppg-view .canvas"
    page.open(os.path.join(work, name + ".html"))
    page.drawn()
    first = page.picture(canvas)
    page.evaluate("""(() => { const s = document.querySelector('#fppg-view .bar select');
        s.value = '1'; s.dispatchEvent(new Event('change')); })()""")
    page.drawn()
    second = page.picture(canvas, os.path.join(work, name + "_second.png"))
    assert second != first, f"{name}: the list does not change what is shown"
    if page.box("[data-view='0']"):
        page.click("[data-view='0']")
        assert page.picture(canvas) == first, f"{name}: a picture does not show its run"


def check_motion(page, work, name):
    """The slider of time moves the parts that move, and takes them back."""
    canvas = "#fppg-view .canvas"
    page.open(os.path.join(work, name + ".html"))
    page.drawn()
    start = page.picture(canvas, os.path.join(work, name + "_start.png"))
    pictures = []
    for time in (0.1, 0):
        page.evaluate("""(() => { const s = document.querySelector('[aria-label="time of the motion"]');
            s.value = %g; s.dispatchEvent(new Event('input')); })()""" % time)
        page.drawn()
        pictures.append(page.picture(canvas, os.path.join(work, f"{name}_at_{time:g}.png")))
    assert pictures[0] != start, f"{name}: the slider of time moves nothing"
    assert pictures[1] == start, f"{name}: the slider of time does not go back to the start"


def main(program, cases, work, bundle):
    chromium = browser.find()
    if not chromium:
        print("there is no chromium to look at the pages with")
        return 77
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    for case in ("dambreak", "dambreak2d", "gear"):
        shutil.copytree(os.path.join(cases, case), os.path.join(work, case))
    for dp in ("0.03", "0.035"):
        run(program, work, "dambreak/CaseDambreak_Def", f"out{dp}/Case", f"-dp:{dp}")
    run(program, work, "compare", "out0.03/Case", "out0.035/Case", "--html", "compare.html", codes=(1,))
    run(program, work, "batch", "dambreak", "--set", "Dp=0.03,0.04", "--out", "batch")
    shutil.copy(os.path.join(work, "batch/report.html"), os.path.join(work, "batch.html"))
    run(program, work, "report", "out0.03/Case", "--definition", "dambreak/CaseDambreak_Def", "--", "-dp:0.03")
    run(program, work, "gear/CaseGear_Def", "gear/Case", "-dp:0.02", "-fit:off")
    run(program, work, "report", "gear/Case", "-o", "motion.html")
    pages = ("compare", "batch", "report")
    with browser.Browser(chromium) as page:
        for name in pages:
            page.open(os.path.join(work, name + ".html"))
            page.picture(path=os.path.join(work, name + "_page.png"))
        if os.path.exists(bundle):
            for name in pages:
                check_view(page, work, name)
            for name in pages[:2]:
                check_choice(page, work, name)
            check_motion(page, work, "motion")
        else:
            assert "no 3-D view" in page.evaluate("document.body.textContent")
        assert not page.errors, "\n".join(page.errors)
        outside = [url for url in page.requests if not url.startswith(("file:", "data:", "blob:"))]
        assert not outside, outside
    return 0


if __name__ == "__main__":
    sys.exit(main(*(os.path.abspath(a) for a in sys.argv[1:5])))
