#!/usr/bin/env python3
"""Runs charts/hopper_small.yaml for several steps, moduli and seeds, and sums up what comes out.

    charts/hopper.py BIN WORK OUT [SEEDS=5]

BIN has the programs, WORK takes the runs, OUT the tables: hopper_runs.csv, a line a run, and hopper.csv, a
line a case, with means over the seeds and their 95 % confidence intervals.  Runs have one rank each, two at
a time where there are two cores.  What a run costs is its user CPU time, which other work on the machine
disturbs least, over that of the stiffest case with the same seed.
"""
import csv
import math
import os
import subprocess
import sys
import threading

HERE = os.path.dirname(os.path.abspath(__file__))
STIFF = 1e9  # Young's modulus that softer ones are compared with [Pa]
FINE = 0.02  # share of the Rayleigh step that coarser ones are compared with
SOFT = 1e7   # the modulus at which steps are compared [Pa]
CASES = [(STIFF, 0.15), (STIFF, 0.3), (1e8, 0.1), (1e8, 0.3)] \
    + [(SOFT, share) for share in (FINE, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0)] \
    + [(1e6, 0.1), (1e6, 0.3)]
# Student's t, two-sided 95 %, by degrees of freedom.
T95 = [math.nan, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262]
DENSITY, POISSON, RADIUS_LEAST, END = 2500.0, 0.2, 0.0045, 1.3  # as in the job


def rayleigh(young):
    """Critical step (6.1) of the least sphere [s]."""
    shear = young / (2 * (1 + POISSON))
    return math.pi * RADIUS_LEAST * math.sqrt(DENSITY / shear) / (0.1631 * POISSON + 0.8766)


def write_spheres(path, seed):
    """A lattice of 16 x 16 x 8 with jitter; radii evenly from 4.5 to 5.5 mm."""
    state = seed

    def noise():
        nonlocal state
        state = state * 16807 % 2147483647
        return state / 2147483647 - 0.5

    for _ in range(20):
        noise()
    with open(path, "w") as out:
        out.write("x_m,y_m,z_m,radius_m\n")
        for k in range(2048):
            place = [(k % 16 - 7.5) * 0.012, (k // 16 % 16 - 7.5) * 0.012, 0.25 + k // 256 * 0.012]
            x, y, z = (p + 0.0009 * noise() for p in place)
            out.write(f"{x:.9f},{y:.9f},{z:.9f},{0.005 + 0.001 * noise():.9f}\n")


def tool(path, *arguments):
    return subprocess.run([path, *arguments], check=True, capture_output=True, text=True).stdout


def discharge_rate(path):
    """Mass per second while the discharged share goes from .15 to .75 [kg/s]."""
    with open(path) as table:
        rows = [(float(r["time_s"]), float(r["outlet.net_mass_kg"])) for r in csv.DictReader(table)]
    total = 2048 * DENSITY * 4 / 3 * math.pi * (0.005 ** 3 + 0.005 * 0.001 ** 2 / 4)

    def time_of(mass):
        for (t0, m0), (t1, m1) in zip(rows, rows[1:]):
            if m1 >= mass:
                return t0 + (t1 - t0) * (mass - m0) / (m1 - m0)
        return math.nan

    return 0.6 * total / (time_of(0.75 * total) - time_of(0.15 * total))


def run(programs, work, case, seed):
    """One run: what it gave, or why it ended early."""
    young, share = case
    out = f"{work}/run_{young:.0e}_{share}_{seed}"
    step = float(f"{share * rayleigh(young):.6g}")
    end = step * round(END / step)
    said = open(out + ".said", "w")
    process = subprocess.Popen(
        [f"{programs}/tremie", "run", f"{HERE}/hopper_small.yaml", "--out", out, "--fresh",
         "--set", f"spheres.0.packing.file={work}/grain_{seed}.csv", "--set", f"time.step={step:.9g}", "--set", f"time.end={end:.12g}",
         "--set", f"materials.grain.young={young:g}", "--set", f"materials.wall.young={young:g}"],
        stdout=said, stderr=said, stdin=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    said.close()
    row = {"young_Pa": f"{young:g}", "step_share": share, "seed": seed, "step_s": f"{step:.6g}",
           "user_s": round(usage.ru_utime, 3), "failure": ""}
    if process.returncode != 0:
        with open(out + ".said") as text:
            errors = [line for line in text if line.startswith("error: ")]
        row["failure"] = errors[0][len("error: "):].split(" at step")[0].strip() if errors \
            else f"status {process.returncode}"
        return row
    tool(f"{programs}/tremie-discharge", out, "--csv", out + ".csv")
    last = {}
    for line in tool(f"{programs}/tremie-info", out).splitlines():
        words = line.split()
        if len(words) >= 2 and line.startswith("  "):
            last[words[0]] = words[1]
    value = {name: float(last[name]) for name in last if name in (
        "kinetic_translation", "kinetic_rotation", "potential", "elastic", "dissipated_friction",
        "dissipated_damping", "dissipated_tangential", "balance")}
    with open(out + ".said") as text:
        overlap = [line.split("largest overlap ")[1].split()[0] for line in text if "largest overlap " in line]
    row["rate_kg_s"] = f"{discharge_rate(out + '.csv'):.6g}"
    row["energy_J"] = f"{sum(value[n] for n in ('kinetic_translation', 'kinetic_rotation', 'potential', 'elastic')):.8g}"
    row["balance"] = f"{value['balance'] / sum(v for n, v in value.items() if n.startswith('dissipated')):.6g}"
    row["overlap"] = overlap[-1]
    return row


def run_all(programs, work, seeds):
    """All runs, the longest first, as many at once as there are cores, two at most."""
    jobs = [(case, seed) for case in sorted(CASES, key=lambda c: c[1] * rayleigh(c[0])) for seed in seeds]
    rows, lock = [], threading.Lock()

    def work_off():
        while True:
            with lock:
                if not jobs:
                    return
                case, seed = jobs.pop(0)
            row = run(programs, work, case, seed)
            with lock:
                rows.append(row)
                print(f"hopper: E {row['young_Pa']} Pa, {row['step_share']} of the Rayleigh step, seed {seed}: "
                      f"{row['user_s']} s {row['failure']}", flush=True)

    threads = [threading.Thread(target=work_off) for _ in range(min(2, os.cpu_count()))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return sorted(rows, key=lambda r: (-float(r["young_Pa"]), r["step_share"], r["seed"]))


def mean_and_half_width(values):
    """Mean and half the width of its 95 % interval."""
    n = len(values)
    mean = sum(values) / n
    spread = math.sqrt(sum((v - mean) ** 2 for v in values) / (n - 1)) if n > 1 else math.nan
    return mean, T95[n - 1] * spread / math.sqrt(n)


def compare(rows, reference, name):
    """Differences from the reference with the same seed, relative [%]: mean and half-width."""
    base = {r["seed"]: float(r[name]) for r in reference}
    return mean_and_half_width([100 * (float(r[name]) / base[r["seed"]] - 1) for r in rows])


def sum_up(rows):
    """A line a case, then the frontiers: least time for an error."""
    def of(young, share):
        return [r for r in rows if float(r["young_Pa"]) == young and r["step_share"] == share]

    stiff, fine = of(STIFF, 0.15), of(SOFT, FINE)
    lines = []
    for young, share in CASES:
        case = of(young, share)
        line = {"young_Pa": f"{young:g}", "softened": f"{STIFF / young:g}", "step_share": share, "n": len(case),
                "failure": "; ".join(sorted({r["failure"] for r in case} - {""}))}
        lines.append(line)
        if any(r["failure"] for r in case):
            continue
        base = {r["seed"]: r["user_s"] for r in stiff}
        line["cost"], line["cost_ci"] = mean_and_half_width([r["user_s"] / base[r["seed"]] for r in case])
        line["user_s"] = sum(r["user_s"] for r in case) / len(case)
        line["rate_kg_s"], line["rate_ci_kg_s"] = mean_and_half_width([float(r["rate_kg_s"]) for r in case])
        line["rate_pc"], line["rate_ci_pc"] = compare(case, stiff, "rate_kg_s")
        line["energy_pc"], line["energy_ci_pc"] = compare(case, stiff, "energy_J")
        if young == SOFT:
            line["rate_step_pc"], line["rate_step_ci_pc"] = compare(case, fine, "rate_kg_s")
            line["energy_step_pc"], line["energy_step_ci_pc"] = compare(case, fine, "energy_J")
        balance, half = mean_and_half_width([100 * abs(float(r["balance"])) for r in case])
        line["balance_pc"], line["balance_ci_pc"] = balance, half
        line["overlap_pc"] = 100 * max(float(r["overlap"]) for r in case)
        for name in ("rate_step", "energy_step", "rate", "energy"):
            if name + "_pc" in line:
                line[name + "_low_pc"] = line[name + "_pc"] - line[name + "_ci_pc"]
                line[name + "_high_pc"] = line[name + "_pc"] + line[name + "_ci_pc"]
        if (young, share) != (STIFF, 0.15):  # an error no larger than this, with 97.5 % confidence
            line["bound_pc"] = abs(line["rate_pc"]) + line["rate_ci_pc"]
    return lines + [point for quantity in ("bound_pc", "balance_pc") for point in frontier(lines, quantity)]


def frontier(lines, quantity):
    """Lines that hold nothing but cost and error of the cases that nothing cheaper is as right as."""
    points, best = [], math.inf
    for line in sorted((line for line in lines if quantity in line), key=lambda line: line["cost"]):
        if line[quantity] < best:
            best = line[quantity]
            points.append({"cost": line["cost"], "frontier_" + quantity: best})
    return points


def write(path, comment, lines):
    names = []
    for line in lines:
        names += [name for name in line if name not in names]
    with open(path, "w") as out:
        out.write(comment)
        table = csv.DictWriter(out, names, restval="", lineterminator="\n")
        table.writeheader()
        for line in lines:
            table.writerow({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in line.items()})


def main():
    programs, work, out = sys.argv[1:4]
    seeds = range(1, 1 + (int(sys.argv[4]) if len(sys.argv) > 4 else 5))
    os.makedirs(work, exist_ok=True)
    for seed in seeds:
        write_spheres(f"{work}/grain_{seed}.csv", seed)
    rows = run_all(programs, work, seeds)
    write_tables(out, rows)


def write_tables(out, rows):
    write(f"{out}/hopper_runs.csv", "# charts/hopper_small.yaml, a line a run; user_s is user CPU time\n", rows)
    write(f"{out}/hopper.csv", "# hopper_runs.csv summed up, a line a case, then the frontiers; _ci: half a 95 % interval\n",
          sum_up(rows))


if __name__ == "__main__":
    main()
