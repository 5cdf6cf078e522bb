#!/usr/bin/python3
"""The files that settled.sh needs beside its programs, and its sums.

    settled.py loose > CSV            8768 spheres above each other, nowhere touching, as a tremie packing
    settled.py export CHECKPOINT CSV DATA   their places as a tremie packing and as LIGGGHTS data
    settled.py tremie RUN             of a measured run: steps, wall time, energy, contacts, phases
    settled.py liggghts OUTPUT        the same from what LIGGGHTS printed (no phases)
    settled.py summary CSV            rates and ratios with their spread; fails where states differ
"""
import csv
import glob
import os
import random
import statistics
import sys

import h5py

N_SPHERES, RADIUS, DENSITY = 8768, 0.1, 2367.0
WIDTH, A_SIDE = 5.3, 22  # of the box [m]; spheres along a side of a loose layer
MASS = DENSITY * 4 / 3 * 3.141592653589793 * RADIUS**3  # of a sphere [kg]
PHASES = ("pairs", "facets", "integrate", "search")
OTHERS = ("bodies", "halo", "watch", "redistribute")
# Two codes are in the same state when their numbers of contacts agree so far, and at rest when spheres
# move less than this on average (root mean square; a bed without rolling resistance never quite stops).
CONTACTS_APART, SPEED_AT_REST = 0.03, 0.03


def loose():
    """A lattice, shaken so that what falls together is disordered."""
    random.seed(1)
    spacing = WIDTH / A_SIDE
    shake = spacing / 2 - 1.001 * RADIUS
    print("x_m,y_m,z_m")
    for k in range(N_SPHERES):
        cell = (k % A_SIDE, k // A_SIDE % A_SIDE, k // A_SIDE**2)
        x, y, z = ((c + 0.5) * spacing + random.uniform(-shake, shake) for c in cell)
        print(f"{x - WIDTH / 2:.6f},{y - WIDTH / 2:.6f},{z:.6f}")


def export(checkpoint, packing, data):
    with h5py.File(checkpoint) as file:
        places = file["spheres/position"][()].tolist()
    with open(packing, "w") as out:
        out.write("x_m,y_m,z_m\n")
        out.writelines("%.17g,%.17g,%.17g\n" % tuple(place) for place in places)
    edge = WIDTH / 2 + 0.05
    with open(data, "w") as out:
        out.write(f"settled bed\n\n{len(places)} atoms\n1 atom types\n\n")
        out.write(f"{-edge} {edge} xlo xhi\n{-edge} {edge} ylo yhi\n-0.05 5 zlo zhi\n\nAtoms\n\n")
        for k, place in enumerate(places):
            out.write("%d 1 %g %g %.17g %.17g %.17g\n" % (k + 1, 2 * RADIUS, DENSITY, *place))


def table(run, name):
    columns = {}
    for path in sorted(glob.glob(os.path.join(run, "series", "step_*.h5"))):
        with h5py.File(path) as file:
            for column, data in file[name].items():
                columns.setdefault(column, []).extend(data[()].tolist())
    return columns


def tremie(run):
    """Steps, wall time [s], energy [J], contacts, ns a particle-step by phase.  Rows in which nothing
    moves tell of the start and the last checkpoint."""
    series, runtime = table(run, "series"), table(run, "runtime")
    rows = [k for k, n in enumerate(runtime["particle_steps"]) if n > 0]
    steps = sum(runtime["steps"][k] for k in rows)
    work = sum(runtime["particle_steps"][k] for k in rows)
    wall = sum(runtime["wall"][k] for k in rows)

    def cost(names):
        return sum(runtime[f"{name}.mean"][k] for name in names for k in rows) / work * 1e9

    phases = [cost((name,)) for name in PHASES] + [cost(OTHERS)]
    energy = series["kinetic_translation"][-1] + series["kinetic_rotation"][-1]
    contacts = series["n_contacts"][-1]
    print("%d,%.4f,%.4g,%d," % (steps, wall, energy, contacts) + ",".join("%.2f" % p for p in phases))


def liggghts(output):
    lines = [line.split() for line in open(output, errors="replace")]
    loop = next(line for line in lines if line[:2] == ["Loop", "time"])
    translation, rotation, contacts = (float(x) for x in lines[lines.index(loop) - 1][1:4])
    print("%s,%s,%.4g,%d,,,,," % (loop[8], loop[3], translation + rotation, contacts / 2))


def spread(values):
    return "%.2f (%.2f to %.2f)" % (statistics.median(values), min(values), max(values))


def print_rates(rows, codes):
    print("\nMillion particle-steps/s, median (least to largest)")
    print("  %-22s %-26s %s" % ("", "by user CPU time", "by wall clock"))
    for code in codes:
        rates = [[float(r[f"rate_{kind}"]) for r in rows if r["code"] == code] for kind in ("user", "wall")]
        print("  %-22s %-26s %s" % (code, spread(rates[0]), spread(rates[1])))


def print_phases(rows, codes):
    print("\nNanoseconds of wall clock a particle-step, median")
    print("  %-22s" % "" + "".join("%12s" % name for name in (*PHASES, "others")))
    for code in codes:
        own = [r for r in rows if r["code"] == code and r["pairs_ns"] != ""]
        if own:
            costs = (statistics.median(float(r[f"{n}_ns"]) for r in own) for n in (*PHASES, "others"))
            print("  %-22s" % code + "".join("%12.2f" % cost for cost in costs))


def print_ratios(rows, codes):
    by_round = {}
    for r in rows:
        by_round.setdefault(r["round"], {})[r["code"]] = r
    print("\nRatio to LIGGGHTS in the same round")
    for code in codes:
        for kind in ("user", "wall") if code != "liggghts" else ():
            ratios = [float(r[code][f"rate_{kind}"]) / float(r["liggghts"][f"rate_{kind}"]) for r in by_round.values()]
            print("  %-22s by %s: %s" % (code, kind, spread(ratios)))


def states_agree(rows, codes):
    """Says how the beds are when the runs end."""
    print("\nThe bed when the runs end")
    agree, counts = True, []
    for code in codes:
        last = [r for r in rows if r["code"] == code][-1]
        energy, contacts = float(last["kinetic_J"]), int(last["contacts"])
        speed = (2 * energy / (N_SPHERES * MASS)) ** 0.5
        print("  %-22s kinetic energy %.3g J (%.1f mm/s), %d contacts, %.2f a sphere"
              % (code, energy, 1e3 * speed, contacts, 2 * contacts / N_SPHERES))
        agree = agree and speed < SPEED_AT_REST
        counts.append(contacts)
    apart = max(counts) / min(counts) - 1
    agree = agree and apart < CONTACTS_APART
    print("  contacts differ by %.2g %%: %s" % (100 * apart, "at rest and alike" if agree else "NOT at rest or not alike"))
    return agree


def summary(path):
    rows = list(csv.DictReader(open(path)))
    codes = list(dict.fromkeys(r["code"] for r in rows))
    print_rates(rows, codes)
    print_phases(rows, codes)
    if "liggghts" in codes:
        print_ratios(rows, codes)
    return 0 if states_agree(rows, codes) else 1


if __name__ == "__main__":
    commands = {"loose": loose, "export": export, "tremie": tremie, "liggghts": liggghts, "summary": summary}
    if len(sys.argv) < 2 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    sys.exit(commands[sys.argv[1]](*sys.argv[2:]))
