#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What nvcc says of the kernels, and what follows from it for two graphics cards: the tables of doc/gpu.md.

usage: gpu_roofline.py [--nvcc NVCC] [--check]

Compiles source/*/*.cu for the cards' architectures. With --check it only looks, for all architectures that CMakeLists.txt
names, whether a kernel spills registers or keeps arrays in local memory, and fails if one does.
"""
import argparse
import collections
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
OPTIONS = ["-std=c++17", "-O3", "--expt-relaxed-constexpr", "-diag-suppress", "1675", f"-I{ROOT / 'include'}"]

# Published: NVIDIA, H100 Tensor Core GPU data sheet (SXM, vector units); NVIDIA, Ada GPU architecture white paper (RTX
# 4090; double precision at 1/64). Limits of a multiprocessor: NVIDIA, CUDA C++ programming guide, compute capabilities.
Card = collections.namedtuple("Card", "name arch bandwidth float double warps blocks shared")
CARDS = (Card("H100", "sm_90", 3.35e12, 67e12, 34e12, 64, 32, 228 * 1024),
         Card("RTX 4090", "sm_89", 1.008e12, 82.6e12, 82.6e12 / 64, 48, 24, 100 * 1024))
REGISTERS = 65536     # of a multiprocessor
REGISTER_UNIT = 256   # what a warp gets is a multiple of it
WARP_UNIT = 4         # and warps that have registers come in fours
RESERVED = 1024       # bytes of shared memory that the system takes for each block

Kernel = collections.namedtuple("Kernel", "name threads registers shared local instructions operations")


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    return done


def kernels(nvcc, arch, source):
    """What the compiler says of the kernels of a source."""
    with tempfile.TemporaryDirectory() as folder:
        ptx = f"{folder}/kernels.ptx"
        run(nvcc, *OPTIONS, f"-arch={arch}", "-ptx", str(source), "-o", ptx)
        told = run(str(pathlib.Path(nvcc).parent / "ptxas"), "-v", f"-arch={arch}", ptx, "-o", f"{folder}/out").stderr
        codes = {re.match(r"\w+", code)[0]: code for code in pathlib.Path(ptx).read_text().split(".entry ")[1:]}
    for part in told.split("Compiling entry function '")[1:]:
        symbol = re.match(r"\w+", part)[0]
        code = codes[symbol]
        shared = re.search(r"(\d+) bytes smem", part)
        # spills and arrays
        local = sum(map(int, re.search(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads",
                                       part).groups()))
        fused = len(re.findall(r"\bfma\.rn\.f\d", code))
        single = len(re.findall(r"\b(?:add|sub|mul|div|rcp)(?:\.rn|\.approx)?(?:\.ftz)?\.f\d", code))
        yield Kernel(readable(symbol), int(re.search(r"\.maxntid (\d+)", code)[1]),
                     int(re.search(r"Used (\d+) registers", part)[1]), int(shared[1]) if shared else 0, local,
                     fused + single, 2 * fused + single)


def readable(symbol):
    """`double NeoHookean TangentAction` for a BrickKernel of that action."""
    text = run("c++filt", symbol).stdout.split("(")[0]
    words = [word for word in re.findall(r"[A-Za-z]\w*", text) if word not in (
        "void", "softcell", "run_kernel", "BrickKernel", "PointKernel", "EntryKernel", "SumKernel")]
    return " ".join(dict.fromkeys(sorted(words, key=lambda word: word not in ("double", "float"))))


def occupancy(kernel, card):
    """Blocks that a multiprocessor runs at once, and the share of its warps that they are."""
    warps = kernel.threads // 32
    of_a_warp = math.ceil(kernel.registers * 32 / REGISTER_UNIT) * REGISTER_UNIT
    blocks = min(REGISTERS // of_a_warp // WARP_UNIT * WARP_UNIT // warps, card.blocks, card.warps // warps,
                 card.shared // (kernel.shared + RESERVED))
    return blocks, blocks * warps / card.warps


def bytes_of_bricks(size, needs_state, keeps_pressure):
    """Per unknown of a tangent action where all cells are full (three unknowns a cell): u, x and y; the sums of bricks,
    written and read (225 nodes for 128 cells); what is kept at a cell's eight points."""
    return size * ((3 if needs_state else 2) + 2 * 225 / 128 + (8 / 3 if keeps_pressure else 0))


def bytes_of_iteration(size):
    """Per unknown of an iteration of conjugate gradients with the inverted diagonal, beside its tangent action: inverse
    and r read, z written; r and z; z and p, and this written; p and Ap; p, Ap, x and r, and the last two written."""
    return size * (3 + 2 + 3 + 2 + 6)


def bytes_of_rows(size, points, nodes):
    """Per unknown of a tangent action by rows, if every stress is read from memory once: per point its weight, pressure,
    F, the stress (written, read); twice per entry of a row its number and gradient. `points` per node of the grid, with
    rows of `nodes`."""
    return (points * (29 * size + 2 * nodes * (4 + 3 * size)) / 3) + 2 * size


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--nvcc", default="/usr/local/cuda/bin/nvcc")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    named = re.search(r"SOFTCELL_CUDA_ARCHITECTURES (.*?) CACHE", (ROOT / "CMakeLists.txt").read_text())[1]
    architectures = [f"sm_{number}" for number in re.findall(r"\d+", named)] if arguments.check else [c.arch for c in CARDS]
    by_arch = {arch: [k for source in sorted(ROOT.glob("source/*/*.cu")) for k in kernels(arguments.nvcc, arch, source)]
               for arch in architectures}
    bad = [f"{arch}: {k.name} has {k.local} bytes of spills and local arrays" for arch, own in by_arch.items()
           for k in own if k.local]
    if bad or not all(by_arch.values()):
        sys.exit("\n".join(bad) or "There are no kernels.")
    if arguments.check:
        print(f"{len(by_arch[architectures[0]])} kernels without spills and local arrays for {', '.join(architectures)}")
        return
    found = {card: by_arch[card.arch] for card in CARDS}

    print("| kernel | threads | shared memory, byte |" + "".join(
        f" {card.name}: registers | blocks | occupancy, % |" for card in CARDS) + "\n|---|---|---|" + "---|---|---|" * 2)
    for same in zip(*(sorted(own) for own in found.values())):
        print(f"| {same[0].name} | {same[0].threads} | {same[0].shared} |", end="")
        for card, k in zip(CARDS, same):
            blocks, share = occupancy(k, card)
            print(f" {k.registers} | {blocks} | {100 * share:.0f} |", end="")
        print()
    print("\n| | operations | byte | operations a byte |" + "".join(
        f" {card.name}: by operations | by memory |" for card in CARDS) + "\n|---|---|---|---|" + "---|---|" * 2)
    for k in sorted(found[CARDS[0]]):
        if "TangentAction" not in k.name.split():
            continue
        real = k.name.split()[0]
        size = {"double": 8, "float": 4}[real]
        action = bytes_of_bricks(size, "LinearElastic" not in k.name, "NeoHookean" in k.name)
        for name, traffic in ((k.name, action), (f"{k.name}, iteration", action + bytes_of_iteration(size))):
            print(f"| {name} | {k.operations / 3:.0f} | {traffic:.0f} | {k.operations / 3 / traffic:.1f} |", end="")
            for card in CARDS:
                by_operations = getattr(card, real) / 2 / (k.instructions / 3)  # a fused instruction counts as two
                print(f" {by_operations / 1e9:.1f} | {card.bandwidth / traffic / 1e9:.1f} |", end="")
            print()
    print("\n| rows of | byte, double | byte, float |" + "".join(f" {card.name}: double | float |" for card in CARDS)
          + "\n|---|---|---|" + "---|---|" * 2)
    for name, points, nodes in (("weighted cells", 8, 8), ("linear tetrahedra", 6, 4)):
        traffic = [bytes_of_rows(size, points, nodes) for size in (8, 4)]
        print(f"| {name} | {traffic[0]:.0f} | {traffic[1]:.0f} |" + "".join(
            f" {card.bandwidth / t / 1e9:.2f} |" for card in CARDS for t in traffic))


main()
