# SPDX-License-Identifier: Apache-2.0
"""Repeats the measurements of "Spectral animation compression" (Wang et al., JCST 30(3), 2015) with the method as
published (bench/peers/sac2015.cpp), and writes a page of docs/paper for each of the paper's figures.

DATA holds NAME.obj (the first frame with its triangles) and NAME.pc2; models that are not there are left out. What was
measured stays in the work directory, so that a second run measures only what is new: another program, clip or setting.
"""
import argparse
import os

import bytes_beside
import kinds
import models
import switches
from measure import Laboratory
from page import Page

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))

PAGES = [
    ("table-1", "Table 1: time of each step", models.table_1),
    ("figure-3", "Figure 3: quantized values", models.figure_3),
    ("figure-5", "Figure 5: polar decomposition", switches.figure_5),
    ("figure-6", "Figure 6: rate and distortion of all models", models.figure_6),
    ("figure-7", "Figure 7: a rigid vase", kinds.figure_7),
    ("figure-8", "Figure 8: cloth beside trajectory PCA", kinds.figure_8),
    ("figure-9", "Figure 9: arithmetic coding", switches.figure_9),
    ("figure-10", "Figure 10: bits of a coefficient", switches.figure_10),
    ("bytes", "Bytes beside `sac`", bytes_beside.bytes_beside),
]


def main():
    p = argparse.ArgumentParser(
        prog="bench/paper", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    p.add_argument("--data", required=True, metavar="DIRECTORY", help="of the sequences")
    p.add_argument(
        "--sac", default=os.path.join(ROOT, "build/release/cli/sac"), help="the command [that of the release build]"
    )
    p.add_argument("--peers", help="directory of the programs sac-peer-NAME [that of sac's build]")
    p.add_argument("--output", default=os.path.join(ROOT, "docs/paper"), help="[docs/paper]")
    p.add_argument("--work", default=os.path.join(ROOT, "build/paper"), help="keeps what was measured and the pictures [build/paper]")
    p.add_argument(
        "--only", nargs="+", choices=[name for name, _, _ in PAGES], metavar="PAGE", help="some of: %(choices)s"
    )
    args = p.parse_args()
    peers = args.peers or os.path.join(os.path.dirname(args.sac), "../bench/peers")
    for program in (args.sac, os.path.join(peers, "sac-peer-sac2015"), os.path.join(peers, "sac-peer-pca")):
        if not os.access(program, os.X_OK):
            p.error(f"{program} is not there, or no program")
    lab = Laboratory(args.data, args.sac, peers, args.work)
    pictures = os.path.join(args.work, "pictures")
    for directory in (args.output, pictures):
        os.makedirs(directory, exist_ok=True)
    pages = []
    for name, title, body in PAGES:
        if args.only and name not in args.only:
            continue
        page = Page(args.output, pictures, name, title)
        body(lab, page)
        if page.verdict:
            page.write()
            pages.append(page)
    if not args.only:
        write_index(args.output, pages)


def write_index(directory, pages):
    with open(os.path.join(HERE, "index.md")) as f:
        text = f.read()
    rows = "\n".join(f"| [{page.title}]({page.name}.md) | {page.verdict} |" for page in pages)
    with open(os.path.join(directory, "README.md"), "w") as f:
        f.write(text.replace("PAGES", rows))


if __name__ == "__main__":
    main()
