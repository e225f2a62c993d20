# SPDX-License-Identifier: Apache-2.0
"""Compares the bytes of the published method, at its own operating points, with those of sac at the same errors."""
from page import g

CLAIMED, FEWER = (12, 14, 16, 18), (8, 10)
BITS = FEWER + CLAIMED


def bytes_beside(lab, page):
    rows, ours = {}, {}
    for name in ("dance", "horse_collapse", "jump"):
        clip = lab.clip(name)
        if not clip:
            continue
        rows[name] = {b: lab.peer("sac2015", clip, f"100/{b}") for b in BITS}
        for bits in (FEWER, CLAIMED):  # one stream that is no worse than any of these points
            least = [min(rows[name][b][e] for b in bits) for e in ("kg", "sted")]
            ours[name, bits] = lab.sac(clip, "--target-kg", repr(least[0]), "--target-sted", repr(least[1]))
    if not rows:
        return
    beside = lambda n, b: ours[n, CLAIMED if b in CLAIMED else FEWER]
    after = lambda r: r["bytes"] - r["said"]["i_frame"]
    points = [(n, b) for n in rows for b in BITS]
    ratio = {(n, b): (rows[n][b]["bytes"] - rows[n][b]["i_frame"]) / after(beside(n, b)) for n, b in points}
    whole = {(n, b): rows[n][b]["bytes"] / beside(n, b)["bytes"] for n, b in points}
    no_worse = all(beside(n, b)[e] <= rows[n][b][e] for n, b in points for e in ("kg", "sted"))
    page.claim(
        "ours, not the paper's: against the published method at its own operating points (100 harmonics, 12 to 18 "
        "bits) on dance, horse_collapse and jump, `sac` takes at least 15 times fewer bytes after the first frame at "
        "no worse KG and "
        "STED.",
        [
            ("KG and STED of the decoded files are no worse", no_worse, "on all clips, against all numbers of bits"),
            *(
                (
                    f"15 times fewer bytes on {n}",
                    all(ratio[n, b] >= 15 for b in CLAIMED),
                    f"{g(min(ratio[n, b] for b in CLAIMED), 3)} to {g(max(ratio[n, b] for b in CLAIMED), 3)} times; "
                    "whole files "
                    f"{g(min(whole[n, b] for b in CLAIMED), 3)} to {g(max(whole[n, b] for b in CLAIMED), 3)} times",
                )
                for n in rows
            ),
        ],
    )
    page.text(
        """
The first frame of the published method is lossless (each coordinate as the difference of floats to the vertex
before), that of `sac` is as near as the errors ask for: that is why whole files are closer to each other than
what follows. With 8 and 10 bits, which the claim leaves out, the published method is smaller at much the same
error (figure 10); those rows stand below too. `sac` is encoded with `--target-kg` and `--target-sted` at the
least of both over 12 to 18 bits, and again over 8 and 10, decoded from its file, and measured by the same
program as the other; the search looks for the smallest file, not for the fewest bytes after its first frame."""
    )
    page.heading("Bytes")
    page.table(
        [
            "clip",
            "bits",
            "connectivity",
            "first frame",
            "centres",
            "counts",
            "coefficients",
            "all",
            "after the first frame",
            "KG, %",
            "STED",
            "times sac after the first frame",
            "times sac, whole file",
        ],
        [
            [
                n if b == BITS[0] else "",
                b,
                *(
                    r["encode"]["bytes"][p]
                    for p in ("connectivity", "first_frame", "centres", "counts", "coefficients")
                ),
                r["bytes"],
                r["bytes"] - r["i_frame"],
                g(r["kg"], 5),
                g(r["sted"]),
                g(ratio[n, b], 3),
                g(whole[n, b], 3),
            ]
            for n, points in rows.items()
            for b, r in points.items()
        ],
    )
    page.text(
        'A header of 76 or 77 bytes is in "all" and in "after the first frame". Of `sac`, all but the I-frame '
        "counts as after it:"
    )
    page.table(
        [
            "clip",
            "beside",
            "header",
            "I-frame",
            "motion",
            "displacement",
            "side",
            "all",
            "after the first frame",
            "KG, %",
            "STED",
            "found",
        ],
        [
            [
                n,
                f"{bits[0]} to {bits[-1]} bits",
                *(r["said"][p] for p in ("header", "i_frame", "motion", "displacement", "side")),
                r["bytes"],
                after(r),
                g(r["kg"], 5),
                g(r["sted"]),
                "{harmonics} harmonics, motion step {motion_step:.4g}, displacement step {displacement_step:.4g}, "
                "{position_bits} "
                "position bits".format(**r["said"]["settings"]),
            ]
            for (n, bits), r in ours.items()
        ],
        "ll" + "r" * 9 + "l",
    )
