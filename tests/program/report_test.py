# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report of a study: a page that is whole, with labelled plots, and the pictures that belong to it."""
import csv
import html.parser
import json
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree

from program import BAR, ROOT, check, rows, softcell

VOID = {"meta", "img", "br"}


class Balance(html.parser.HTMLParser):
    """Tags that are open, and those that were closed out of turn."""

    def __init__(self):
        super().__init__()
        self.open, self.wrong = [], []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


def write_sweep(folder):
    """50 cases that nothing but their sweeps tell apart, of which some stop half way."""
    table = [{"case": f"{load}_{remedy}", "method": "finite cell", "degree": 1, "dofs": 375, "load_steps": 3,
              "newton_iterations": remedy, "linear_iterations": 40, "condition": 1234,
              "assembly_s": 0.001, "total_s": 0.1 + remedy,
              "converged": "false" if remedy == 7 else "true", "load_factor": 0.5 if remedy == 7 else 1,
              "cell_size": 0.1, "load": load, "remedy": f"remedy {remedy}", "failure": ""}
             for load in ("bending", "torsion") for remedy in range(25)]
    folder.mkdir()
    with open(folder / "results.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, table[0])
        writer.writeheader()
        writer.writerows(table)
    (folder / "run.json").write_text(json.dumps({"parameters": {"Sweeps/load": "", "Sweeps/remedy": ""}}))


def write_study(folder):
    """Two methods and sizes, three levels and tissues; errors fall like h^2, one case stops half way, one has no numbers."""
    table, residuals = [], {}
    for tissue in ("soft", "stiff & hard", "stiffer"):
        for k, method in enumerate(("finite cell", "weighted cell")):
            for n in (4, 8):
                for levels in (1, 2, 3):
                    name = f"{method}_n{n}_l{levels}_{tissue}".replace(" ", "_")
                    h = 0.1 / n
                    table.append({
                        "case": name, "method": method, "degree": 1, "cut_levels": levels, "dofs": 3 * n**3,
                        "load_steps": levels, "newton_iterations": 5 + k, "linear_iterations": 40,
                        "assembly_s": 1e-3 * 8**levels, "total_s": n**3 / 100, "converged": "true", "load_factor": 1,
                        "cell_size": h, "tip_ux": 0, "tip_uy": 0.05 + h, "tip_uz": 0,
                        "relative_l2_error": h**2 * (1 + k), "relative_h1_error": h * (1 + k),
                        "relative_stress_error": h * (2 + k), "tissue": tissue,
                        "observed_rate": 2 if n == 8 else ""})
                    residuals[name] = [1, 0.1, 1e-4, 1e-8]
    table[0].update(converged="false", load_factor=0.5, relative_l2_error="", relative_h1_error="",
                    failure="no step <gains> anything")
    table.append({"case": "out_of_memory", "method": "finite cell", "degree": 1, "cut_levels": 4, "tissue": "soft",
                  "converged": "false", "failure": "out of memory"})
    folder.mkdir()
    with open(folder / "results.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, table[0])
        writer.writeheader()
        writer.writerows({key: row.get(key, "") for key in table[0]} for row in table)
    (folder / "run.json").write_text(json.dumps({
        "version": "0", "commit": "abc", "written": "now", "ranks": 2, "host": "here", "command_line": "softcell < >",
        "status": "done", "parameters": {"Sweeps/tissue": "soft: | stiff & hard: | stiffer:"},
        "linear_residuals": residuals}))


def write_adaptive(folder):
    """Two sizes of a uniform grid, and as many refinements of one."""
    table = []
    for grid, dofs, steps in (("uniform 8", 100, ""), ("uniform 16", 800, ""), ("adaptive 1", 150, 1), ("adaptive 2", 200, 2)):
        table.append({"case": grid.replace(" ", "_"), "method": "finite cell", "degree": 1, "dofs": dofs, "total_s": dofs,
                      "converged": "true", "cell_size": 1, "refinement_steps": steps, "grid": grid,
                      "relative_l2_error": 1 / dofs})
    folder.mkdir()
    with open(folder / "results.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, table[0])
        writer.writeheader()
        writer.writerows(table)
    sweep = "uniform 8: | uniform 16: Discretization/Cells = 16 | adaptive 1: Discretization/Refinement steps = 1 | " \
            "adaptive 2: Discretization/Refinement steps = 2"
    (folder / "run.json").write_text(json.dumps({"parameters": {"Sweeps/grid": sweep}}))


def check_page(file, title, labels, legends=1):
    """The page is well-formed and needs nothing else; each plot has one legend and the labels are there."""
    page = file.read_text()
    balance = Balance()
    balance.feed(page)
    check(not balance.open and not balance.wrong, f"{file}: tags {balance.open} {balance.wrong}")
    check(f"<h1>{title}</h1>" in page, f"{file}: no title '{title}'")
    check(not re.search(r"<script|<link|(src|href)=.https?:", page), f"{file} asks for other files")
    plots = re.findall(r"<svg.*?</svg>", page, re.DOTALL)
    for plot in plots:
        xml.etree.ElementTree.fromstring(plot.replace("xlink:", ""))
        check(plot.count('id="legend_') == legends, f"{file}: not {legends} legend in a plot")
    texts = set(re.findall(r"<!-- (.*?) -->", "".join(plots)))  # matplotlib's, beside the glyphs
    missing = set(labels) - texts
    check(not missing, f"{file}: no label {missing} among {texts}")
    return page, plots


def report(folder):
    """Tables and plots of made up results, and everything of a small study."""
    write_study(folder / "made_up")
    (folder / "study.prm").write_text("# Bending & more.\n#\n# What it is about.\n\nsubsection Study\nend\n")
    command = ["/usr/bin/python3", str(ROOT / "scripts" / "report.py")]
    run = subprocess.run([*command, "made_up", "study.prm"], cwd=folder, capture_output=True, text=True, check=False)
    check(run.returncode == 0, f"report.py: {run.stderr}")
    page, plots = check_page(folder / "made_up" / "report.html", "Bending &amp; more", {
        "cell size h, cm", "unknowns", "time to the solution, s", "relative error in L2, %", "relative error in H1, %",
        "relative error of the stress, %",
        "cut levels", "one tangent assembly, s", "load steps", "Newton iterations", "iteration", "relative residual",
        "did not converge", "finite cell, soft, 3 levels (2.00)", "tissue: soft", "finite cell, h = 1.25 cm"})
    check(len(plots) >= 8 and "<p>What it is about.</p>" in page, f"{len(plots)} plots")
    check("<h2>Time to an error</h2>" in page, "what each method takes to an error")
    check("of which 2 did not converge" in page and "<tr class=failed>" in page, "what failed is marked")
    write_adaptive(folder / "adaptive")
    run = subprocess.run([*command, "adaptive"], cwd=folder, capture_output=True, text=True, check=False)
    check(run.returncode == 0, f"report.py: {run.stderr}")
    _, curves = check_page(folder / "adaptive" / "report.html", "adaptive", {"uniform", "adaptive", "unknowns"})
    check(not any("uniform 8" in plot or "cell size" in plot for plot in curves), "sizes are points of a curve")

    check("no step &lt;gains&gt; anything" in page and "stiff &amp; hard" in page, "texts are escaped")

    write_sweep(folder / "sweep")
    run = subprocess.run([*command, "sweep"], cwd=folder, capture_output=True, text=True, check=False)
    check(run.returncode == 0, f"report.py: {run.stderr}")
    page, plots = check_page(folder / "sweep" / "report.html", "sweep", {"load: bending", "load: torsion", "remedy 24"},
                             0)
    check(len(plots) == 2, f"bars in {len(plots)} plots")
    check(page.count("<th>condition</th>") == 2, "without errors the condition numbers are in the short table too")

    (folder / "study.prm").write_text("# A bar.\n" + BAR + """
subsection Study
  set Methods   = weighted cell, tetrahedra
  set Cells     = 3, 4
  set Reference = Discretization/Method = tetrahedra; Discretization/Degree = 2; Discretization/Mesh size = 0.05
end
""")
    status, out, error = softcell("study.prm", "--output", "study", folder=folder)
    check(status == 0, f"study: {out[-2000:]} {error}")
    draw = ["/usr/bin/python3", str(ROOT / "scripts" / "picture.py"), "--study", "study"]
    if "DISPLAY" not in os.environ and shutil.which("xvfb-run"):
        draw = ["xvfb-run", "-a", "-s", "-screen 0 1600x1000x24 -noreset", *draw]
    run = subprocess.run(draw, cwd=folder, capture_output=True, text=True, check=False)
    check(run.returncode == 0, f"picture.py: {run.stderr}")
    run = subprocess.run([*command, "study", "study.prm"], cwd=folder, capture_output=True, text=True, check=False)
    check(run.returncode == 0, f"report.py: {run.stderr}")
    page, _ = check_page(folder / "study" / "report.html", "A bar",
                         {"cell size h, cm", "reference", "relative residual"})
    names = [row["case"] for row in rows(folder / "study" / "results.csv")]
    check(page.count("data:image/png;base64") == 1 + len(names), "a picture for each case, and their scale")
